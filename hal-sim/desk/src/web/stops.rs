//! Stops of pages: what was asked for before one, and waits for its turn, does not go out behind it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use firmware::gcs::parse;

/// How many there were. Lines are marked with it when they are asked for.
#[derive(Clone, Default)]
pub(super) struct Stops(Arc<AtomicU64>);

impl Stops {
    /// So far.
    pub fn count(&self) -> u64 {
        self.0.load(Ordering::SeqCst)
    }

    /// One more, to be sent at once.
    pub fn note(&self) {
        self.0.fetch_add(1, Ordering::SeqCst);
    }

    /// Whether a line that was asked for after so many stops is not to go out any more. Questions and stops still do.
    pub fn have_ended(&self, asked_after: u64, line: &str) -> bool {
        let changes = || parse(line.as_bytes()).is_ok_and(|request| request.changes_stage());
        self.count() != asked_after && changes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_behind_a_stop_is_what_changes_something() {
        let stops = Stops::default();
        let before = stops.count();
        assert!(!stops.have_ended(before, "MOV X 1"));
        stops.note();
        for (line, ends) in [
            ("MOV X 1", true),
            ("JOG W 5", true),
            ("POS?", false),
            ("HLT", false),
        ] {
            assert_eq!(stops.have_ended(before, line), ends, "{line}");
            assert!(!stops.have_ended(stops.count(), line), "{line}");
        }
    }
}
