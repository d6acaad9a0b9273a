//! Planning a jog: velocities are tried until one can be reached and given up again.

use super::request::{InitialState, JogRequest};
use super::trajectory::Jog;
use crate::motion::check::{CheckBudget, CheckedPieces, PlanCheck};
use crate::motion::constraints::Constraints;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::TickLimits;
use crate::motion::plan::{Pieces, Plan, PlanStart};
use crate::motion::refusal::{Refusal, RetargetError};

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
                    check(&plan.pieces, state, constraints)?;
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

/// Looks at the way to the velocity as at any other.
fn check(
    pieces: &Pieces,
    state: &[AxisState; 3],
    constraints: &Constraints,
) -> Result<(), RetargetError> {
    let plan_check = PlanCheck::new(constraints, TickLimits::new(constraints), state);
    let mut checked_pieces = CheckedPieces::new();
    plan_check.prepare(pieces, state, &mut checked_pieces);
    plan_check
        .check(&checked_pieces, &mut { CheckBudget::WHOLE })
        .map_err(|_| RetargetError::NeedsStop)
}
