//! What queries about frames ask for.

use crate::commander::axis::Axis;
use crate::commander::frames::{FrameKind, FrameName};

/// A question about frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameQuery {
    /// `KEN?`: types of the enabled frames.
    Enabled(Option<FrameName>),
    /// `KET?`: enabled frames of the types.
    Types(Option<FrameKind>),
    /// `KLN?`
    Chains(Option<FrameName>),
    /// `KLS?`
    List(Option<FrameName>, Option<ListItem>),
    /// `KLT?`: start and end of the chain.
    Totals(Option<FrameName>, Option<FrameName>),
    /// `SPI?`: which of R, S and T; none stands for all.
    RotationCentre([bool; 3]),
}

/// A property that `KLS?` tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ListItem {
    /// The type.
    Type,
    /// The frame it is in.
    Parent,
    /// Whether it is enabled.
    Enabled,
    /// Where it lies: along one axis, or all.
    Position(Option<Axis>),
}
