//! The stage held, turning, moved and settled.

use super::{Answered, Bench, LOOK_S, Result, fail};

/// Longest time that a stage is given to settle, s.
const SETTLING_S: f64 = 5.0;
/// Longest time for which the platform turns without being asked again: more than any step takes, with records over a slow line.
const TURNING_MS: u32 = 600_000;
/// Time after a move in which a stage settles that does, s.
const STAY_S: f64 = 0.3;
/// What `LST?` tells of following errors since it was asked last.
pub(in crate::commission) const PEAK: &str = "PEAK_ERROR_RAD";

impl Bench<'_> {
    /// The stage is held where it is.
    pub fn hold(&mut self) -> Result<()> {
        self.ask("FRF")?;
        self.settle()?;
        Ok(())
    }

    /// The platform turns at a steady rate, rad/s, until something else is asked for; with nobody there any more, for as long as
    /// [`TURNING_MS`] on a serial line, which does not tell that somebody is gone.
    pub fn turn(&mut self, rate_rad_s: f64) -> Answered<()> {
        self.ask(&format!("JTM {TURNING_MS}"))?;
        self.ask(&format!("JOG W {}", rate_rad_s.to_degrees()))?;
        Ok(())
    }

    /// Waits until the stage has settled after the reference: how long it took, s.
    pub fn settle(&mut self) -> Result<f64> {
        let start = self.clock_s()?;
        self.wait_for_target(SETTLING_S)?;
        Ok(self.clock_s()? - start)
    }

    /// Waits until a move is over and the stage has settled.
    pub fn wait_for_target(&mut self, seconds: f64) -> Result<()> {
        if self.settles_within(seconds)? {
            return Ok(());
        }
        let fault = self.fault()?;
        fail(
            format!("a move has not come to its end in {seconds} s{fault}"),
            "something rubs or gives way, or the gains are far from this machine's; EVT? tells more",
        )
    }

    /// Waits until a move is over and the stage has settled, so long at most, or until a fault: whether it has.
    pub fn settles_within(&mut self, seconds: f64) -> Result<bool> {
        let end = self.clock_s()? + seconds;
        while self.number("ONT? X", "X")? != 1.0 {
            let fault = self.fault()?;
            if !fault.is_empty() || self.clock_s()? > end {
                return Ok(false);
            }
            self.delay(LOOK_S)?;
        }
        Ok(true)
    }

    /// Waits until the stage has settled. One that stays some counts off is good enough, as long as it stays.
    pub fn stay(&mut self) -> Result<()> {
        if !self.settles_within(STAY_S)? && self.is_faulted()? {
            return self.wait_for_target(0.0);
        }
        Ok(())
    }

    /// Moves one after the other, each within so many seconds: the largest following error of a pivot, rad.
    pub fn follow(&mut self, moves: &[&str], seconds: f64) -> Result<f64> {
        self.number("LST?", PEAK)?;
        for line in moves {
            self.ask(line)?;
            self.wait_for_target(seconds)?;
        }
        Ok(self.number("LST?", PEAK)?)
    }

    /// The same at a share of the speed, which is as before afterwards, whatever came of the moves: no `RPA` brings it back.
    pub fn follow_slowly(&mut self, share: f64, moves: &[&str], seconds: f64) -> Result<f64> {
        let full = self.number_of("VLS?")?;
        self.ask(&format!("VLS {}", full * share))?;
        let followed = self.follow(moves, seconds);
        let given_back = self.ask(&format!("VLS {full}"));
        let largest_rad = followed?;
        given_back?;
        Ok(largest_rad)
    }
}
