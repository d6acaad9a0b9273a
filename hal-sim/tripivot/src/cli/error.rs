//! What can stop a command, each in one line.

use super::{BAD_REQUEST, FAILED};
use drawing::ReportError;
use hal_sim::report::SETTLING_S;
use hal_sim::rig::script::ScriptError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a command ended early.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// The pose, pivots or option given on the command line.
    #[error("{0}")]
    Value(String),
    /// A pose that has no pivots.
    #[error("{0}")]
    OutOfReach(String),
    /// A row of standard input.
    #[error("row {row}: {error}")]
    Row {
        /// Line number in the input, from 1.
        row: u64,
        /// What is wrong with it.
        error: Box<CliError>,
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
    Choice(#[from] desk::commission::ChoiceError),
    #[error(transparent)]
    Results(#[from] desk::commission::ResultsError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    SettingsFile(#[from] hal_sim::machine::devices::SettingsFileError),
    #[error(transparent)]
    Commissioned(#[from] hal_sim::campaign::CommissionedError),
    #[error(transparent)]
    Stage(#[from] super::stage::StageError),
    #[error(transparent)]
    Script(#[from] ScriptError),
    #[error(transparent)]
    Serve(#[from] desk::serve::ServeError),
    #[error(transparent)]
    Record(#[from] desk::record::RecordError),
    #[error(transparent)]
    Calibrate(#[from] super::calibrate::error::CalibrateError),
    #[error(transparent)]
    Settings(#[from] desk::settings::SettingsError),
    #[error(transparent)]
    Calibration(#[from] super::calibration_file::CalibrationError),
    #[error(transparent)]
    Page(#[from] desk::web::PageError),
    /// The stage faulted in a run, or refused a line.
    #[error("{0}")]
    Fault(String),
    #[error(
        "{never} of {moves} moves never settled, though each had {SETTLING_S} s or more before the next move or the end of the run"
    )]
    NeverSettled {
        /// So many.
        never: usize,
        /// All moves.
        moves: usize,
    },
}

impl CliError {
    /// A file that was asked for can not be written.
    pub(super) fn unwritable(path: Option<&Path>, error: &io::Error) -> Self {
        let path = path.unwrap_or(Path::new("")).display();
        Self::Value(format!("{path}: cannot be written: {error}"))
    }

    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) | Self::OutOfReach(_) | Self::NeverSettled { .. } => FAILED,

            Self::Row { error, .. } => error.exit_code(),

            Self::Calibrate(error) if error.is_failure() => FAILED,
            Self::Settings(error) if error.is_failure() => FAILED,
            Self::Record(error) if error.is_failure() => FAILED,
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
