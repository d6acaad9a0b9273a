//! How far a target can go in a direction.

use super::axis::Axis;
use super::soft::SoftLimits;
use super::target::{Coordinates, travel};
use kinematics::Geometry;

/// The furthest target from `from` along `direction` (mm and deg, any length): where the ray leaves the usable disk, the
/// travel or the soft limits, whichever comes first. `None` when `direction` is zero.
pub(super) fn furthest(
    from: &Coordinates,
    direction: &Coordinates,
    soft: &SoftLimits,
    geometry: &Geometry,
) -> Option<Coordinates> {
    if direction.iter().all(|&part| part == 0.0) {
        return None;
    }
    let bounds = |axis: Axis| {
        let (i, travel) = (axis.index(), travel(axis, geometry));
        if soft.active[i] {
            (soft.lowest[i], soft.highest[i])
        } else {
            (-travel, travel)
        }
    };
    let (x, y) = (Axis::X.index(), Axis::Y.index());
    let radius_mm = geometry.usable_radius() * geometry.radius_mm;
    let mut way = to_circle([from[x], from[y]], [direction[x], direction[y]], radius_mm);
    for axis in Axis::ALL {
        let (at, part, (lowest, highest)) =
            (from[axis.index()], direction[axis.index()], bounds(axis));
        let end = if part < 0.0 { lowest } else { highest };
        if part != 0.0 {
            way = way.min((end - at) / part);
        }
    }
    let way = way.max(0.0);
    let mut end = *from;
    for axis in Axis::ALL {
        let (i, (lowest, highest)) = (axis.index(), bounds(axis));
        if direction[i] != 0.0 {
            // Rounding must not take it out again.
            end[i] =
                (from[i] + way * direction[i]).clamp(lowest.min(from[i]), highest.max(from[i]));
        }
    }
    Some(end)
}

/// The multiple of `d` at which the ray from `p` leaves the circle; infinite when it does not move, 0 when it never is inside.
fn to_circle(p: [f64; 2], d: [f64; 2], radius: f64) -> f64 {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let (a, b, c) = (dot(d, d), dot(p, d), dot(p, p) - radius * radius);
    if a == 0.0 {
        return f64::INFINITY;
    }
    let root = b * b - a * c;
    if root < 0.0 {
        return 0.0;
    }
    (libm::sqrt(root) - b) / a
}
