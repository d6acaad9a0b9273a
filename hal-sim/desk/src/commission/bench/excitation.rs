//! Excitations, and why they have ended.

use super::{Bench, LOOK_S, Result, fail};

/// Longest time after which an excitation is over that should be, s.
const EXCITATION_END_S: f64 = 4.0;

/// How an excitation has ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ended {
    /// Why: [`BY_TIME`], [`BY_WAY`], [`BY_CURRENT`], or that it was stopped.
    pub by: String,
    /// Seconds that it took.
    pub seconds: f64,
}

/// It came to its end, or a guard on way or current ended it, as `EXC?` says.
pub(crate) const BY_TIME: &str = "time";
pub(crate) const BY_WAY: &str = "way";
pub(crate) const BY_CURRENT: &str = "current";

impl Bench<'_> {
    /// An excitation, to its end.
    pub fn excite(&mut self, line: &str, seconds: f64) -> Result<Ended> {
        self.ask(line)?;
        self.delay(seconds)?;
        self.excitation_end()
    }

    /// Waits until the excitation under way is over.
    pub fn excitation_end(&mut self) -> Result<Ended> {
        self.excitation_end_within(EXCITATION_END_S)
    }

    /// The same of one that may go on for so long.
    pub fn excitation_end_within(&mut self, seconds: f64) -> Result<Ended> {
        let looks = (seconds / LOOK_S).ceil() as usize;
        for _ in 0..looks {
            if self.number("EXC?", "RUNS")? == 0.0 {
                let by = self.text("EXC?", "END")?;
                if by == "fault" {
                    let fault = self.fault()?;
                    return fail(
                        format!("a fault has ended an excitation{fault}"),
                        "something moves that should not: look at wires and encoders before the next try",
                    );
                }
                let seconds = self.number("EXC?", "TICKS")? * self.period_s;
                return Ok(Ended { by, seconds });
            }
            self.delay(LOOK_S)?;
        }
        fail("an excitation does not end", "STP ends it")
    }
}
