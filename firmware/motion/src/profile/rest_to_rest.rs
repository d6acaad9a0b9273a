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
//! ticks at most and can only lower speed, acceleration and jerk: the limits hold but for the roundings of the lengths
//! themselves, a millionth at most.

use crate::constraints::PathLimits;
use crate::plan::quantise::{JerkSegment, PathProfile};
use crate::plan::{Plan, Position};
use crate::tolerances::WHOLE_DURATION;
use number::float::{FloatMinMax, ceil_ticks, ticks_to_f32};
use number::{cbrt_f32, sqrt_f32};

/// Lengths of the three moving averages in ticks: `jerk <= ramp`, `travel >= jerk + ramp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RestToRestProfile {
    /// b1: how long jerk acts.
    pub jerk: u64,
    /// b2: from the start of one acceleration phase to the start of its end.
    pub ramp: u64,
    /// b3: from the start of the acceleration to the start of the deceleration.
    pub travel: u64,
}

impl RestToRestProfile {
    /// The shortest profile over a path parameter of 1 within `limits`, at `hz` ticks a second; `None` when a limit is
    /// not a positive number or the move would last longer than 2^52 ticks.
    pub fn new(limits: &PathLimits, hz: f32) -> Option<Self> {
        // NaN is not over zero either.
        if !(limits.rate > 0.0 && limits.acceleration > 0.0 && limits.jerk > 0.0) {
            return None;
        }
        let [b1, b2, b3] = shortest(limits);
        Self::lasting([b1 * hz, b2 * hz, b3 * hz])
    }

    /// The same motion, `slower` (1 or more).
    pub fn slowed(&self, slower: f32) -> Option<Self> {
        let slowed = |ticks: u64| ticks_to_f32(ticks) * slower;
        Self::lasting([slowed(self.jerk), slowed(self.ramp), slowed(self.travel)])
    }

    /// Of lengths in ticks, rounded up; `None` beyond what can be counted.
    pub fn lasting([b1, b2, b3]: [f32; 3]) -> Option<Self> {
        let jerk = ticks(b1)?;
        let ramp = ticks(b2)?.max(jerk);
        let travel = ticks(b3)?.max(jerk + ramp);
        Some(Self { jerk, ramp, travel })
    }

    /// Duration in ticks.
    pub fn ticks(&self) -> u64 {
        self.jerk + self.ramp + self.travel
    }

    /// Durations and jerk signs of the seven segments.
    pub fn segments(&self) -> [(u64, i32); 7] {
        let flat = self.ramp - self.jerk;
        let cruise = self.travel - self.ramp - self.jerk;
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

    /// Writes pieces and nudge of a plan from `from` to its end.
    pub fn write_plan(&self, plan: &mut Plan, from: &Position) -> Option<()> {
        let mut path_profile = PathProfile::default();
        self.write(&mut path_profile);
        path_profile.write_plan(plan, from)
    }

    /// Writes it as a path profile: its jerks are 1 and -1.
    pub fn write(&self, path_profile: &mut PathProfile) {
        path_profile.segments.clear();
        for (ticks, jerk) in self.segments() {
            if ticks > 0 {
                // Seven segments, room for more.
                let _ = path_profile.segments.push(JerkSegment { ticks, jerk });
            }
        }
        // Jerk times b1 b2 b3 is the way.
        let volume = i128::from(self.jerk * self.ramp) * i128::from(self.travel);
        path_profile.six_times_distance = 6 * volume;
        path_profile.bits = 0;
    }
}

/// Lengths of the shortest profile, s.
pub fn shortest(limits: &PathLimits) -> [f32; 3] {
    let (rate, acceleration, jerk) = (limits.rate, limits.acceleration, limits.jerk);
    // Reaching full speed: with full acceleration, or by jerk alone.
    let b1 = (acceleration / jerk).fmin(sqrt_f32(rate / jerk));
    let b2 = (rate / acceleration).fmax(b1);
    if rate * (b1 + b2) <= 1.0 {
        return [b1, b2, 1.0 / rate];
    }
    // Full speed is not reached; full acceleration is if its way at b2 = b1 fits.
    let b1 = acceleration / jerk;
    if 2.0 * acceleration * b1 * b1 <= 1.0 {
        // Not as a difference, where that would cost digits.
        let b2 = 2.0 / acceleration / (sqrt_f32(b1 * b1 + 4.0 / acceleration) + b1);
        return [b1, b2, b1 + b2];
    }
    let b1 = cbrt_f32(0.5 / jerk);
    [b1, b1, 2.0 * b1]
}

#[inline(never)]
fn ticks(duration: f32) -> Option<u64> {
    const LONGEST: f32 = 4_503_599_627_370_496.0;
    // A duration that is whole but for its rounding errors is not rounded up.
    let duration = duration * WHOLE_DURATION;
    // A NaN is not that short either.
    (duration <= LONGEST).then(|| ceil_ticks(duration).max(1))
}
