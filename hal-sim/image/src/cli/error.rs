//! What can stop a command, each in one line.

use std::io;

use drawing::ReportError;
use hal_sim::rig::script::ScriptError;
use tripivot::cli::{BAD_REQUEST, FAILED};

/// Why a command ended early.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// An option given on the command line, or a file.
    #[error("{0}")]
    Value(String),
    #[error("cannot write standard output: {0}")]
    Output(io::Error),
    /// Nobody reads on, as after `| head`: no error.
    #[error("standard output is closed")]
    OutputClosed,
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Stage(#[from] tripivot::cli::stage::StageError),
    #[error(transparent)]
    Script(#[from] ScriptError),
    #[error(transparent)]
    Serve(#[from] desk::serve::ServeError),
    #[error(transparent)]
    Record(#[from] desk::record::RecordError),
    #[error(transparent)]
    Settings(#[from] desk::settings::SettingsError),
    #[error(transparent)]
    Chip(#[from] crate::chip::ChipError),
    #[error(transparent)]
    Cost(#[from] crate::cost::CostError),
    #[error(transparent)]
    Figures(#[from] crate::cost::FiguresError),
    #[error(transparent)]
    Limits(#[from] crate::cycles::LimitsError),
    #[error(transparent)]
    Proof(#[from] crate::proof::ProofError),
    /// A part costs more than it did.
    #[error("{0}")]
    Grown(String),
    /// The stage faulted in a run, or refused a line, or chip and host differ.
    #[error("{0}")]
    Fault(String),
}

impl CliError {
    pub(super) const fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) | Self::Grown(_) | Self::Proof(_) => FAILED,
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
