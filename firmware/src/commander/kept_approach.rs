//! Kept of arriving from one side: the way, and the target meanwhile.

use crate::motion::Position;

/// How targets are arrived at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Approach {
    /// Way of each carriage on the last way to a target, um; 0 goes to the target at once.
    pub way_um: f64,
    /// The target, while the stage is on its way to where the last way begins.
    pub target: Option<Position>,
}
