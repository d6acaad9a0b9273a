//! Jogging: from any state to a constant velocity, held until somebody changes it, or up to the workspace's edge.
//!
//! ```text
//! speed of    ________________________                 The velocity is changed (see `profile/velocity`), held, and given up in time:
//! the point  /                        \                a plan that ends at rest like any other, exactly where it can stop.
//!          _/                          \______         Theta alone never meets an edge: its plan ends at a thousand million
//! of theta   ______________________________..          turns, 30 years away at a turn a second.
//!          _/
//! ```
//!
//! The edge is that of the disk in which the pivots can follow this velocity at any orientation (`check/pivot_bounds`):
//! the faster the jog, the smaller it may be. Who jogs outwards stops there; who stands outside of it is told that it
//! is too fast. Bounds of the moved point and of theta end a jog in the same way. When the platform turns about a point
//! beside its centre, its centre goes in circles: the point then stays where every orientation is possible, or, where
//! it is not, point and theta stop together before the centre meets the edge.
//!
//! Near an edge there may be no room to reach the velocity and to stop again: from rest a lower one is taken.
//!
//! | file | idea |
//! |---|---|
//! | here | velocities tried until one can be reached and given up again |
//! | `request` | the velocity wanted, the limits, the state that is left |
//! | `trajectory` | the way to the velocity, the velocity held, the way to rest |
//! | `hold_time` | how long it is held, and how much slower it has to be |

mod request;
mod trajectory;

use motion::check::{Budget, PlanCheck, is_over};
use motion::constraints::Constraints;
use motion::constraints::Speeds;
use motion::plan::axis_state::AxisState;
use motion::plan::{Plan, PlanStart};
use motion::refusal::{Refusal, RetargetError};
use request::{InitialState, JogRequest};
use trajectory::Jog;

/// Plans the way to `velocity` (mm/s, mm/s and deg/s of x, y and theta), and on with it, from `state`, which is where
/// `start` says. Zero is a velocity as any other: that axis stops smoothly.
///
/// # Errors
/// [`RetargetError::Refused`] when there is no such jog, with the reason; [`RetargetError::NeedsStop`] when there is,
/// but not without a stop before.
#[inline(never)]
pub fn plan_jog(
    id: u32,
    start: PlanStart,
    state: &[AxisState; 3],
    velocity: &[f64; 3],
    constraints: &Constraints,
) -> Result<Plan, RetargetError> {
    let mut plan = Plan::new(id, start, [0; 3]);
    let request = JogRequest::new(velocity, constraints).map_err(RetargetError::Refused)?;
    let now = InitialState::new(state, &request);
    let from_rest = matches!(plan.start, PlanStart::Rest(_));
    // Out of an urgent stop only once it is over: its acceleration is more than a jog may have.
    let acceleration = Speeds::of(&now.motion.a);
    if is_over(acceleration, request.limits.acceleration) {
        return Err(RetargetError::NeedsStop);
    }
    let mut wanted = request.velocity;
    for _ in 0..ATTEMPTS {
        if from_rest && wanted == [0; 3] && request.velocity != wanted {
            return Err(RetargetError::Refused(Refusal::NoRoom));
        }
        let jog = Jog::new(state, &now, wanted, &request, &mut plan.pieces)?;
        match jog.hold(state, &request, from_rest) {
            Ok(hold) => {
                // From rest the way there is the first part of the way on, which was looked at for the time that it is
                // held.
                if !from_rest {
                    PlanCheck::new(constraints, state)
                        .check(&plan.pieces, state, &mut { Budget::FOR_ANSWER })
                        .map_err(|_| RetargetError::NeedsStop)?;
                }
                jog.finish(&mut plan, hold);
                return Ok(plan);
            }
            Err(_) if !from_rest => return Err(RetargetError::NeedsStop),
            Err(short) => wanted = jog.slower(&short, &request),
        }
    }
    Err(RetargetError::Refused(Refusal::NoRoom))
}

/// The point may be too near to an edge, theta to a bound, and once more for what a lower velocity changes.
const ATTEMPTS: usize = 4;
