//! From any velocity and acceleration to a wanted velocity: stops, jogs, and the end of a stream.
//!
//! ```text
//! a0 \                  Velocity and acceleration are vectors here, of x, y and theta. The acceleration goes straight from
//!     \                 a0 to a peak P, stays there, and goes straight back to zero, for t1, t2 and t3. With c the velocity
//!   0 -\--------/--     that is to be gained:
//!       \______/          P = (c - a0 t1 / 2) / (t1 / 2 + t2 + t3 / 2)
//!   P  t1  t2  t3       A straight line between two accelerations within a limit stays within it, whatever the direction;
//!                       when c and a0 are parallel, so is P: a stop out of a straight motion stays on its line.
//! ```
//!
//! Sizes are measured by what is allowed: translation and rotation each over its limit of acceleration, the greater
//! counts. With `w = c - a0 t1 / 2`, to be gained along its own direction, where jerk may change the size by `j` a
//! second, the shortest times for a given `t1` have a peak of `p = j (sqrt(t1^2 / 4 + 2 |w| / j) - t1 / 2)`, or of 1 and
//! a time at it. `t1` follows from `|P - a0|`; a few rounds find the two together (the change of one by the other is a
//! third at most).
//!
//! Times are rounded up to whole ticks and the jerks of each axis follow from them in integers
//! ([`quantise`](crate::plan::quantise)). One more tick closes what rounding leaves of the acceleration, so
//! that a velocity that is kept for years is kept.

use crate::constraints::MotionLimits;
use crate::plan::cubic_segment::MotionState;
use crate::tolerances::{ROUNDED_TIMES, WHOLE_TICKS};
use number::float::{FloatMinMax, ceil, ceil_ticks, floor, hypot};
use number::sqrt_f32;

/// Rounds for t1 and the peak at most, which of them halve, and the change of t1 after which there is none.
const ROUNDS: usize = 24;
const HALVED: usize = 3;
const SETTLED_S: f32 = 5e-8;
/// How often a time may be lengthened for what rounding put over a limit.
const LENGTHENINGS: usize = 24;

/// A change of velocity, with everything over the limits of acceleration.
pub struct VelocityProfile {
    /// c, s.
    change: [f32; 3],
    /// a0.
    acceleration: [f32; 3],
    /// Of translation and of rotation, 1/s.
    jerk: [f32; 2],
    /// How much more of it the first segment may have: 1 but for a motion that others shape, with more jerk than the limit.
    pub first_jerk: f32,
}

impl VelocityProfile {
    /// From a state to a velocity, track radii and rad per second.
    #[inline(never)]
    pub fn new(from: &MotionState, wanted: &[f32; 3], limits: &MotionLimits) -> Self {
        let limit = limits.acceleration;
        let over = [1.0 / limit.linear, 1.0 / limit.angular];
        let over_each = [over[0], over[0], over[1]];
        Self {
            change: each!(i => (wanted[i] - from.v[i]) * over_each[i]),
            acceleration: each!(i => from.a[i] * over_each[i]),
            jerk: [limits.jerk.linear * over[0], limits.jerk.angular * over[1]],
            first_jerk: 1.0,
        }
    }

    /// The three times, s, before rounding.
    pub fn times_s(&self) -> [f32; 3] {
        if self.acceleration == [0.0; 3] {
            return self.times_without_acceleration_s();
        }
        let mut times = [0.0_f32; 3];
        let (mut t1, mut low, mut high) = (0.0_f32, 0.0_f32, f32::INFINITY);
        for round in 1..=ROUNDS {
            times = self.times_after_s(t1);
            let next = times[0];
            if (next - t1).abs() < SETTLED_S {
                break;
            }
            if next > t1 {
                low = t1;
            } else {
                high = t1;
            }
            // Near a release that gains all by itself one overshoots the other: then halving finds them.
            let is_between = low < next && next < high;
            t1 = if is_between && round % HALVED != 0 {
                next
            } else {
                low + (high.fmin(2.0 * low + times[0]) - low) / 2.0
            };
        }
        times
    }

    /// The times with a peak that is the soonest for a first one of `t1`.
    fn times_after_s(&self, t1: f32) -> [f32; 3] {
        let half = t1 / 2.0;
        let w = self.left_after(half);
        let size = size(&w);
        if size <= 0.0 {
            // Nothing is to be gained, or releasing the acceleration gains it exactly.
            let release_s = self.jerk_time_s(&self.acceleration) / self.first_jerk;
            return [release_s, 0.0, 0.0];
        }
        let back = self.jerk_time_s(&w) / size;
        let peak = (sqrt_f32(half * half + 2.0 * size * back) - half) / back;
        let (peak, hold) = if peak > 1.0 {
            (1.0, (size - half - back / 2.0).fmax(0.0))
        } else {
            (peak, 0.0)
        };
        let scale = peak / size;
        let change = each!(i => w[i] * scale - self.acceleration[i]);
        [
            self.jerk_time_s(&change) / self.first_jerk,
            hold,
            peak * back,
        ]
    }

    /// In closed form, up and down alike.
    fn times_without_acceleration_s(&self) -> [f32; 3] {
        let (size, rise) = (size(&self.change), self.jerk_time_s(&self.change));
        if size <= 0.0 {
            return [0.0; 3];
        }
        // A peak of 1 takes so long; as much is gained by then.
        let full = rise / size;
        if size > full {
            [full, size - full, full]
        } else {
            let rise = sqrt_f32(rise);
            [rise, 0.0, rise]
        }
    }

    /// The times in whole ticks, with what is too short by then lengthened; the first and the last are not zero.
    #[inline(never)]
    pub fn ticks(&self, hz: f32) -> [u64; 3] {
        let times_s = self.times_s();
        let [n1, n2, n3] = each!(k => ceil(times_s[k] * hz - WHOLE_TICKS));
        let mut n = [n1.fmax(1.0), n2, n3.fmax(1.0)];
        let tick_s = 1.0 / hz;
        for round in 0..LENGTHENINGS {
            let short = self.too_short(each!(k => n[k] * tick_s));
            if short == [false; 3] {
                break;
            }
            for (n, short) in n.iter_mut().zip(short) {
                if short {
                    // As a rule a tick is missing. Where releasing the acceleration nearly gains it all, rounding may ask
                    // for a peak the other way, which is far.
                    *n += 1.0 + floor((round * round) as f32 * 0.125);
                }
            }
        }
        each!(k => ceil_ticks(n[k]))
    }

    /// P over the limits in so much time.
    fn peak(&self, [t1, t2, t3]: [f32; 3]) -> [f32; 3] {
        let scale = 1.0 / (t1 / 2.0 + t2 + t3 / 2.0);
        let w = self.left_after(t1 / 2.0);
        each!(i => w[i] * scale)
    }

    /// The part of the limit that P comes to in so much time: jerk alone may end at less than all of it.
    pub fn peak_size(&self, times_s: [f32; 3]) -> f32 {
        size(&self.peak(times_s)).fmin(1.0)
    }

    /// Which of these times are too short.
    fn too_short(&self, times_s: [f32; 3]) -> [bool; 3] {
        let [t1, _, t3] = times_s;
        let peak = self.peak(times_s);
        let change = each!(i => peak[i] - self.acceleration[i]);
        let hardest = size(&self.acceleration).fmax(1.0);
        [
            self.jerk_time_s(&change) > t1 * self.first_jerk * ROUNDED_TIMES,
            size(&peak) > hardest * ROUNDED_TIMES,
            self.jerk_time_s(&peak) > t3 * ROUNDED_TIMES,
        ]
    }

    /// What is left to be gained after so long of half the acceleration's release.
    fn left_after(&self, half_s: f32) -> [f32; 3] {
        each!(i => self.change[i] - self.acceleration[i] * half_s)
    }

    /// The time in which jerk makes an acceleration of this.
    fn jerk_time_s(&self, change: &[f32; 3]) -> f32 {
        (hypot(change[0], change[1]) / self.jerk[0]).fmax(change[2].abs() / self.jerk[1])
    }
}

/// The greater of translation and rotation.
fn size(vector: &[f32; 3]) -> f32 {
    hypot(vector[0], vector[1]).fmax(vector[2].abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::Speeds;
    use crate::plan::axis_state::AXIS_UNITS;
    use crate::plan::axis_state::AxisState;
    use crate::plan::quantise::velocity_pieces;
    use number::random::Random;

    const HZ: f32 = 20_000.0;
    /// 40 track radii and 126 rad per second squared; a hundred times as much per second cubed.
    const LIMITS: MotionLimits = MotionLimits {
        speed: Speeds {
            linear: 2.0,
            angular: 6.3,
        },
        acceleration: Speeds {
            linear: 40.0,
            angular: 126.0,
        },
        jerk: Speeds {
            linear: 4_000.0,
            angular: 12_600.0,
        },
    };

    fn axes(v: [f64; 3], a: [f64; 3]) -> [AxisState; 3] {
        let unit = [1.0, 1.0, core::f64::consts::TAU];
        [0, 1, 2].map(|i| AxisState {
            position: 0,
            velocity: (v[i] / unit[i] / f64::from(HZ) * f64::from(AXIS_UNITS)) as i64,
            acceleration: (a[i] / unit[i] / f64::from(HZ * HZ) * f64::from(AXIS_UNITS)) as i64 / 6
                * 6,
        })
    }

    /// Stops out of any state, most of them out of one that is nearly at rest by itself.
    #[test]
    fn acceleration_and_jerk_keep_their_limits() {
        let mut random = Random::new(7);
        let mut next = || random.within_one();
        for round in 0..40_000 {
            let (mut v, mut a) = ([0.0; 3], [0.0; 3]);
            for i in 0..3 {
                let most = [28.0, 28.0, 126.0][i];
                a[i] = next() * most;
                let release = -a[i] * a[i].abs() / 2.0 / (most * 100.0);
                v[i] = if round % 4 == 0 {
                    next() * [1.4, 1.4, 6.2][i]
                } else {
                    release * (1.0 + next() * 10_f64.powf(-6.0 * next().abs()))
                };
                if round % 3 == i {
                    (v[i], a[i]) = (0.0, 0.0);
                }
            }
            let state = axes(v, a);
            let now = MotionState::new(&state, HZ);
            let profile = VelocityProfile::new(&now, &[0.0; 3], &LIMITS);
            let ticks = profile.ticks(HZ);
            let mut acceleration = now.a;
            for piece in velocity_pieces(&state, &[0; 3], ticks) {
                let jerk = crate::plan::cubic_segment::CubicSegment::jerk(&piece, HZ);
                let jerks = Speeds::of(&jerk);
                assert!(
                    jerks.linear <= LIMITS.jerk.linear * 1.000_1
                        && jerks.angular <= LIMITS.jerk.angular * 1.000_1,
                    "{v:?} {a:?} {ticks:?} {jerks:?} {:?}",
                    profile.times_s().map(|t| t * HZ)
                );
                for i in 0..3 {
                    acceleration[i] += jerk[i] * piece.ticks as f32 / HZ;
                }
                let accelerations = Speeds::of(&acceleration);
                assert!(
                    accelerations.linear <= LIMITS.acceleration.linear * 1.000_1
                        && accelerations.angular <= LIMITS.acceleration.angular * 1.000_1,
                    "{v:?} {a:?} {ticks:?}"
                );
            }
        }
    }
}
