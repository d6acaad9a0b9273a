//! Who did what: the lines of pages and sequences that do something, and what came of them. Other clients of the controller
//! are not seen from here.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;
use tokio::sync::broadcast;

use crate::web::bridge::json;

/// Entries that are kept.
const KEPT: usize = 300;
/// Commands that wait.
const WAITS: [&str; 2] = ["WAC", "DEL"];
/// Commands that a held button repeats.
const HELD: [&str; 2] = ["JOG", "RCV"];
/// Longest name that is taken over.
const NAME_CHARACTERS: usize = 24;

#[derive(Serialize)]
#[serde(tag = "kind", rename = "log")]
struct Entry<'a> {
    /// Milliseconds since 1970, by the server's clock.
    at_ms: u64,
    who: &'a str,
    line: &'a str,
    outcome: &'a str,
}

/// What is kept.
#[derive(Default)]
struct Kept {
    entries: VecDeque<Arc<str>>,
    /// Who, line and outcome of the last.
    last: [String; 3],
}

/// The log of one server.
#[derive(Clone)]
pub(in crate::web) struct Journal {
    kept: Arc<Mutex<Kept>>,
    news: broadcast::Sender<Arc<str>>,
}

impl Journal {
    pub fn new() -> Self {
        Self {
            kept: Arc::default(),
            news: broadcast::channel(KEPT).0,
        }
    }

    /// Notes a line, unless it only asks or waits, or is what a held button has asked for already.
    pub fn note(&self, who: &str, line: &str, outcome: &str) {
        let word = line.split_whitespace().next().unwrap_or_default();
        let asks = word.ends_with('?') || (word.starts_with('#') && word != "#24");
        let is = |words: &[&str]| words.iter().any(|one| word.eq_ignore_ascii_case(one));
        if asks || is(&WAITS) {
            return;
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let who: String = (who.chars())
            .filter(|c| !c.is_control())
            .take(NAME_CHARACTERS)
            .collect();
        let entry = json(&Entry {
            at_ms: now.map_or(0, |time| {
                u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
            }),
            who: if who.is_empty() { "a page" } else { &who },
            line,
            outcome,
        });
        let last = [who, line.to_owned(), outcome.to_owned()];
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if is(&HELD) && kept.last == last {
            return;
        }
        kept.last = last;
        if kept.entries.len() == KEPT {
            kept.entries.pop_front();
        }
        kept.entries.push_back(Arc::clone(&entry));
        // Nobody needs to look. Within the lock, so that nobody gets an entry twice.
        let _ = self.news.send(entry);
    }

    /// What is kept, and what comes from now on.
    pub fn read(&self) -> (Vec<Arc<str>>, broadcast::Receiver<Arc<str>>) {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        (
            kept.entries.iter().cloned().collect(),
            self.news.subscribe(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_only_asks_or_waits_is_not_noted_and_the_oldest_goes_first() {
        let journal = Journal::new();
        for line in ["POS?", "#5", " ERR?", "MAC? A", "wac ONT? X = 1", "DEL 5"] {
            journal.note("Ada", line, "done");
        }
        assert!(journal.read().0.is_empty());
        for number in 0..=KEPT {
            journal.note("Ada\n", &format!("MOV X {number}"), "done");
        }
        // A held button is one entry; what is asked for twice is two.
        for line in ["JOG X 5", "JOG X 5", "MVR X 1", "MVR X 1", "JOG X 5"] {
            journal.note("Ada", line, "taken");
        }
        journal.note("", "#24", "sent");
        let (kept, _) = journal.read();
        assert_eq!(kept.len(), KEPT);
        assert!(
            kept[0].contains(r#""who":"Ada","line":"MOV X 6""#),
            "{}",
            kept[0]
        );
        assert!(kept[KEPT - 1].contains(r##""who":"a page","line":"#24""##));
    }
}
