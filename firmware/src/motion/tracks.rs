//! Three axes that arrive together, each on its own track, and their tracks as one list of pieces.

use super::axis::Axis;
use super::axis_profile::{AxisLimits, AxisProfile};
use super::brake::jerks;
use super::fit::{Track, fit, task};
use super::float::Order;
use super::plan::{MAX_PIECES, Piece};
use heapless::Vec;

/// Pieces of a plan.
pub(super) type Pieces = Vec<Piece, MAX_PIECES>;

/// An axis and its way to where it is to be at rest, 2^-72 track radii or turns.
pub type AxisWay = (Axis, i128);

/// Ticks in which each axis alone could arrive; `None` where there is no profile.
pub(super) fn shortest(ways: &[AxisWay; 3], limits: &[AxisLimits<f32>; 3]) -> Option<[f32; 3]> {
    let mut shortest = [0.0; 3];
    for ((least, (axis, way)), limits) in shortest.iter_mut().zip(ways).zip(limits) {
        // An axis that has nothing to do needs no limits.
        if *way != 0 || axis.velocity != 0 || axis.acceleration != 0 {
            let task = task(axis, axis.position + way);
            *least = AxisProfile::shortest(&task, limits).ok()?;
        }
    }
    Some(shortest)
}

/// The pieces that carry three independent axes to rest, each within its own limits (2^-72 units and ticks), as soon as the
/// slowest of them can: the others take as long, or arrive early where no slower motion leads there. `None` for limits that
/// are not positive numbers, and states that take more than 2^63 ticks.
pub fn synchronised(ways: &[AxisWay; 3], limits: &[AxisLimits<f32>; 3]) -> Option<Pieces> {
    let longest = shortest(ways, limits)?.into_iter().fold(0.0, Order::larger);
    let mut tracks: [Track; 3] = Default::default();
    for (i, track) in tracks.iter_mut().enumerate() {
        let (axis, way) = ways[i];
        fit(track, axis, way, &limits[i], longest)?;
    }
    let mut pieces = Pieces::new();
    merged(&tracks, &mut pieces);
    Some(pieces)
}

/// Writes the track of one axis that takes so many ticks to rest, wherever that is.
pub(super) fn brake(track: &mut Track, axis: &Axis, ticks: [u64; 3]) {
    track.clear();
    if axis.velocity != 0 || axis.acceleration != 0 {
        let [first, last] = jerks(axis, ticks);
        for segment in [(ticks[0], first), (ticks[1], 0), (ticks[2], last)] {
            if segment.0 > 0 {
                let _ = track.push(segment);
            }
        }
    }
}

/// One list of pieces from three tracks: a new one wherever a jerk changes. It has room for all segments of all axes.
pub(super) fn merged(tracks: &[Track; 3], pieces: &mut Pieces) {
    pieces.clear();
    let mut at = [0; 3];
    let mut done = [0; 3];
    loop {
        let now = [0, 1, 2].map(|i| tracks[i].get(at[i]).copied());
        let left = [0, 1, 2].map(|i| now[i].map(|(ticks, _)| ticks - done[i]));
        let Some(ticks) = left.into_iter().flatten().min() else {
            return;
        };
        let _ = pieces.push(Piece {
            ticks,
            jerk: now.map(|segment| segment.map_or(0, |(_, jerk)| jerk)),
        });
        for i in 0..3 {
            done[i] += ticks;
            if left[i] == Some(ticks) {
                at[i] += 1;
                done[i] = 0;
            }
        }
    }
}
