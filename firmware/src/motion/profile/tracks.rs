//! Three axes that arrive together, each on its own track, and their tracks as one list of pieces.

use super::any_state::task::AxisProfile;
use super::whole_ticks::{Track, fit, task};
use crate::motion::brake::jerks;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::AxisLimits;
use crate::motion::plan::{Piece, Pieces};
use crate::number::float::FloatMinMax;

/// An axis and its way to where it is to be at rest, 2^-72 track radii or turns.
pub type AxisWay = (AxisState, i128);

/// Ticks in which each axis alone could arrive; `None` where there is no profile.
pub(crate) fn shortest(ways: &[AxisWay; 3], limits: &[AxisLimits<f32>; 3]) -> Option<[f32; 3]> {
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

/// The pieces that carry three independent axes to rest, each within its own limits (2^-72 units and ticks), as soon as
/// the slowest of them can: the others take as long, or arrive early where no slower motion leads there. `None` for
/// limits that are not positive numbers, and states that take more than 2^63 ticks.
pub fn synchronised(ways: &[AxisWay; 3], limits: &[AxisLimits<f32>; 3]) -> Option<Pieces> {
    let longest = shortest(ways, limits)?
        .into_iter()
        .fold(0.0, FloatMinMax::fmax);
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
pub(crate) fn brake(track: &mut Track, axis: &AxisState, ticks: [u64; 3]) {
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
pub(crate) fn merged(tracks: &[Track; 3], pieces: &mut Pieces) {
    pieces.clear();
    let [a, b, c] = tracks;
    let mut cursors = [a, b, c].map(Cursor::new);
    loop {
        let [a, b, c] = &cursors;
        let ticks = a.left.min(b.left).min(c.left);
        if ticks >= Cursor::NEVER {
            return;
        }
        let _ = pieces.push(Piece {
            ticks,
            jerk: [a.jerk, b.jerk, c.jerk],
        });
        for cursor in &mut cursors {
            cursor.left -= ticks;
            if cursor.left == 0 {
                cursor.step();
            }
        }
    }
}

/// Where a track is.
struct Cursor<'a> {
    /// Ticks of the segment that are left.
    left: u64,
    jerk: i64,
    rest: core::slice::Iter<'a, (u64, i64)>,
}

impl<'a> Cursor<'a> {
    /// What is left after the last segment is more than this, however much is taken of it: no track has as many ticks.
    const NEVER: u64 = u64::MAX / 2;

    fn new(track: &'a Track) -> Self {
        let mut cursor = Self {
            left: 0,
            jerk: 0,
            rest: track.iter(),
        };
        cursor.step();
        cursor
    }

    fn step(&mut self) {
        (self.left, self.jerk) = self.rest.next().copied().unwrap_or((u64::MAX, 0));
    }
}
