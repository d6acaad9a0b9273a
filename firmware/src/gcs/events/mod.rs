//! What has happened to the controller: a ring of typed events, each with its tick. `EVT?` tells them, the oldest
//! first; when it is full the oldest goes. They are numbered from 1 on, so that one sees how many have gone.
//!
//! Each is written into the retained memory too, if there is one, and those from before a reset are found there: they keep
//! their numbers, and the events after the start go on from there.
//!
//! | file | idea |
//! |---|---|
//! | `board_notice` | what a board finds out about itself |
//! | `crash` | how a program ended before this start |
//! | `event` | something that happened |
//! | `log` | the latest events |
//! | `encoding` | events as words, for the retained memory |
//! | `replies` | `EVT?` |

mod board_notice;
mod crash;
mod encoding;
mod event;
mod log;
mod replies;

pub use board_notice::BoardNotice;
pub use crash::{CRASH_FILE_BYTES, Crash, CrashCause};
pub(super) use event::Event;
pub use event::START_CAUSES;
pub(super) use log::EventLog;
