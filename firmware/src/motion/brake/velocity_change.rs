//! A change of velocity: how long it takes, and its pieces, with no acceleration left at all.
//!
//! ```text
//! acceleration        ________              An acceleration at the start is released first, in n0 ticks; what rounding leaves
//!  \                 /        \             of it is taken up in one tick. Then velocity changes by
//!   \_______________/          \____        j n1 (n1 + n2), the same way for all axes: up for n1 ticks, held for n2, down for
//!     n0      1       n1  n2  n1            n1 with the very jerk of the first, so that nothing is left.
//! ```
//!
//! A jog lasts: a single unit of acceleration left would be a velocity after a year.

use crate::motion::plan::Piece;
use crate::motion::plan::axis_state::{AxisState, JERK_STEP};
use crate::motion::speeds::Speeds;
use crate::number::float::{FloatMinMax, ticks_to_f32, truncate};
use heapless::VecView;

/// Limits of acceleration and jerk in units per second.
#[derive(Clone, Copy)]
pub(crate) struct AccelerationLimits {
    pub acceleration: Speeds,
    pub jerk: Speeds,
}

/// Ticks of the parts of a ramp: `n1` and `n2` above.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VelocityRamp {
    pub rise: u64,
    pub hold: u64,
}

impl VelocityRamp {
    /// The shortest ramp in which velocity changes by `change` within `force`, both per second; of `hz` ticks a second.
    #[inline(never)]
    pub fn new(change: Speeds, force: &AccelerationLimits, hz: f32) -> Self {
        let way = times(change.linear, force.acceleration.linear, force.jerk.linear);
        let turn = times(
            change.angular,
            force.acceleration.angular,
            force.jerk.angular,
        );
        // The longer of both, part by part: neither acceleration nor jerk is over its limit then.
        let rise = ceil_ticks(way[0].fmax(turn[0]) * hz).max(1);
        let whole = ceil_ticks(way[1].fmax(turn[1]) * hz).max(rise);
        Self {
            rise,
            hold: whole - rise,
        }
    }

    /// Ticks of the whole ramp.
    pub fn ticks(self) -> u64 {
        2 * self.rise + self.hold
    }

    /// The pieces that change velocity by about `change` (2^-72 units a tick): by a little less than what a jerk
    /// rounded down leaves.
    #[inline(never)]
    pub fn pieces(self, change: [i64; 3]) -> [Piece; 3] {
        let steps = (self.rise as i64)
            .saturating_mul((self.rise + self.hold) as i64)
            .saturating_mul(JERK_STEP);
        let jerk = change.map(|change| change / steps * JERK_STEP);
        [
            Piece {
                ticks: self.rise,
                jerk,
            },
            Piece {
                ticks: self.hold,
                jerk: [0; 3],
            },
            Piece {
                ticks: self.rise,
                jerk: jerk.map(|jerk| -jerk),
            },
        ]
    }
}

/// Seconds of the jerk, and from its start to that of the jerk back, in the fastest change of a velocity by `change`.
fn times(change: f32, acceleration: f32, jerk: f32) -> [f32; 2] {
    if change * jerk <= acceleration * acceleration {
        let rise = crate::number::sqrt_f32(change / jerk);
        [rise, rise]
    } else {
        [acceleration / jerk, change / acceleration]
    }
}

/// Adds the pieces that bring the acceleration of `state` to exactly zero, within the jerks `most`; the velocities
/// after them (all in 2^-72 units).
#[inline(never)]
pub(crate) fn release_acceleration(
    state: &[AxisState; 3],
    force: Speeds,
    most: Speeds,
    hz: f32,
    pieces: &mut VecView<Piece>,
) -> [i64; 3] {
    let velocity = state.map(|axis| axis.velocity);
    if state.iter().all(|axis| axis.acceleration == 0) {
        return velocity;
    }
    let ticks = ceil_ticks(release_seconds(force, most) * hz).max(1);
    let steps = (ticks as i64).saturating_mul(JERK_STEP);
    let jerk = [0, 1, 2].map(|i| -state[i].acceleration / steps * JERK_STEP);
    let rest = [0, 1, 2].map(|i| -(state[i].acceleration + jerk[i] * ticks as i64));
    // Both fit.
    let _ = pieces.push(Piece { ticks, jerk });
    let _ = pieces.push(Piece {
        ticks: 1,
        jerk: rest,
    });
    // What is left for the tick adds half of itself in it.
    [0, 1, 2].map(|i| {
        let mean = (jerk[i] / 2).wrapping_mul(ticks as i64);
        let mean = mean.wrapping_add(state[i].acceleration);
        mean.wrapping_mul(ticks as i64)
            .wrapping_add(velocity[i])
            .wrapping_sub(rest[i] / 2)
    })
}

/// How long it takes to bring an acceleration to zero.
pub(crate) fn release_seconds(force: Speeds, jerk: Speeds) -> f32 {
    (force.linear / jerk.linear).fmax(force.angular / jerk.angular)
}

/// Longest stretch that is counted: a hundred thousand years.
const LONGEST: f32 = 36_028_797_018_963_968.0;

/// Rounded up to whole ticks.
fn ceil_ticks(ticks: f32) -> u64 {
    let ticks = ticks.fmin(LONGEST);
    let down = truncate(ticks) as u64;
    down + u64::from(ticks_to_f32(down) * (1.0 + 1e-6) < ticks)
}
