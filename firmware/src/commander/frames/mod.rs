//! Coordinate systems of the user's own: work and tool frames, chains of them, and the centre of rotation.
//!
//! The semantics are those of a hexapod controller's coordinate systems, in the plane (x, y and w; z, u and v are 0):
//!
//! | kind | what lies at the values | enabled, coordinates are those of |
//! |---|---|---|
//! | work | a work frame, in the base frame | the tool in the work frame |
//! | tool | a tool frame, in the platform | the tool in the work frame |
//! | directed | both: in the base frame and, at the zero pose, in the platform | the frame in its own place at zero |
//! | here | a work frame where the platform is now: x, y and w become 0 | the platform in that frame |
//!
//! One directed frame, one made here, or a pair of work and tool frame is enabled at a time; enabling one of the former
//! disables the pair and the other way round. [`FrameName::ZERO`] is the base frame, always there; enabling it disables
//! all others. A frame can be linked to a parent: its values then are those in the parent, and a change to the parent
//! moves it along. What is enabled, and what it is linked to, cannot be changed, linked or removed.
//!
//! The centre of rotation is a directed frame that is only moved, on top of the base frame, a directed frame or one
//! made here: it can be set wherever the stage stands, and at w = 0 changes no coordinate. With a tool frame the tool's origin is the centre, and the other does
//! not count.
//!
//! | file | idea |
//! |---|---|
//! | `name` | names |
//! | `frame` | what a frame is for, and where it lies |
//! | `tree` | the frames there are |
//! | `selection` | which of them are in force |
//! | `resolve` | from a selection to the transforms it means |
//! | `transform` | where one frame lies in another |
//! | `active_frames` | targets as poses of the platform, through the frames in force |
//! | `change` | what can be changed |
//! | `error` | what can not be done |

mod active_frames;
mod change;
mod error;
mod frame;
mod name;
mod resolve;
mod selection;
mod transform;
mod tree;

pub use active_frames::ActiveFrames;
pub use change::FrameChange;
pub use error::FrameError;
pub use frame::{Frame, FrameKind};
pub use name::{FRAME_NAME_BYTES, FrameName};
pub use selection::{EnabledFrames, FrameSelection};
pub use transform::Transform;
pub use tree::{FRAMES, FrameTree};
