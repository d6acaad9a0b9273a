//! The fastest jerk-limited motion of one axis from any velocity and acceleration over a given distance to rest.
//!
//! ```text
//! a   A|     ______                         The state is first braken into the limits, should it lie outside (segments 1
//!      |    /      \                        and 2 below). Then the fastest stop from it, over the distance d_stop, divides
//!   a0 |---/        \                       all targets in two: one short of it is the mirror image of one beyond. For a
//!     0|-------------\________              target beyond, d > d_stop, the distance grows with one number, and that is
//!      |                      \       /     solved for:
//!   -A |                       \_____/
//!       3  4   5         6    7   8   9     A  the highest acceleration a1 < 0, when the brake is only released in part
//!                                           B  the highest speed, when it is reached for an instant
//! v    |       _______________              C  the duration of segment 6 at the highest speed allowed
//!      | __---                -__
//!      |                         -_         In A there is no 4, 5 and 6, and 7 sets out from a1.
//! ```
//!
//! All is scaled to a jerk of 1. Reaching speed `v1` at zero acceleration from speed `v`, acceleration `a`, is a part
//! of the same motion from zero acceleration, begun a time `a` earlier at `v_s = v - a^2 / 2`, a distance
//! `p_s = -a (v - a^2 / 3)` away. With `T(u) = 2 sqrt(u)` for `u <= A^2`, else `u / A + A`, the time in which speed
//! changes by `u`, it takes `T(v1 - v_s) - a` over `p_s + (v_s + v1) / 2 T(v1 - v_s)`. It begins with positive jerk as
//! long as `v1 >= v_z = v + a |a| / 2`, the speed to which releasing the acceleration at once leads; otherwise its
//! mirror image holds.
//!
//! - B: `d(v1) = p_s + (v_s + v1) / 2 T(v1 - v_s) + v1 / 2 T(v1)`, for `v1 >= max(v_z, 0)`. Over `s = sqrt(v1 - v_s)`
//!   it grows and is convex: Newton's method from above converges from any start.
//! - A: only from `a < 0`, `v_z > 0`. With `q = -a1` and `w = v_z + q^2`, the brake being virtually begun from speed
//!   `w`, `d(q) = -a (v_z + a^2 / 6) + w / 2 T(w) - q (2 v_z + q^2)`, falling from B's least at 0 to `d_stop` at `-a`.
//!
//! A longer duration is had by a lower speed in segment 6. Where there is none (near full braking the distance left is
//! too short for an even lower speed) the axis arrives early and waits: its target is at rest, so no other axis ever
//! has to wait for it, and the shortest duration of several axes is that of the slowest.
//!
//! **Digits.** How long a motion takes depends on the root of what lies between its target and the fastest stop: where
//! the two nearly meet, 24 bits of a distance are too few (1e-7 of it may be 0.1 % of the duration). So equations are
//! written for the distance *beyond the stop*, without differences of large numbers, and that distance is taken from
//! more digits where it is small (`start`).
//!
//! | file | idea |
//! |---|---|
//! | `task` | what is asked and answered |
//! | here | the fastest profile, and one that lasts longer |
//! | `state` | a state over jerk: its stop, its way back into the limits |
//! | `start` | where the main part sets out, and how far beyond the stop its target lies |
//! | `fastest` | cases A, B and C |
//! | `slower` | a longer duration |
//!
//! Accepted are all finite states and distances and all finite positive limits; see [`Unusable`]. A start over a limit
//! comes below it at full jerk and, over the speed limit, full acceleration, and meets the speed limit with zero
//! acceleration.

use crate::motion::plan::units::AxisLimits;
use crate::number::float::Float;
use start::ProfileStart;
use task::{AxisProfile, Task, Unusable};

mod fastest;
mod slower;
mod start;
mod state;
pub(crate) mod task;

impl<F: Float> AxisProfile<F> {
    /// The fastest profile.
    pub fn fastest(task: &Task, limits: &AxisLimits<F>) -> Result<Self, Unusable> {
        let start = ProfileStart::new(task, limits)?;
        start.profile(&start.fastest(), limits.jerk)
    }

    /// The duration of the fastest profile.
    pub fn shortest<T: Float>(task: &Task<T>, limits: &AxisLimits<F>) -> Result<F, Unusable> {
        let start = ProfileStart::new(task, limits)?;
        let main = start.fastest().t.into_iter();
        let duration = main.fold(start.braked(), |sum, t| sum + t);
        if duration.is_finite() {
            Ok(duration)
        } else {
            Err(Unusable::Task)
        }
    }

    /// The profile that arrives after `duration`, or the fastest where there is none. It never arrives later, unless
    /// the fastest does.
    pub fn lasting(task: &Task, limits: &AxisLimits<F>, duration: F) -> Result<Self, Unusable> {
        let start = ProfileStart::new(task, limits)?;
        let fastest = start.fastest();
        let slower = start.slower(&fastest, duration - start.braked());
        start.profile(&slower.unwrap_or(fastest), limits.jerk)
    }

    /// Whole duration.
    pub fn duration(&self) -> F {
        self.durations.iter().fold(F::ZERO, |sum, &t| sum + t)
    }
}

/// The signed distance of the fastest stop from a state within the limits of acceleration; that of `task` does not
/// count.
pub fn stop_distance(task: &Task, limits: &AxisLimits<f64>) -> f64 {
    state::State::new(task, limits.jerk).stop(limits.acceleration / limits.jerk) * limits.jerk
}
