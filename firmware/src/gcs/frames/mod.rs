//! Frames and the centre of rotation in the language.
//!
//! | command | meaning |
//! |---|---|
//! | `KSW`, `KST`, `KSD` | a work, tool or directed frame lies at these values |
//! | `KSF` | a frame lies where the platform is now: x, y and w become 0 |
//! | `KEN`, `KEN?`, `KET?` | puts a frame in force; which are |
//! | `KLN`, `KLN?`, `KLT?` | a frame lies in another one; its parents; where the chain lies |
//! | `KRM`, `KLS?` | forgets a frame; what there is of frames |
//! | `SPI`, `SPI?` | the centre of rotation |
//!
//! Frames themselves are those of [`crate::commander::frames`].
//!
//! | file | idea |
//! |---|---|
//! | `keyword` | the words for the kinds of frames |
//! | `parse` | what lines mean |
//! | `request` | what queries ask for |
//! | `replies` | what queries answer |

mod keyword;
pub(super) mod parse;
mod replies;
mod request;

pub(super) use replies::reply_frames;
pub use request::{FrameQuery, ListItem};
