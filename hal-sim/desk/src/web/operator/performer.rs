//! One line of a sequence, over the line to the controller that all pages share. `WAC` and `DEL` would hold up everybody there:
//! they are waited for here, by asking. So is the recording of a macro: its lines are collected and sent in one piece.
//!
//! A stop by somebody else must end the sequence, not be taken for an arrival. One of a page is told to the sequence at once. One
//! of another client of the controller shows in the target, which a stop moves to where the stage is, or in the jog, which it
//! ends: both are compared before every line. What ends a wave is not told apart from its own end.

use std::sync::{Arc, Weak};
use std::time::Duration;

use firmware::gcs::Operator as Comparison;
use script::Line;
use tokio::time::{Instant, sleep};

use crate::error_words::refused_with;
use crate::web::bridge::{Bridge, HeldWay, Way};

/// Between two looks at what is waited for.
const LOOK_EVERY: Duration = Duration::from_millis(40);
/// Lines after which the target is theirs until the next command.
const TARGETS: [&str; 6] = ["MOV", "MVR", "MRT", "MRW", "STE", "FRF"];
/// Lines after which the target goes on changing by itself.
const CHANGING: [&str; 7] = ["WGO", "MAC", "STP", "HLT", "#24", "SVO", "RBT"];
/// Modes in which a fault has taken over.
const FAULTS: [&str; 2] = ["fault", "stopping"];

/// Asks for the constant velocities under way.
const JOGS: &str = "JOG? X Y W";
/// Asks for the seconds in a tick.
const PERIOD: &str = "SPA? 1 0xE000200";

/// What was commanded last, as the controller tells it; the question, and its answer.
type Mark = Option<(&'static str, String)>;

/// Carries out lines.
pub(super) struct Performer {
    bridge: Bridge,
    /// Its lines' way to the controller, a viewer's of its own.
    own: HeldWay,
    /// That of the page that had it run, while that page owns the stage.
    owners: Weak<Way>,
    mark: Mark,
    /// The constant velocity under way, which ends where it is not renewed.
    jog: Option<String>,
    /// Lines of the macro that is being recorded.
    recording: Vec<String>,
}

impl Performer {
    /// # Errors
    /// There is no way to the controller, in words.
    pub fn new(bridge: Bridge) -> Result<Self, String> {
        let own = (bridge.way()).map_err(|error| format!("no way to the controller: {error}"))?;
        Ok(Self {
            bridge,
            own,
            owners: Weak::new(),
            mark: None,
            jog: None,
            recording: Vec::new(),
        })
    }

    /// Goes by the way with this key if that one owns the stage, and else by its own.
    pub async fn choose_way(&mut self, key: &str) {
        let way = self.bridge.owners_way(key).await;
        self.owners = way.map_or_else(Weak::new, |way| Arc::downgrade(&way));
    }

    fn way(&self) -> Arc<Way> {
        (self.owners.upgrade()).unwrap_or_else(|| Arc::clone(&self.own.0))
    }

    /// Has a line carried out, and waits where it waits; its answer, or why it was not, in words.
    pub async fn perform(&mut self, line: &Line) -> Result<Option<String>, String> {
        let word = line.word();
        if self.records(&word, line) {
            return self.record(line).await;
        }
        match &*word {
            "DEL" => self.delay(line).await.map(|()| None),
            "WAC" => self.wait(line).await.map(|()| None),
            _ if line.asks() => self.send(line).await,
            _ => {
                self.check_mark().await?;
                let reply = self.send(line).await?;
                self.set_mark(&word).await?;
                if self
                    .mark
                    .as_ref()
                    .is_none_or(|(question, _)| *question != JOGS)
                {
                    self.jog = None;
                } else if word == "JOG" {
                    self.jog = Some(line.text.clone());
                }
                Ok(reply)
            }
        }
    }

    /// Sends a stop ahead of whatever waits.
    pub fn stop(&self) {
        // Where nobody is reached, the page that stops says so.
        let _ = self.bridge.stop();
    }

    /// Comes to rest smoothly.
    pub async fn halt(&self) {
        let _ = self.ask("HLT").await;
    }

    fn records(&self, word: &str, line: &Line) -> bool {
        let begins = word == "MAC" && second(line) == "BEG";
        begins || !self.recording.is_empty()
    }

    async fn record(&mut self, line: &Line) -> Result<Option<String>, String> {
        self.recording.push(line.text.clone());
        if !(line.word() == "MAC" && second(line) == "END") {
            return Ok(None);
        }
        let text = std::mem::take(&mut self.recording).join("\n");
        self.ask(&text).await
    }

    async fn send(&self, line: &Line) -> Result<Option<String>, String> {
        if line.single_byte() == Some(24) || line.word() == "STP" {
            self.stop();
            return Ok(None);
        }
        if line.single_byte().is_some() {
            return Err(format!(
                "{} cannot be asked for on a line that others share",
                line.text
            ));
        }
        let answer =
            (self.way().ask(line.text.clone()).await).map_err(|refusal| refusal.to_string())?;
        if line.is_done_with(answer.error) {
            Ok(answer.reply)
        } else {
            Err(refused_with(answer.error))
        }
    }

    async fn ask(&self, text: &str) -> Result<Option<String>, String> {
        let asked = self.way().ask(text.to_owned()).await;
        let answer = asked.map_err(|refusal| refusal.to_string())?;
        match answer.error {
            0 | 10 => Ok(answer.reply),
            error => Err(refused_with(error)),
        }
    }

    /// The controller's tick; a latched fault ends everything.
    async fn tick(&self) -> Result<f64, String> {
        let reply = self.ask("MON?").await?.unwrap_or_default();
        let field = |name: &str| {
            reply
                .lines()
                .find_map(|line| line.strip_prefix(name)?.strip_prefix('='))
                .unwrap_or_default()
        };
        if FAULTS.contains(&field("MODE")) {
            let fault = self.ask("FLT?").await?.unwrap_or_default();
            return Err(format!("fault: {fault}"));
        }
        number(field("TICK"))
    }

    /// By the controller's time, which a simulated one may let pass slowly.
    async fn delay(&self, line: &Line) -> Result<(), String> {
        let seconds = number(&second(line))? / 1e3;
        let period_s = number(&self.ask(PERIOD).await?.unwrap_or_default())?;
        let end = self.tick().await? + seconds / period_s;
        loop {
            let left_s = (end - self.tick().await?) * period_s;
            if left_s <= 0.0 {
                return self.check_mark().await;
            }
            self.renew().await?;
            sleep(LOOK_EVERY.min(Duration::from_secs_f64(left_s))).await;
        }
    }

    async fn wait(&self, line: &Line) -> Result<(), String> {
        let (question, comparison, value) =
            condition(&line.text).ok_or_else(|| format!("{} is no condition", line.text))?;
        let mut next = Instant::now();
        loop {
            self.tick().await?;
            let told = number(&self.ask(&question).await?.unwrap_or_default())?;
            self.check_mark().await?;
            if comparison.holds(told, value) {
                return Ok(());
            }
            self.renew().await?;
            next += LOOK_EVERY;
            sleep(next.saturating_duration_since(Instant::now())).await;
        }
    }

    /// A page's constant velocity lasts for a moment: for as long as the sequence waits it is asked for again.
    async fn renew(&self) -> Result<(), String> {
        let Some(jog) = &self.jog else {
            return Ok(());
        };
        self.check_mark().await?;
        self.ask(jog).await.map(drop)
    }

    /// Nobody else has commanded anything since.
    async fn check_mark(&self) -> Result<(), String> {
        let Some((question, told)) = &self.mark else {
            return Ok(());
        };
        if self.ask(question).await?.as_ref() == Some(told) {
            return Ok(());
        }
        Err("somebody else has stopped or moved the stage".to_owned())
    }

    async fn set_mark(&mut self, word: &str) -> Result<(), String> {
        let question = if TARGETS.contains(&word) {
            Some("MOV? X Y W")
        } else if word == "JOG" {
            Some(JOGS)
        } else if CHANGING.contains(&word) {
            None
        } else {
            // A frame or a centre of rotation has the same target told in other numbers.
            self.mark.as_ref().map(|(question, _)| *question)
        };
        self.mark = match question {
            Some(question) => Some((question, self.ask(question).await?.unwrap_or_default())),
            None => None,
        };
        Ok(())
    }
}

/// The number in an answer, behind its last `=`.
fn number(answer: &str) -> Result<f64, String> {
    let text = answer.rsplit('=').next().unwrap_or_default().trim();
    text.parse()
        .map_err(|_| format!("a number was expected, not {answer:?}"))
}

fn second(line: &Line) -> String {
    let word = line.text.split_whitespace().nth(1).unwrap_or_default();
    word.to_ascii_uppercase()
}

/// Question, comparison and value of a `WAC`.
fn condition(text: &str) -> Option<(String, Comparison, f64)> {
    let rest = text.trim().get(3..)?;
    let at = rest.find(['=', '!', '<', '>'])?;
    let (question, rest) = rest.split_at(at);
    let length = rest.find(|c| !['=', '!', '<', '>'].contains(&c))?;
    let (operator, value) = rest.split_at(length);
    let value = value.trim().parse().ok()?;
    Some((
        question.trim().to_owned(),
        Comparison::named(operator.as_bytes())?,
        value,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_read_as_the_controller_reads_them() {
        let (question, comparison, value) = condition("WAC ONT? W = 1").unwrap();
        assert_eq!(
            (&*question, comparison, value),
            ("ONT? W", Comparison::Equal, 1.0)
        );
        let (question, comparison, value) = condition("wac POS? X>=-2.5").unwrap();
        assert_eq!(
            (&*question, comparison, value),
            ("POS? X", Comparison::AtLeast, -2.5)
        );
        assert_eq!(condition("WAC POS? X"), None);
        assert_eq!(condition("WAC POS? X = "), None);
    }
}
