//! Macros: lines stored under a name, and carried out in the background as if a connection of its own sent them.
//!
//! A macro is recorded on one connection (`MAC BEG` to `MAC END`) while the others go on. Queries are answered while it
//! is recorded and are no part of it; every other line is, and is only checked: a line that could never be carried out
//! makes the recording invalid, and `MAC END` then stores nothing. Variables are put in when the macro runs.
//!
//! One macro runs at a time; it may start others, up to [`MAX_CALL_DEPTH`] deep. It goes on when its client leaves.
//! `STP` and `#24` from anywhere end it, `MAC STOP` too (and leaves the motion alone); an error ends it and is told by
//! `MAC ERR?`. It gets [`LINES_PER_TICK`] lines a tick and one jump, so that a loop without a wait holds up nobody.
//!
//! | what is bounded | by |
//! |---|---|
//! | text of all macros | [`MACRO_BYTES`] |
//! | macros | [`MAX_MACROS`] |
//! | names, arguments and values | 16 and 32 characters |
//! | depth of macros in macros | [`MAX_CALL_DEPTH`] |
//! | variables | 32 a connection, 32 of all macros, and 10 local ones a macro |
//!
//! | file | idea |
//! |---|---|
//! | `state` | what is known of macros: texts, the recording, the calls, the error that ended one |
//! | `texts` | the text of all, ready to be stored somewhere else |
//! | `calls` | which line of the running ones comes next |
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `recording` | recording |
//! | `execute` | what lines do |
//! | `run` | carrying on the macro that runs |
//! | `replies` | what queries answer |

mod calls;
mod execute;
pub(super) mod parse;
mod recording;
mod replies;
mod request;
mod run;
mod state;
mod texts;

pub use calls::MAX_CALL_DEPTH;
pub(super) use recording::Recorded;
pub use request::MacroRequest;
pub use state::LINES_PER_TICK;
pub(super) use state::Macros;
pub use texts::{MACRO_BYTES, MAX_MACROS};
