//! What can stop a command, each in one line.

use std::io;
use std::path::PathBuf;

use crate::report::ReportError;
use crate::script::ScriptError;

use super::{BAD_REQUEST, FAILED};

/// Why a command ended early.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// The pose, pivots or option given on the command line.
    #[error("{0}")]
    Value(String),
    /// A row of standard input.
    #[error("row {row}: {reason}")]
    Row {
        /// Line number in the input, from 1.
        row: u64,
        /// What is wrong with it.
        reason: String,
    },
    #[error("cannot read standard input: {0}")]
    Input(io::Error),
    #[error("cannot write standard output: {0}")]
    Output(io::Error),
    /// Nobody reads on, as after `| head`: no error.
    #[error("standard output is closed")]
    OutputClosed,
    #[error("{}: not a .svg or .png file", .0.display())]
    Ending(PathBuf),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    SettingsFile(#[from] crate::devices::SettingsFileError),
    #[error(transparent)]
    Script(#[from] ScriptError),
    #[cfg(unix)]
    #[error(transparent)]
    Serve(#[from] crate::serve::ServeError),
    #[cfg(unix)]
    #[error(transparent)]
    Record(#[from] crate::record::RecordError),
    #[cfg(unix)]
    #[error(transparent)]
    Settings(#[from] crate::settings::SettingsError),
    #[cfg(unix)]
    #[error(transparent)]
    Page(#[from] crate::web::PageError),
    #[cfg(feature = "chip")]
    #[error(transparent)]
    Chip(#[from] crate::chip::ChipError),
    #[cfg(feature = "chip")]
    #[error(transparent)]
    Cost(#[from] crate::cost::CostError),
    #[cfg(feature = "chip")]
    #[error(transparent)]
    Figures(#[from] crate::cost::FiguresError),
    #[cfg(feature = "chip")]
    #[error(transparent)]
    Proof(#[from] crate::proof::ProofError),
    /// A part costs more than it did.
    #[cfg(feature = "chip")]
    #[error("{0}")]
    Grown(String),
    /// The stage faulted in a run, or refused a line.
    #[error("{0}")]
    Fault(String),
}

impl CliError {
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) => FAILED,
            #[cfg(unix)]
            Self::Settings(error) if error.is_failure() => FAILED,
            #[cfg(unix)]
            Self::Record(error) if error.is_failure() => FAILED,
            #[cfg(feature = "chip")]
            Self::Grown(_) | Self::Proof(_) => FAILED,
            _ => BAD_REQUEST,
        }
    }

    /// From writing to standard output.
    pub(super) fn output(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::OutputClosed,
            _ => Self::Output(error),
        }
    }
}
