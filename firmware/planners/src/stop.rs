//! Planning a stop from any tick of any plan: all axes brake together (see `profile/velocity`).
//!
//! From a straight motion the stop goes on along the line. From a curve it goes on where velocity and acceleration
//! point; where that would leave the workspace it brakes harder.

use motion::check::{BUDGET, PlanCheck, Violation};
use motion::constraints::{Constraints, MotionLimits};
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::{CubicSegment, MotionState};
use motion::plan::quantise::{velocity_pieces, write_velocity_pieces};
use motion::plan::{Piece, Pieces, Plan, state_after_pieces, write_sum};
use motion::profile::velocity::VelocityProfile;
use motion::tolerances::PIVOT_PART_FOR_BRAKING;
use number::float::{FloatMinMax, hypot, ticks_to_f32};

/// How a stop brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Within the limits of ordinary motion.
    Smooth,
    /// As hard as the pivots can follow; jerk within the limits times the square of
    /// [`Limits::stop_factor`](motion::Limits::stop_factor).
    Urgent,
}

/// How often a stop is planned again, as what was broken asks for.
const ATTEMPTS: usize = 6;
/// Hardest brake, in limits of acceleration: jerk alone ends at less.
const HARDEST: f32 = 30.0;
/// Gentlest.
const GENTLEST: f32 = 0.1;

/// Plans the stop that leaves plan `of`, which started from `axes`, at its tick `at`. `None` where the plan itself
/// comes to rest no later: at its end, in its last segment, in a deceleration that is as hard as the stop would be.
///
/// A smooth stop is within the ordinary limits, or less where the pivots ask for it, or as hard as the edge of the
/// workspace asks for.
#[inline(never)]
pub fn plan_stop(
    id: u32,
    of: &Plan,
    axes: &[AxisState; 3],
    at: u64,
    constraints: &Constraints,
    stop: Stop,
) -> Option<Plan> {
    let whole = of.ticks();
    if at + of.pieces.last().map_or(0, |piece| piece.ticks) >= whole {
        return None;
    }
    let state = &of.state_after(axes, at);
    let mut plan = Plan::new(id, of.left_at(at), of.end);
    plan.nudge = of.nudge;
    let mut plan_check = PlanCheck::for_stop(constraints, state, stop == Stop::Urgent);
    let hz = constraints.limits.rate_hz as f32;
    let now = MotionState::new(state, hz);
    let urgent_jerk = constraints.limits.urgent_jerk();
    // How hard it brakes, in limits of acceleration and of jerk.
    let (mut acceleration, mut jerk) = match stop {
        Stop::Smooth => (1.0, 1.0),
        Stop::Urgent => (hardest_brake(state, constraints), urgent_jerk),
    };
    let mut apart = false;
    for _ in 0..ATTEMPTS {
        let limits = constraints.motion_limits().scaled(acceleration, jerk);
        let profile = VelocityProfile::new(&now, &[0.0; 3], &limits);
        let ticks = profile.ticks(hz);
        if apart {
            write_apart(&mut plan.pieces, state, &limits, hz);
        } else {
            write_velocity_pieces(&mut plan.pieces, state, &[0; 3], ticks);
        }
        // Rounded up to whole ticks, a stop out of the deceleration would come later than the plan's end, and beyond
        // it. So may one that had to be made softer.
        if plan.ticks() >= whole - at {
            return None;
        }
        match plan_check.check(&plan.pieces, state, &mut { BUDGET }) {
            Ok(()) => break,
            // Translation that waits for rotation, or the other way round, may get faster than the limit meanwhile. More
            // can not be done about it.
            Err(Violation::Speed) => {
                apart = true;
                plan_check = PlanCheck::for_stop(constraints, state, apart);
            }
            Err(Violation::Disk | Violation::Bounds(_)) => {
                (acceleration, jerk) = (acceleration * 1.3, urgent_jerk);
            }
            Err(Violation::Pivots) => {
                let most = |pieces: &[Piece]| {
                    let [rate, acceleration] = plan_check.pivot_parts(pieces, state);
                    rate.fmax(acceleration)
                };
                let over = most(&plan.pieces).fmax(1.0);
                // What the motion asks of the pivots already, no brake takes from them.
                if over <= most(&[]) {
                    break;
                }
                let times_s = each!(k => ticks_to_f32(ticks[k]) / hz);
                let used = acceleration * profile.peak_size(times_s);
                acceleration = (used * (PIVOT_PART_FOR_BRAKING / over).fmax(0.5)).fmax(GENTLEST);
            }
            // A stop has no limits of its own, and needs no room for another.
            Err(_) => break,
        }
    }
    // A stop has to be found: what is still broken after the last attempt can not be helped.
    let end = state_after_pieces(state, &plan.pieces, &[0; 3]);
    let ticks = plan.ticks();
    plan.end = each!(i => end[i].rest_position(ticks, plan.nudge[i]));
    Some(plan)
}

/// A stop in which translation and rotation each brake as soon as they can.
fn write_apart(pieces: &mut Pieces, state: &[AxisState; 3], limits: &MotionLimits, hz: f32) {
    let ([x, y, theta], still) = (*state, AxisState::default());
    let [translation, rotation] = [[x, y, still], [still, still, theta]].map(|axes| {
        let now = MotionState::new(&axes, hz);
        let ticks = VelocityProfile::new(&now, &[0.0; 3], limits).ticks(hz);
        velocity_pieces(&axes, &[0; 3], ticks)
    });
    // Eight of many.
    let _ = write_sum(&translation, &rotation, 0, pieces);
}

/// How hard the pivots can brake here, in limits of acceleration: what their own leaves when the part that comes of the
/// motion itself is taken off.
fn hardest_brake(state: &[AxisState; 3], constraints: &Constraints) -> f32 {
    let segment = CubicSegment::new(state, constraints.limits.rate_hz as f32);
    let (v, limit) = (segment.start.v, constraints.motion_limits().acceleration);
    let size = (hypot(v[0], v[1]) / limit.linear).fmax(v[2].abs() / limit.angular);
    let over = 1.0 / size.fmax(f32::MIN_POSITIVE);
    let accelerations = |a: [f32; 3]| {
        let motion = MotionState { a, ..segment.start };
        segment.platform(&motion, constraints.centre()).pivots()[1]
    };
    let (drift, braked) = (accelerations([0.0; 3]), accelerations(v.map(|v| -v * over)));
    let most = constraints.limits.pivot_acceleration_rad_s2 as f32 * PIVOT_PART_FOR_BRAKING;
    (0..3).fold(HARDEST, |hardest, i| {
        let left = most - drift[i].abs();
        hardest.fmin((left / (braked[i] - drift[i]).abs()).fmax(GENTLEST))
    })
}
