//! A ring that is moved alone, with the servo off but for a soft one of each ring, until a guide is at its end.

use super::bench::{BY_CURRENT, Bench, Ended};
use super::found::{CommissionError, fail};
use super::id;
use super::id::AXES;
use commissioning::Signals;

type Result<T> = std::result::Result<T, CommissionError>;

/// While rings are moved so far: largest voltage, V, how far they may be off the servos' setpoints, rad, and how fast they may be, rad/s. The
/// setpoint begins at once, and a ring overshoots its rate until it follows.
pub(crate) const LIMITS: [(u32, f64); 3] = [
    (id::EXCITATION_V, 5.0),
    (id::EXCITATION_WAY, 0.3),
    (id::EXCITATION_RATE, 1.2),
];
/// Furthest that a ring goes, mrad: as far as `EXC RING` does, and somewhat more than from end to end. And how fast, mrad/s: some 50 mm/s at the platform.
const FURTHEST_MRAD: f64 = 3_140.0;
const RATE_MRAD_S: f64 = 500.0;
/// The same towards an end that is near.
const NEAR_MRAD_S: f64 = 200.0;
/// Then back by so much, and against it again, so slowly.
const BACK_MRAD: f64 = 8.0;
const BACK_MRAD_S: f64 = 40.0;
/// Current that ends an excitation at an end, A; more where that was friction, and how often.
const CURRENT_A: f64 = 0.6;
const MORE: f64 = 1.4;
const TRIES: usize = 4;
/// Once more to be recorded, more slowly, mrad/s, and up to so many times the current, so that there is a line of place over current; rows, ticks
/// from row to row.
const RECORDED_MRAD_S: f64 = 16.0;
const RECORDED_MORE: f64 = 1.5;
const ROWS: usize = 700;
const EVERY: usize = 40;
/// Time in which a ring comes to where its setpoint is already, ms.
const FOLLOW_MS: f64 = 400.0;

/// Which ring is moved, and which way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// The ring, from 0.
    pub ring: usize,
    /// 1 to the left, -1 to the right.
    pub sign: f64,
}

impl Touch {
    /// Told angles of the pivots where it comes to the end of a guide, rad, wherever that is.
    pub fn pivots_rad(self, bench: &mut Bench<'_>) -> Result<[f64; AXES]> {
        self.to_end(bench, FURTHEST_MRAD, RATE_MRAD_S, |bench, current_a| {
            let pressed = self.moved(bench, self.against_mrad(), BACK_MRAD_S, Some(current_a))?;
            Ok((pressed, ()))
        })?;
        Ok(bench.pivots_rad()?)
    }

    /// Currents and angles of the pivots while it comes to the end of a guide that is within so many mrad.
    pub fn recorded(self, bench: &mut Bench<'_>, within_mrad: f64) -> Result<[Signals; AXES]> {
        self.to_end(bench, within_mrad, NEAR_MRAD_S, |bench, current_a| {
            let most_a = Some(current_a * RECORDED_MORE);
            let line = self.line(self.against_mrad(), RECORDED_MRAD_S, most_a);
            let signals = bench.record_all(ROWS, EVERY, &line)?;
            Ok((bench.excitation_end()?, signals))
        })
    }

    /// Moves it against the end of a guide, back, and against it again: what came of that, once it was an end.
    fn to_end<T>(
        self,
        bench: &mut Bench<'_>,
        within_mrad: f64,
        rate_mrad_s: f64,
        press: impl Fn(&mut Bench<'_>, f64) -> Result<(Ended, T)>,
    ) -> Result<T> {
        let pivot = self.ring + 1;
        let mut current_a = CURRENT_A;
        for _ in 0..TRIES {
            let by_mrad = self.sign * within_mrad;
            if self.moved(bench, by_mrad, rate_mrad_s, Some(current_a))?.by != BY_CURRENT {
                return fail(
                    format!(
                        "the ring of pivot {pivot} has gone by {within_mrad:.0} mrad without coming to the end of a guide"
                    ),
                    "see whether its carriage is on its guide, and whether guides have ends",
                );
            }
            self.moved(bench, -self.sign * BACK_MRAD, BACK_MRAD_S, None)?;
            // It may have been friction: an end stops it again.
            let (pressed, came) = press(bench, current_a)?;
            if pressed.by == BY_CURRENT {
                return Ok(came);
            }
            current_a *= MORE;
        }
        fail(
            format!("the ring of pivot {pivot} moves with difficulty, and never comes to an end"),
            "see what rubs: its bearing, its carriage or a guide",
        )
    }

    /// From where it is brought back to, beyond the end.
    fn against_mrad(self) -> f64 {
        self.sign * 2.0 * BACK_MRAD
    }

    /// Moves a ring by an angle, rad.
    pub fn go(bench: &mut Bench<'_>, ring: usize, by_rad: f64) -> Result<()> {
        let touch = Self {
            ring,
            sign: by_rad.signum(),
        };
        touch.moved(bench, by_rad * 1e3, RATE_MRAD_S, None)?;
        Ok(())
    }

    fn moved(
        self,
        bench: &mut Bench<'_>,
        by_mrad: f64,
        rate_mrad_s: f64,
        current_a: Option<f64>,
    ) -> Result<Ended> {
        bench.ask(&self.line(by_mrad, rate_mrad_s, current_a))?;
        bench.excitation_end_within(duration_ms(by_mrad, rate_mrad_s) / 1e3 + 2.0)
    }

    fn line(self, by_mrad: f64, rate_mrad_s: f64, current_a: Option<f64>) -> String {
        let ms = duration_ms(by_mrad, rate_mrad_s);
        let until = current_a.map_or(String::new(), |a| format!(" {a:.3}"));
        let pivot = self.ring + 1;
        format!("EXC RING {pivot} {by_mrad:.4} {rate_mrad_s} {ms:.0}{until}")
    }
}

fn duration_ms(by_mrad: f64, rate_mrad_s: f64) -> f64 {
    by_mrad.abs() / rate_mrad_s * 1e3 + FOLLOW_MS
}
