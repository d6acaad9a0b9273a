//! Coordinate systems of the user's in_parent: work and tool frames, chains of them, and the centre of rotation.
//!
//! The semantics are those of a hexapod controller's coordinate systems, in the plane (x, y and w; z, u and v are 0):
//!
//! | command | what lies at the values | enabled, coordinates are those of |
//! |---|---|---|
//! | `KSW` | a work frame, in the base frame | the tool in the work frame |
//! | `KST` | a tool frame, in the platform | the tool in the work frame |
//! | `KSD` | both: a directed frame, in the base frame and, at the zero pose, in the platform | the frame in its in_parent place at zero |
//! | `KSF` | a work frame where the platform is now: x, y and w become 0 | the platform in that frame |
//!
//! One `KSD`, one `KSF` or a pair of `KSW` and `KST` is enabled at a time; enabling one of the former disables the pair and
//! the other way round. `ZERO` is the base frame, always there; enabling it disables all others. A frame can be linked to a
//! parent (`KLN`): its values then are those in the parent, and a change to the parent moves it along. What is enabled, and
//! what it is linked to, cannot be changed, linked or removed.
//!
//! The centre of rotation (`SPI`) is a directed frame that is only moved, on top of `ZERO`, a `KSD` or a `KSF`: at w = 0 it
//! changes no coordinate. With a tool frame the tool's origin is the centre, and `SPI` does not count.
//!
//! | file | idea |
//! |---|---|
//! | `store` | the frames there are |
//! | `choice` | which of them are in force |
//! | `transform` | where one frame lies in another |
//! | `view` | targets as poses of the platform, through the frames in force |
//! | `name` | names |
//! | `parse` | what lines mean |
//! | `tell` | what queries answer |

mod in_force;
mod name;
mod store;
mod transform;
mod view;

pub use crate::gcs::frames::parse::{FrameChange, FrameQuery, ListItem};
pub(crate) use crate::gcs::frames::parse::{
    chains, define, enable, enabled, here, link, list, remove, rotation_centre,
    rotation_centre_query, totals, types,
};
pub use in_force::{EnabledFrames, FrameSelection};
pub use name::{FRAME_NAME_BYTES, FrameName};
pub use store::FrameTree;
pub use transform::Transform;
pub use view::ActiveFrames;

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// `KSD`
    Directed,
    /// `KSF`
    Here,
    /// `KST`
    Tool,
    /// `KSW`
    Work,
}

impl FrameKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Directed, Self::Here, Self::Tool, Self::Work];

    /// The command that makes one, which is also the type's name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Directed => "KSD",
            Self::Here => "KSF",
            Self::Tool => "KST",
            Self::Work => "KSW",
        }
    }

    /// Tools lie in the platform, all others in the base frame: no chain goes through both. A directed frame lies in both.
    const fn can_be_child_of(self, parent: Self) -> bool {
        matches!(parent, Self::Directed)
            || matches!(self, Self::Tool) == matches!(parent, Self::Tool)
    }
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) name: FrameName,
    pub(crate) kind: FrameKind,
    /// In its parent.
    pub(crate) in_parent: Transform,
    /// `None`: `ZERO`.
    pub(crate) parent: Option<FrameName>,
}
