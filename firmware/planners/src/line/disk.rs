//! Whether a line stays inside the usable disk on its way.
//!
//! The platform centre goes `C = P - R(theta) p`. With p = 0 it goes straight, and nowhere is it further out than at an
//! end. In general it is followed from both ends on (see `steady_motion`, with the path parameter for seconds), each time up
//! to where it would leave the disk, or the point the smaller disk in which every orientation is inside. The line stays
//! inside if the two ways meet. A whole turn further out leaves the disk, because at some orientation the two lengths
//! add up.

use super::path::Path;
use crate::steady_motion::SteadyMotion;
use motion::check::workspace::check_target;
use motion::constraints::Constraints;
use motion::plan::Position;
use motion::refusal::Refusal;
use motion::tolerances::{JOG_RADII, LINE_SQUARED_RADII};
use number::float::FloatMinMax;
use number::sqrt_f32;

/// Whether the straight line between two positions can be moved along: the same answer as that of
/// [`plan_line`](crate::plan_line).
#[inline(never)]
pub fn check_line(
    from: &Position,
    to: &Position,
    constraints: &Constraints,
) -> Result<(), Refusal> {
    check_target(to, constraints)?;
    if !constraints.limits.all_positive() {
        return Err(Refusal::InvalidLimits);
    }
    let usable = constraints.usable_radius as f32;
    // A line of no length has no bend to walk along.
    if constraints.rotation_centre == [0.0; 2] || from == to {
        return Ok(());
    }
    let path = Path::new(from, to, constraints);
    let walk = |point: [f32; 2], theta: i64, sign: f32| SteadyMotion {
        point,
        theta,
        velocity: path.displacement.map(|way| way * sign),
        turning: path.turn * sign,
        centre: constraints.centre(),
    };
    let there = walk(path.from, from[2], 1.0);
    let back = walk(path.point(1.0), to[2], -1.0);
    // Or no further out than it starts, when it starts outside.
    let limit = there.square(0.0).0.fmax(usable * usable) + LINE_SQUARED_RADII;
    let limit = sqrt_f32(limit) + JOG_RADII;
    let (first, last) = (there.time_to_edge(limit), 1.0 - back.time_to_edge(limit));
    (first >= last).then_some(()).ok_or(Refusal::LeavesDisk)
}
