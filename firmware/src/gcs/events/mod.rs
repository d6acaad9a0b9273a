//! What has happened to the controller: a ring of typed events, each with its tick. `EVT?` tells them, the oldest
//! first; when it is full the oldest goes. They are numbered from 1 on, so that one sees how many have gone.
//!
//! Each is written into the retained memory too, if there is one, and those from before a reset are found there: they keep
//! their numbers, and the events after the start go on from there.
//!
//! | file | idea |
//! |---|---|
//! | `event` | something that happened |
//! | `log` | the latest events |
//! | `encoding` | events as words, for the retained memory |
//! | `replies` | `EVT?` |

mod encoding;
mod event;
mod log;
mod replies;

pub(super) use event::Event;
pub use event::START_CAUSES;
pub(super) use log::EventLog;
