//! Planning a stop from any tick of any plan: all axes brake together (see `brake`).
//!
//! From a straight motion the stop goes on along the line. From a curve it goes on where velocity and acceleration
//! point; a curve is only planned where such a stop ends inside the workspace. The braking of a jog at an edge, in
//! which theta comes to rest later than the point, leaves no room for a brake that takes as long for both: then each
//! has its own.

use super::brake::Brake;
use super::check::platform::greatest;
use super::check::violation::Violation;
use super::check::{CheckBudget, CheckedPieces, PlanCheck};
use super::constraints::Constraints;
use super::plan::axis_state::AxisState;
use super::plan::cubic_segment::CubicSegment;
use super::plan::units::TickLimits;
use super::plan::{Piece, Pieces, Plan, PlanStart};
use super::profile::tracks::{brake, merged};
use super::profile::whole_ticks::Track;
use crate::number::float::FloatMinMax;

/// How a stop brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Within the limits of ordinary motion.
    Smooth,
    /// As hard as the pivots can follow; jerk within the limits times the square of
    /// [`Limits::stop_factor`](super::Limits::stop_factor).
    Urgent,
}

/// How often a stop is planned again, as what was broken asks for.
const ATTEMPTS: usize = 6;
/// Hardest brake, in limits of acceleration: jerk alone ends at less.
const HARDEST: f32 = 30.0;
/// Gentlest.
const GENTLEST: f32 = 0.1;

/// Plans the stop that leaves plan `of`, which started from `axes`, at its tick `at`. `None` where the plan itself
/// comes to rest no later: at its end, in its last segment, in a deceleration that is as hard as the stop would be; nor
/// at its start, where nothing moves yet.
///
/// A smooth stop is within the ordinary limits, or less where the pivots ask for it, or as hard as the edge of the
/// workspace asks for.
pub fn plan_stop(
    id: u32,
    of: &Plan,
    axes: &[AxisState; 3],
    at: u64,
    constraints: &Constraints,
    stop: Stop,
) -> Option<Plan> {
    let mut plan = Plan::default();
    // A stop has to be found: what is still broken after the last attempt can not be helped.
    let _ = write_stop(&mut plan, of, axes, at, constraints, stop, ATTEMPTS)?;
    plan.id = id;
    Some(plan)
}

/// Writes the same, found in so many attempts, and what is broken even so.
#[inline(never)]
pub(super) fn write_stop(
    plan: &mut Plan,
    of: &Plan,
    axes: &[AxisState; 3],
    at: u64,
    constraints: &Constraints,
    stop: Stop,
    attempts: usize,
) -> Option<Result<(), Violation>> {
    let whole = of.ticks();
    let last = of.pieces.last().map_or(0, |piece| piece.ticks);
    if at + last >= whole {
        return None;
    }
    let state = of.state_after(axes, at);
    if state
        .iter()
        .all(|axis| axis.velocity == 0 && axis.acceleration == 0)
    {
        return None;
    }
    let limits = TickLimits::new(constraints);
    let plan_check = PlanCheck::for_stop(constraints);
    let factor = constraints.limits.stop_factor as f32;
    plan.start = PlanStart::Splice {
        plan: of.id,
        tick: at,
    };
    plan.nudge = of.nudge;
    let (most, asked) = hardest_brake(&state, &limits, constraints);
    let mut hardness = match stop {
        Stop::Smooth => [most.fmin(1.0), 1.0],
        Stop::Urgent => [most, factor * factor],
    };
    let (mut apart, mut checked_pieces) = (false, CheckedPieces::new());
    let mut checked = Ok(());
    for _ in 0..attempts {
        let brake = Brake::new(&state, &limits, hardness[0], hardness[1]);
        let ticks = brake.ticks();
        if apart {
            write_pieces(
                &state,
                apart_ticks(&state, &limits, hardness),
                &mut plan.pieces,
            );
        } else {
            write_pieces(&state, [ticks; 3], &mut plan.pieces);
        }
        // Rounded up to whole ticks, a stop out of the deceleration would come later than the plan's end, and beyond
        // it. So may one that had to be made softer.
        let lasts = plan.ticks();
        if at + lasts >= whole {
            return None;
        }
        let end = plan_check.prepare(&plan.pieces, &state, &mut checked_pieces);
        plan.end = [0, 1, 2].map(|i| end[i].rest_position(lasts, plan.nudge[i]));
        // A stop has to be found: none is left unlooked at because others have been looked at before.
        checked = plan_check.check(&checked_pieces, &mut { CheckBudget::WHOLE });
        match checked {
            Ok(()) | Err(Violation::Unchecked) => break,
            // Translation is not kept waiting for rotation then, nor the other way round.
            Err(Violation::Workspace | Violation::NoRoomToStop) if !apart => apart = true,
            Err(Violation::Workspace | Violation::NoRoomToStop) => {
                hardness = [hardness[0] * 1.3, factor * factor];
            }
            Err(
                Violation::PivotRate(over)
                | Violation::PivotAcceleration(over)
                | Violation::Speed(over)
                | Violation::Acceleration(over),
            ) => {
                // What the motion asks of the pivots already, no brake takes from them.
                if over <= asked {
                    break;
                }
                let used = hardness[0] * brake.part(ticks);
                hardness[0] = (used * (0.98 / over).fmax(0.5)).fmax(GENTLEST);
            }
        }
    }
    Some(checked)
}

/// Ticks in which translation and rotation each brake as soon as they can.
fn apart_ticks(state: &[AxisState; 3], limits: &TickLimits, hardness: [f32; 2]) -> [[u64; 3]; 3] {
    let [x, y, theta] = *state;
    let still = AxisState::default();
    let ticks =
        |state: [AxisState; 3]| Brake::new(&state, limits, hardness[0], hardness[1]).ticks();
    let way = ticks([x, y, still]);
    [way, way, ticks([still, still, theta])]
}

/// Writes the pieces that brake the axes in so many ticks.
fn write_pieces(state: &[AxisState; 3], ticks: [[u64; 3]; 3], pieces: &mut Pieces) {
    let mut tracks: [Track; 3] = Default::default();
    for (track, (axis, ticks)) in tracks.iter_mut().zip(state.iter().zip(ticks)) {
        brake(track, axis, ticks);
    }
    merged(&tracks, pieces);
}

/// How hard the pivots can brake here, in limits of acceleration: what their acceleration leaves when the part that
/// comes of the motion itself is taken off. And the largest part of a limit of theirs that they reach as it is.
fn hardest_brake(
    state: &[AxisState; 3],
    limits: &TickLimits,
    constraints: &Constraints,
) -> (f32, f32) {
    let hz = constraints.limits.rate_hz as f32;
    let centre = constraints.rotation_centre.map(|value| value as f32);
    let most = constraints.limits.pivot_acceleration_rad_s2 as f32 * 0.98;
    let segment = CubicSegment::new(state, &Piece::default(), hz);
    let peak = Brake::new(state, limits, 1.0, 1.0).peak_per_second(limits, hz);
    let mut drifting = segment.start;
    drifting.a = [0.0; 3];
    let mut braking = drifting;
    braking.a = peak;
    let [_, drift] = segment.platform(&drifting, centre).pivots();
    let [_, braked] = segment.platform(&braking, centre).pivots();
    let mut hardest = HARDEST;
    for i in 0..3 {
        let part = braked[i] - drift[i];
        let left = most - drift[i].abs();
        if part != 0.0 && left < hardest * part.abs() {
            hardest = left / part.abs();
        }
    }
    let [rates, accelerations] = segment.platform(&segment.start, centre).pivots();
    let rate = greatest(&rates) / constraints.limits.pivot_rate_rad_s as f32;
    let acceleration =
        greatest(&accelerations) / constraints.limits.pivot_acceleration_rad_s2 as f32;
    (hardest.fmax(GENTLEST), rate.fmax(acceleration))
}
