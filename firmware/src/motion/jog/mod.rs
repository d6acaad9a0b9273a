//! Jogging: from any state to a constant velocity, held until somebody changes it, or up to the workspace's edge.
//!
//! ```text
//! speed of    ________________________                 The velocity is changed (see `change`), held, and given up in time:
//! the point  /                        \                a plan that ends at rest like any other, exactly where it can stop.
//!          _/                          \______         Theta alone never meets an edge: its plan ends at a thousand million
//! of theta   ______________________________..          turns, 30 years away at a turn a second.
//!          _/
//! ```
//!
//! The edge is that of the disk in which the pivots can follow this velocity at any orientation (see `check/pivot_bounds`): the faster
//! the jog, the smaller it may be. Who jogs outwards stops there; who stands outside of it is told that it is too fast.
//! Bounds of the moved point and of theta end a jog in the same way. When the platform turns about a point beside its centre,
//! its centre goes in circles: the point then stays where every orientation is possible, or, where it is not, point and theta
//! stop together before the centre meets the edge.
//!
//! Near an edge there may be no room to reach the velocity and to stop again: from rest a lower one is taken.

mod end;
mod hold;
mod start;
mod travel;

use self::end::HoldThenStop;
use self::start::{InitialState, JogRequest};
use super::brake::velocity_change::{AccelerationLimits, VelocityRamp, release_acceleration};
use super::check::pivot_bounds::{Speeds, per_second};
use super::check::{CheckBudget, CheckedPieces, PlanCheck};
use super::constraints::Constraints;
use super::plan::axis_state::AxisState;
use super::plan::units::TickLimits;
use super::plan::{Piece, Plan, PlanStart, state_after_pieces};
use super::profile::tracks::Pieces;
use super::refusal::Refusal;
use super::retarget::RetargetError;

/// Plans the way to `velocity` (mm/s, mm/s and deg/s of x, y and theta), and on with it, from `state`, which is where `start`
/// says. Zero is a velocity as any other: that axis stops smoothly.
///
/// # Errors
/// [`RetargetError::Refused`] when there is no such jog, with the reason; [`RetargetError::NeedsStop`] when there is, but not
/// without a stop before.
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
                // From rest the way there is the first part of the way on, which was looked at for the time that it is held.
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
    let mut legs = CheckedPieces::new();
    plan_check.prepare(pieces, state, &mut legs);
    plan_check
        .check(&legs, &mut { CheckBudget::WHOLE })
        .map_err(|_| RetargetError::NeedsStop)
}

/// A jog from the state on in which its velocity is reached.
struct Jog {
    /// 2^-72 units a tick.
    wanted: [i64; 3],
    /// Where the velocity is reached.
    steady: [AxisState; 3],
    /// Ticks of the change of velocity, release not counted.
    ramp: u64,
    /// Brings the velocity back to zero.
    brake: VelocityRamp,
    force: AccelerationLimits,
    radius: f32,
}

impl Jog {
    /// Writes the pieces of the way there, too.
    fn new(
        state: &[AxisState; 3],
        now: &InitialState,
        wanted: [i64; 3],
        request: &JogRequest,
        pieces: &mut Pieces,
    ) -> Result<Self, RetargetError> {
        let hz = request.hz;
        let target = per_second(&wanted, hz);
        let (radius, force) = request.limits_towards(now, &target)?;
        pieces.clear();
        let released =
            release_acceleration(state, Speeds::of(&now.acceleration), force.jerk, hz, pieces);
        let change = [0, 1, 2].map(|i| wanted[i] - released[i]);
        let ramp = VelocityRamp::new(Speeds::of(&per_second(&change, hz)), &force, hz);
        for piece in ramp.pieces(change) {
            // Release and ramp are five.
            let _ = pieces.push(piece);
        }
        Ok(Self {
            wanted,
            steady: state_after_pieces(state, pieces, &[0; 3]),
            ramp: ramp.ticks(),
            brake: VelocityRamp::new(Speeds::of(&target), &force, hz),
            force,
            radius,
        })
    }

    /// Adds pieces for the velocities held for `hold` ticks and given up, the point's and theta's for themselves.
    fn finish(&self, plan: &mut Plan, [point, _, turn]: [u64; 3]) {
        let begun = plan.pieces.len();
        let change = [0, 1, 2].map(|i| match self.wanted[i] {
            0 => 0,
            _ => -self.steady[i].velocity,
        });
        let brakes = self.brake.pieces(change);
        let mut ends = [
            HoldThenStop::new(change[..2] != [0, 0], point),
            HoldThenStop::new(change[2] != 0, turn),
        ];
        // Whatever begins or ends somewhere begins a piece.
        while let Some(ticks) = ends[0].next_change(&ends[1]) {
            let jerks = [0, 1].map(|i| ends[i].jerk(&brakes));
            if ticks > 0 {
                // Room for the ramp's five and eight for two ends.
                let _ = plan.pieces.push(Piece {
                    ticks,
                    jerk: [jerks[0][0], jerks[0][1], jerks[1][2]],
                });
            }
            for end in &mut ends {
                end.advance(ticks, &brakes);
            }
        }
        let rest = state_after_pieces(&self.steady, &plan.pieces[begun..], &[0; 3]);
        plan.pieces.retain(|piece| piece.ticks > 0);
        // The velocity that rounding leaves an axis is less than one can see, but an axis may stand while another goes on.
        plan.nudge = rest.map(|axis| -axis.velocity);
        let ticks = plan.ticks();
        plan.end = rest.map(|axis| axis.rest_position(ticks, -axis.velocity));
    }
}
