//! The brake: three segments that bring all axes to rest together, from any velocity and acceleration.
//!
//! ```text
//! a0 \                 Velocity and acceleration are vectors here, of x, y and theta. The acceleration goes straight from a0
//!     \                to a peak P, stays there, and goes straight back to zero, for n1, n2 and n3 ticks:
//!   0 -\--------/-     P = -(v + a0 n1 / 2) / (n1 / 2 + n2 + n3 / 2). A straight line between two accelerations within a
//!       \______/       limit stays within it, whatever the direction; when v and a0 are parallel, so is P, and the stop
//!   P  n1  n2  n3      stays on the line.
//! ```
//!
//! Sizes are measured by what is allowed: translation and rotation each over its limit of acceleration, the greater
//! counts. With `w = v + a0 n1 / 2`, to be taken away along its own direction, where jerk may change the size by `j` a
//! tick, the shortest times for a given `n1` have a peak of `p = j (sqrt(n1^2 / 4 + 2 |w| / j) - n1 / 2)`, or of 1 and
//! a time at it. `n1` follows from `|P - a0|`; a few rounds find the two together (the change of one by the other is a
//! third at most). Times are rounded up to whole ticks and the jerks of each axis follow from them exactly.

pub(super) mod axis_brake;
pub(super) mod velocity_change;

use super::plan::axis_state::{AxisState, JERK_STEP};
use super::plan::cubic_segment::MotionState;
use super::plan::units::{AXIS_UNITS, TickLimits};
use crate::number::float::{
    FloatMinMax, ceil, ceil_ticks, floor, hypot, i64_to_f32_fast, ticks_to_f32,
};
use crate::number::sqrt_f32;

/// Rounds for n1 and the peak at most, and the change of n1, ticks, after which there is none.
const ROUNDS: usize = 8;
const SETTLED: f32 = 1e-3;
/// The same where a stop is only estimated: in whole ticks it takes a tick or two more anyway.
const NEARLY_SETTLED: f32 = 0.2;
/// How often a time may be lengthened for what rounding put over a limit.
const LENGTHENINGS: usize = 24;
pub(super) const BRAKE_SLACK: f32 = 1.0 + 5e-7;

/// What is to be braked, over the limits of acceleration.
pub(super) struct Brake {
    velocity: [f32; 3],
    acceleration: [f32; 3],
    /// Jerk of translation and of rotation, a tick.
    jerk: [f32; 2],
}

impl Brake {
    /// Of a state, with acceleration and jerk limited to this much of the limits.
    pub fn new(state: &[AxisState; 3], limits: &TickLimits, acceleration: f32, jerk: f32) -> Self {
        Self::of(
            state.map(|axis| i64_to_f32_fast(axis.velocity)),
            state.map(|axis| i64_to_f32_fast(axis.acceleration)),
            limits,
            [acceleration, jerk],
        )
    }

    /// Of a state in floats, with the ordinary limits.
    pub fn in_seconds(at: &MotionState, limits: &TickLimits, hz: f32) -> Self {
        let once = AXIS_UNITS / hz;
        let each = |per: f32| [per, per, per / core::f32::consts::TAU];
        Self::of(
            times(at.v, each(once)),
            times(at.a, each(once / hz)),
            limits,
            [1.0; 2],
        )
    }

    /// The same of velocities and accelerations in floats.
    fn of(
        velocity: [f32; 3],
        acceleration: [f32; 3],
        limits: &TickLimits,
        [harder, jerkier]: [f32; 2],
    ) -> Self {
        let TickLimits {
            translation,
            rotation,
        } = limits;
        let over = [translation, rotation].map(|limits| 1.0 / (limits.acceleration * harder));
        let over_each = [over[0], over[0], over[1]];
        Self {
            velocity: times(velocity, over_each),
            acceleration: times(acceleration, over_each),
            jerk: [
                translation.jerk * jerkier * over[0],
                rotation.jerk * jerkier * over[1],
            ],
        }
    }

    /// The three times in ticks, before rounding.
    fn times(&self) -> [f32; 3] {
        self.settled_to(SETTLED)
    }

    /// The same, within a fraction of a tick.
    pub fn about(&self) -> [f32; 3] {
        self.settled_to(NEARLY_SETTLED)
    }

    fn settled_to(&self, settled: f32) -> [f32; 3] {
        let mut times = [0.0_f32; 3];
        for _ in 0..ROUNDS {
            let half = times[0] / 2.0;
            let w = self.after(half);
            let size = size(&w);
            if size <= 0.0 {
                // Nothing moves, or what does is braked exactly by releasing the acceleration.
                let release = self.jerk_ticks(&self.acceleration);
                if times[0] == release {
                    return [release, 0.0, 0.0];
                }
                times[0] = release;
                continue;
            }
            let back = self.jerk_ticks(&w) / size;
            let peak = (sqrt_f32(half * half + 2.0 * size * back) - half) / back;
            let (peak, hold) = if peak > 1.0 {
                (1.0, (size - half - back / 2.0).fmax(0.0))
            } else {
                (peak, 0.0)
            };
            let scale = peak / size;
            let change = [0, 1, 2].map(|i| w[i] * scale + self.acceleration[i]);
            let next = [self.jerk_ticks(&change), hold, peak * back];
            let change = (next[0] - times[0]).abs();
            times = next;
            if change < settled {
                break;
            }
        }
        times
    }

    /// The times in whole ticks.
    pub fn ticks(&self) -> [u64; 3] {
        whole(self.times(), |n| self.over(n)).map(ceil_ticks)
    }

    /// P in so many ticks.
    fn peak(&self, [n1, n2, n3]: [f32; 3]) -> [f32; 3] {
        let scale = -1.0 / (n1 / 2.0 + n2 + n3 / 2.0);
        self.after(n1 / 2.0).map(|w| w * scale)
    }

    /// The part of the limit that P comes to in so many ticks: jerk alone may end at less than all of it.
    pub fn part(&self, ticks: [u64; 3]) -> f32 {
        size(&self.peak(ticks.map(ticks_to_f32))).fmin(1.0)
    }

    /// Which of these times are too short: for the first jerk, the peak, the last jerk.
    fn over(&self, n: [f32; 3]) -> [bool; 3] {
        let [n1, _, n3] = n;
        let peak = self.peak(n);
        let change = [0, 1, 2].map(|i| peak[i] - self.acceleration[i]);
        let hardest = size(&self.acceleration).fmax(1.0);
        [
            self.jerk_ticks(&change) > n1 * BRAKE_SLACK,
            size(&peak) > hardest * BRAKE_SLACK,
            self.jerk_ticks(&peak) > n3 * BRAKE_SLACK,
        ]
    }

    /// Velocity that is to be braked after so much of the acceleration, over the limits.
    fn after(&self, half: f32) -> [f32; 3] {
        [0, 1, 2].map(|i| self.velocity[i] + self.acceleration[i] * half)
    }

    /// The acceleration of size 1 that points against what is to be braked, track radii and rad per second squared.
    pub fn peak_per_second(&self, limits: &TickLimits, hz: f32) -> [f32; 3] {
        let w = self.after(self.about()[0] / 2.0);
        let scale = -hz * hz / (AXIS_UNITS * size(&w).fmax(f32::MIN_POSITIVE));
        let [translation, rotation] =
            [limits.translation, limits.rotation].map(|limits| limits.acceleration * scale);
        times(
            w,
            [translation, translation, rotation * core::f32::consts::TAU],
        )
    }

    /// The time in which jerk makes an acceleration of this.
    fn jerk_ticks(&self, change: &[f32; 3]) -> f32 {
        (hypot(change[0], change[1]) / self.jerk[0]).fmax(change[2].abs() / self.jerk[1])
    }
}

/// Times in whole ticks, with what is too short by then lengthened.
pub(super) fn whole(times: [f32; 3], over: impl Fn([f32; 3]) -> [bool; 3]) -> [f32; 3] {
    let [n1, n2, n3] = times.map(|ticks| ceil(ticks - 1e-3));
    let mut n = [n1.fmax(1.0), n2, n3.fmax(1.0)];
    for _ in 0..LENGTHENINGS {
        let over = over(n);
        if over == [false; 3] {
            break;
        }
        for (n, over) in n.iter_mut().zip(over) {
            if over {
                *n += 1.0 + floor(*n * (1.0 / 64.0));
            }
        }
    }
    n
}

/// The way of a stop that takes these ticks, by its start's velocity and by its acceleration.
pub(super) fn gains([t1, t2, t3]: [f32; 3]) -> [f32; 2] {
    let area = t1 / 2.0 + t2 + t3 / 2.0;
    if !(area > 0.0) {
        return [0.0; 2];
    }
    [(1.0, 0.0), (0.0, 1.0)].map(|(v, a)| {
        let peak = -(v + a * t1 / 2.0) / area;
        let v1 = v + (a + peak) * t1 / 2.0;
        let v2 = v1 + peak * t2;
        t1 * (v + t1 * (a / 3.0 + peak / 6.0))
            + t2 * (v1 + peak * t2 / 2.0)
            + t3 * (v2 + peak * t3 / 3.0)
    })
}

/// The greater of translation and rotation.
fn size(vector: &[f32; 3]) -> f32 {
    hypot(vector[0], vector[1]).fmax(vector[2].abs())
}

fn times(vector: [f32; 3], factors: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| vector[i] * factors[i])
}

/// Jerks of the first and the last segment that bring one axis to rest in `n1 + n2 + n3` ticks; `n1` and `n3` are not
/// zero.
#[inline(never)]
pub(super) fn jerks(axis: &AxisState, [n1, n2, n3]: [u64; 3]) -> [i64; 2] {
    let (n1, n2, n3) = (n1 as i64, n2 as i64, n3 as i64);
    // An acceleration is even.
    let half = axis.acceleration / 2;
    let velocity = axis.velocity.wrapping_add(half.wrapping_mul(n1));
    let peak = -twice_over(velocity, n1 + 2 * n2 + n3);
    let first = stepped(peak - axis.acceleration, n1);
    let last = stepped(-axis.acceleration.wrapping_add(first.wrapping_mul(n1)), n3);
    [first, last]
}

/// Twice `value` over `divisor`, without an overflow, to two.
fn twice_over(value: i64, divisor: i64) -> i64 {
    let whole = over(value, divisor);
    // Less than the divisor.
    let rest = 2 * value.wrapping_sub(whole.wrapping_mul(divisor));
    2 * whole + i64::from(rest >= divisor) - i64::from(rest <= -divisor)
}

/// The jerk that changes an acceleration by `change` in `ticks`, rounded towards zero to one that integers follow
/// exactly.
pub(super) fn stepped(change: i64, ticks: i64) -> i64 {
    over(change, ticks * JERK_STEP) * JERK_STEP
}

/// A quotient rounded towards zero; zero over nothing, so that there is no panic in it.
fn over(value: i64, divisor: i64) -> i64 {
    value.checked_div(divisor).unwrap_or(0)
}
