//! Planning a stop: along the path under way, jerk-limited, from any tick of a plan.

use super::axis::{Axis, JERK_STEP};
use super::limits::Limits;
use super::plan::{Piece, Plan, Start};
use heapless::Vec;
use kinematics::Geometry;

/// How a stop brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Within the limits of ordinary motion.
    Smooth,
    /// Harder, by [`Limits::stop_factor`].
    Urgent,
}

const PER_UNIT: f64 = 1.0 / 4_722_366_482_869_645_213_696.0; // 2^-72

/// Plans the stop that leaves plan `of`, which started from `axes`, at its tick `at`. `None` where the plan itself comes to
/// rest no later: at its end, in its last segment, in a deceleration that is as hard as the stop would be; nor at its start,
/// where nothing moves yet.
///
/// The velocity and the acceleration of a straight move are parallel, so one brake profile of three segments serves all
/// axes: acceleration to -a, held, back to zero. From its durations, rounded up to whole ticks, each axis' own jerks follow
/// exactly: with n1, n2, n3 ticks, start velocity v and acceleration a0,
/// `a = -(v + a0 n1 / 2) / (n1 / 2 + n2 + n3 / 2)`.
pub fn plan_stop(
    id: u32,
    of: &Plan,
    axes: &[Axis; 3],
    at: u64,
    limits: &Limits,
    geometry: &Geometry,
    stop: Stop,
) -> Option<Plan> {
    let last = of.pieces.last().map_or(0, |piece| piece.ticks);
    if at + last >= of.ticks() {
        return None;
    }
    let state = of.state_after(axes, at);
    let times = brake_ticks(&state, limits, geometry, stop)?;
    // Rounded up to whole ticks, a stop out of the deceleration would come later than the plan's end, and beyond it.
    if at + times.iter().sum::<u64>() >= of.ticks() {
        return None;
    }
    let mut pieces = [Piece::default(); 3];
    let mut end = state;
    for (piece, ticks) in pieces.iter_mut().zip(times) {
        piece.ticks = ticks;
    }
    for (i, axis) in end.iter_mut().enumerate() {
        let [first, last] = jerks(axis, times);
        pieces[0].jerk[i] = first;
        pieces[2].jerk[i] = last;
        for piece in &pieces {
            *axis = axis.after(piece.ticks, piece.jerk[i], of.nudge[i]);
        }
    }
    let mut plan = Plan {
        id,
        start: Start::Splice {
            plan: of.id,
            tick: at,
        },
        pieces: Vec::new(),
        nudge: of.nudge,
        end: end.map(|axis| axis.rounded()),
    };
    for piece in pieces.into_iter().filter(|piece| piece.ticks > 0) {
        let _ = plan.pieces.push(piece);
    }
    Some(plan)
}

/// Durations of the three segments, for the whole motion.
fn brake_ticks(
    state: &[Axis; 3],
    limits: &Limits,
    geometry: &Geometry,
    stop: Stop,
) -> Option<[u64; 3]> {
    let hz = limits.rate_hz;
    let velocity = state.map(|axis| axis.velocity as f64 * PER_UNIT * hz);
    let along = libm::hypot(velocity[0], velocity[1]) * geometry.radius_mm;
    let turning_deg = velocity[2].abs() * 360.0;
    let factor = match stop {
        Stop::Smooth => 1.0,
        Stop::Urgent => limits.stop_factor,
    };
    // Everything below is relative to the velocity: it is 1, and per second.
    let most = (limits.acceleration_mm_s2 / along)
        .min(limits.turn_acceleration_deg_s2 / turning_deg)
        * factor;
    let jerk =
        (limits.jerk_mm_s3 / along).min(limits.turn_jerk_deg_s3 / turning_deg) * factor * factor;
    let fastest = (0..3).max_by_key(|&i| state[i].velocity.unsigned_abs())?;
    let now = state[fastest].acceleration as f64 / state[fastest].velocity as f64 * hz;
    if !(most.is_finite() && jerk.is_finite() && now.is_finite()) {
        return None;
    }
    let peak = libm::sqrt((jerk + now * now / 2.0).max(0.0))
        .min(most)
        .max(-now);
    let hold = ((1.0 + now * now / (2.0 * jerk) - peak * peak / jerk) / peak).max(0.0);
    let ticks = |seconds: f64| libm::ceil(seconds * hz) as u64;
    Some([
        ticks((now + peak) / jerk).max(1),
        ticks(hold),
        ticks(peak / jerk).max(1),
    ])
}

/// Jerks of the first and the last segment that bring one axis to rest in `times`.
pub(super) fn jerks(axis: &Axis, [n1, n2, n3]: [u64; 3]) -> [i64; 2] {
    let (v, a0) = (i128::from(axis.velocity), i128::from(axis.acceleration));
    let (n1, n2, n3) = (i128::from(n1), i128::from(n2), i128::from(n3));
    let peak = -(2 * v + a0 * n1) / (n1 + 2 * n2 + n3);
    let step = i128::from(JERK_STEP);
    let first = (peak - a0) / n1 / step * step;
    let last = -(a0 + first * n1) / n3 / step * step;
    [first as i64, last as i64]
}
