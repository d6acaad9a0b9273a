//! A frame: what it is for, and where it lies.

use super::name::FrameName;
use super::transform::Transform;

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// Both a work frame and a tool frame at the same place.
    Directed,
    /// A work frame where the platform was when it was made.
    Here,
    /// In the platform.
    Tool,
    /// In the base frame.
    Work,
}

impl FrameKind {
    /// Tools lie in the platform, all others in the base frame: no chain goes through both. A directed frame lies in
    /// both.
    pub(super) const fn can_be_child_of(self, parent: Self) -> bool {
        matches!(parent, Self::Directed)
            || matches!(self, Self::Tool) == matches!(parent, Self::Tool)
    }
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its name.
    pub name: FrameName,
    /// What it is for.
    pub kind: FrameKind,
    /// In its parent.
    pub in_parent: Transform,
    /// `None`: the base frame.
    pub parent: Option<FrameName>,
}
