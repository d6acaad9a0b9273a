//! The jerk-limited profile from rest to rest: durations of its seven segments, in whole ticks.
//!
//! ```text
//! jerk          _                 _          Such a profile is a step passed through three moving averages of lengths
//!             _| |_______________| |___      b1 <= b2 and b3 >= b1 + b2: jerk lasts b1, the ramp to full speed b1 + b2,
//!                 |_|         |_|            the whole b1 + b2 + b3. Over a way of 1, peak speed is 1/b3, acceleration
//! velocity      ___________                  1/(b2 b3), jerk 1/(b1 b2 b3).
//!           __/             \__
//! ```
//!
//! The time-optimal lengths follow from the limits by cases. Rounding each up to whole ticks lengthens a move by three
//! ticks at most and can only lower speed, acceleration and jerk: the limits hold exactly.

use super::limits::PathLimits;

/// Lengths of the three moving averages in ticks: `jerk <= ramp`, `way >= jerk + ramp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Profile {
    /// b1: how long jerk acts.
    pub jerk: u64,
    /// b2: from the start of one acceleration phase to the start of its end.
    pub ramp: u64,
    /// b3: from the start of the acceleration to the start of the deceleration.
    pub way: u64,
}

impl Profile {
    /// The shortest profile over a path parameter of 1 within `limits`; `None` when a limit is not a positive number or
    /// the move would last longer than 2^52 ticks.
    pub fn new(limits: &PathLimits) -> Option<Self> {
        let PathLimits {
            rate,
            acceleration,
            jerk,
        } = *limits;
        // NaN is not over zero either.
        if !(rate > 0.0 && acceleration > 0.0 && jerk > 0.0) {
            return None;
        }
        let [b1, b2, b3] = shortest(limits);
        let jerk = ticks(b1)?;
        let ramp = ticks(b2)?.max(jerk);
        let way = ticks(b3)?.max(jerk + ramp);
        Some(Self { jerk, ramp, way })
    }

    /// Durations and jerk signs of the seven segments.
    pub fn segments(&self) -> [(u64, i64); 7] {
        let flat = self.ramp - self.jerk;
        let cruise = self.way - self.ramp - self.jerk;
        let j = self.jerk;
        [
            (j, 1),
            (flat, 0),
            (j, -1),
            (cruise, 0),
            (j, -1),
            (flat, 0),
            (j, 1),
        ]
    }

    /// Jerk times this is the way: b1 b2 b3.
    pub fn volume(&self) -> i128 {
        i128::from(self.jerk) * i128::from(self.ramp) * i128::from(self.way)
    }
}

fn shortest(limits: &PathLimits) -> [f64; 3] {
    let PathLimits {
        rate,
        acceleration,
        jerk,
    } = *limits;
    // Reaching full speed: with full acceleration, or by jerk alone.
    let b1 = (acceleration / jerk).min(libm::sqrt(rate / jerk));
    let b2 = (rate / acceleration).max(b1);
    if rate * (b1 + b2) <= 1.0 {
        return [b1, b2, 1.0 / rate];
    }
    // Full speed is not reached; full acceleration is if its way at b2 = b1 fits.
    let b1 = acceleration / jerk;
    if 2.0 * acceleration * b1 * b1 <= 1.0 {
        let b2 = (libm::sqrt(b1 * b1 + 4.0 / acceleration) - b1) / 2.0;
        return [b1, b2, b1 + b2];
    }
    let b1 = libm::cbrt(0.5 / jerk);
    [b1, b1, 2.0 * b1]
}

fn ticks(duration: f64) -> Option<u64> {
    const LONGEST: f64 = 4_503_599_627_370_496.0;
    // A duration that is whole but for its rounding errors is not rounded up.
    let whole = libm::ceil(duration * (1.0 - 1e-12)).max(1.0);
    (whole <= LONGEST).then_some(whole as u64)
}
