//! Planning a jog: velocities are tried until one can be reached and given up again.

use super::request::{InitialState, JogRequest};
use super::trajectory::Jog;
use motion::check::{Budget, PlanCheck, is_over};
use motion::constraints::Constraints;
use motion::plan::axis_state::AxisState;
use motion::plan::{Plan, PlanStart};
use motion::refusal::{Refusal, RetargetError};
use motion::speeds::Speeds;

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
    // Written where it stays: a plan has a thousand bytes.
    let mut planned = Ok(Plan {
        id,
        start,
        ..Plan::default()
    });
    if let Ok(plan) = &mut planned
        && let Err(no) = write(plan, state, velocity, constraints)
    {
        planned = Err(no);
    }
    planned
}

fn write(
    plan: &mut Plan,
    state: &[AxisState; 3],
    velocity: &[f64; 3],
    constraints: &Constraints,
) -> Result<(), RetargetError> {
    let request = JogRequest::new(velocity, constraints).map_err(RetargetError::Refused)?;
    let now = InitialState::new(state, &request);
    let from_rest = matches!(plan.start, PlanStart::Rest(_));
    // Out of an urgent stop only once it is over: its acceleration is more than a jog may have.
    let acceleration = Speeds::of(&now.motion.a);
    if is_over(acceleration, request.acceleration_limits.acceleration) {
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
                jog.finish(plan, hold);
                return Ok(());
            }
            Err(_) if !from_rest => return Err(RetargetError::NeedsStop),
            Err(short) => wanted = jog.slower(&short, &request),
        }
    }
    Err(RetargetError::Refused(Refusal::NoRoom))
}

/// The point may be too near to an edge, theta to a bound, and once more for what a lower velocity changes.
const ATTEMPTS: usize = 4;
