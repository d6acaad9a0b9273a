//! A motion to rest by its corners, in floats.

use crate::motion::plan::MAX_PIECES;
use heapless::Vec;

/// Where a motion's jerk changes: the state there, track radii, rad and seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    pub at_s: f32,
    pub v: [f32; 3],
    pub a: [f32; 3],
    pub j: [f32; 3],
}

/// A motion to rest by its corners; the last one is rest.
pub(super) type Corners = Vec<Corner, { MAX_PIECES + 1 }>;

impl Corner {
    /// The state at a later time.
    pub fn next(&self, at_s: f32) -> Self {
        let seconds = at_s - self.at_s;
        let half = seconds / 2.0;
        Self {
            at_s,
            v: [0, 1, 2].map(|i| self.v[i] + seconds * (self.a[i] + half * self.j[i])),
            a: [0, 1, 2].map(|i| self.a[i] + seconds * self.j[i]),
            j: [0.0; 3],
        }
    }
}
