//! What lines about macros ask for.

use crate::gcs::text::{Name, Text};

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
