//! What starts the controller again: the window watchdog that its tick feeds, and a program that ends itself.
//!
//! As on the chip: the early warning comes 0.39 to 0.49 ms after the last tick that ended, cuts the outputs (pulses and sleep pins low)
//! and resets. The program then takes its time to start, with all pins low.

use firmware::gcs::START_CAUSES;

/// Earliest and latest time from the last tick to the early warning, s.
pub const EARLY_WARNING_S: [f64; 2] = [0.39e-3, 0.49e-3];
/// Time from a reset to the first tick, s.
const START_S: f64 = 1e-3;

/// What the reset leaves in the chip's flags, as the firmware tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reset {
    /// The watchdog's.
    Watchdog,
    /// The program's own: a panic or a processor fault.
    Software,
}

impl Reset {
    /// Its cause in the controller's words.
    #[must_use]
    pub const fn cause(self) -> &'static str {
        match self {
            Self::Watchdog => START_CAUSES[0],
            Self::Software => START_CAUSES[1],
        }
    }
}

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Watchdog {
    limit_s: f64,
    since_fed_s: f64,
    reset: Option<(Reset, f64)>,
}

impl Watchdog {
    /// Fed a moment ago. Where in its clock's period the last tick has ended is a share of 0 to 1.
    #[must_use]
    pub fn new(phase: f64) -> Self {
        let [earliest_s, latest_s] = EARLY_WARNING_S;
        Self {
            limit_s: earliest_s + (latest_s - earliest_s) * phase,
            since_fed_s: 0.0,
            reset: None,
        }
    }

    /// A tick has ended.
    pub const fn feed(&mut self) {
        self.since_fed_s = 0.0;
    }

    /// The program ends itself.
    pub const fn crash(&mut self) {
        self.reset = Some((Reset::Software, 0.0));
    }

    /// Whether pulses and sleep pins are held low.
    #[must_use]
    pub const fn is_cut(&self) -> bool {
        self.reset.is_some()
    }

    /// Time without a tick; the reset after which the first tick is due, once.
    pub fn step(&mut self, step_s: f64) -> Option<Reset> {
        self.since_fed_s += step_s;
        if self.reset.is_none() && self.since_fed_s >= self.limit_s {
            self.reset = Some((Reset::Watchdog, 0.0));
        }
        let (reset, since_s) = self.reset.as_mut()?;
        *since_s += step_s;
        let (reset, is_due) = (*reset, *since_s >= START_S);
        if is_due {
            self.reset = None;
            self.feed();
        }
        is_due.then_some(reset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 50e-6;

    #[test]
    fn it_bites_when_it_is_not_fed_and_not_before() {
        for phase in [0.0, 1.0] {
            let mut watchdog = Watchdog::new(phase);
            for _ in 0..100 {
                // Seven periods between two ticks are not enough for it.
                for _ in 0..7 {
                    assert_eq!(watchdog.step(STEP_S), None);
                    assert!(!watchdog.is_cut());
                }
                watchdog.feed();
            }
            let cut = (1..).find(|_| watchdog.step(STEP_S).is_none() && watchdog.is_cut());
            let periods = if phase == 0.0 { 8 } else { 10 };
            assert_eq!(cut, Some(periods));
            let start = (1..).find_map(|_| watchdog.step(STEP_S));
            assert_eq!(start, Some(Reset::Watchdog));
            assert!(!watchdog.is_cut());
        }
    }

    #[test]
    fn a_crash_cuts_at_once() {
        let mut watchdog = Watchdog::new(0.5);
        watchdog.crash();
        assert!(watchdog.is_cut());
        assert_eq!(
            (1..).find_map(|_| watchdog.step(STEP_S)),
            Some(Reset::Software)
        );
    }
}
