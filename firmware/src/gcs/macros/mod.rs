//! Macros: lines kept under a name, and carried out in the background as if a connection of its own sent them.
//!
//! A macro is recorded on one connection (`MAC BEG` to `MAC END`) while the others go on. Queries are answered while it is
//! recorded and are no part of it; every other line is, and is only checked: a line that could never be carried out spoils the
//! recording, and `MAC END` then keeps nothing. Variables are put in when the macro runs.
//!
//! One macro runs at a time; it may start others, up to [`MAX_CALL_DEPTH`] deep. It goes on when its client leaves. `STP` and `#24`
//! from anywhere end it, `MAC STOP` too (and leaves the motion alone); an error ends it and is told by `MAC ERR?`. It gets
//! [`LINES_PER_TICK`] lines a tick and one jump, so that a loop without a wait holds up nobody.
//!
//! | what is bounded | by |
//! |---|---|
//! | text of all macros | [`MACRO_BYTES`] |
//! | macros | [`MAX_MACROS`] |
//! | names, arguments and values | 16 and 32 characters |
//! | depth of macros in macros | [`MAX_CALL_DEPTH`] |
//! | variables | 32, and 10 local ones a macro |
//!
//! | file | idea |
//! |---|---|
//! | `parse` | from the words of a line to a request |
//! | `store` | the text, ready to be kept somewhere else |
//! | `record` | recording |
//! | `run` | which line comes next |
//! | `act` | what the lines about macros and variables do |

mod execute;
mod parse;
mod recording;
mod running;
mod state;

pub(super) use parse::{MacroSyntax, add, jump, macro_request, set, tell, variable};
pub(super) use recording::Recorded;
pub use running::MAX_CALL_DEPTH;
pub use state::{MACRO_BYTES, MAX_MACROS};

use super::error::ErrorCode;
use super::session::Session;
use super::text::{Name, Text};
use recording::Recording;
use running::Calls;
use state::MacroTexts;

/// Lines of a macro carried out in a tick.
pub const LINES_PER_TICK: u32 = 8;

/// What a line wants of the macros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MacroRequest {
    /// `MAC BEG`
    Begin(Name),
    /// `MAC END`
    End,
    /// `MAC START`, and `MAC NSTART` with a number: times, and arguments.
    Start(Name, u32, [Option<Text>; 2]),
    /// `MAC DEL`
    Delete(Name),
    /// `MAC STOP`
    Stop(Option<Name>),
    /// `MAC ERR?`: the error that ended a macro.
    Error,
    /// `MAC FREE?`: bytes left for macros.
    Free,
    /// `MAC?`: all names, or the lines of one.
    List(Option<Name>),
    /// `RMC?`: names of those that run.
    Running,
    /// `#8`: whether one runs.
    IsRunning,
}

/// All about macros that the connections share.
#[derive(Default)]
pub(super) struct Macros {
    store: MacroTexts,
    recording: Option<Recording>,
    /// Recordings begun so far: identifies one.
    recordings: u32,
    calls: Calls,
    /// The connection of the macro that runs.
    session: Session,
    /// Its line that is being carried out.
    line: Line,
    /// Lines left for this tick, and which it is.
    lines: u32,
    tick: u64,
    failure: Option<Failure>,
}

type Line = heapless::Vec<u8, { super::LINE_BYTES }>;

/// The error that ended a macro.
struct Failure {
    name: Name,
    line: u16,
    code: ErrorCode,
    text: Line,
}
