//! How far a target can go in a direction.

use super::axis::Axis;
use super::axis::Coordinates;
use super::frames::ActiveFrames;

/// Halvings of the way on which the end is looked for: as many as a number has bits.
const HALVINGS: u32 = 53;

/// The furthest target from `from` along `direction` (mm and deg, any length) up to which everything is `allowed`: no
/// further than `most_mm` from the track's centre and inside `range`. `None` when `direction` is zero.
pub(crate) fn furthest_target(
    from: &Coordinates,
    direction: &Coordinates,
    active_frames: &ActiveFrames,
    most_mm: f64,
    range: impl Fn(Axis) -> [f64; 2],
    allowed: impl Fn(&Coordinates) -> bool,
) -> Option<Coordinates> {
    if direction.iter().all(|&part| part == 0.0) {
        return None;
    }
    let target = |way: f64| -> Coordinates {
        core::array::from_fn(|i| {
            if direction[i] == 0.0 {
                from[i]
            } else {
                from[i] + way * direction[i]
            }
        })
    };
    let mut way = upper_bound(from, direction, active_frames, most_mm, range).max(0.0);
    if !allowed(&target(way)) {
        let (mut good, mut bad) = (0.0, way);
        for _ in 0..HALVINGS {
            let middle = (good + bad) / 2.0;
            if allowed(&target(middle)) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        way = good;
    }
    Some(target(way))
}

/// A multiple of `direction` beyond which nothing is allowed: where the commanded point leaves its circle or its range.
fn upper_bound(
    from: &Coordinates,
    direction: &Coordinates,
    active_frames: &ActiveFrames,
    most_mm: f64,
    range: impl Fn(Axis) -> [f64; 2],
) -> f64 {
    let (x, y) = (Axis::X.index(), Axis::Y.index());
    let at = active_frames.travel_coordinates(from);
    let mut along = *direction;
    [along[x], along[y]] = active_frames.work.turned([direction[x], direction[y]]);
    let point = [at[x] + active_frames.zero[0], at[y] + active_frames.zero[1]];
    let mut way = to_circle(point, [along[x], along[y]], most_mm);
    for axis in Axis::ALL {
        let (at, part, [lowest, highest]) = (at[axis.index()], along[axis.index()], range(axis));
        let end = if part < 0.0 { lowest } else { highest };
        if part != 0.0 {
            way = way.min((end - at) / part);
        }
    }
    way
}

/// The multiple of `d` at which the ray from `p` leaves the circle; infinite when it does not move, 0 when it never is
/// inside.
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
