//! Why there is no plan or no calibration.

use std::path::PathBuf;

use calibration::FitError;
use calibration::file::FileError;
use calibration::table::TableError;
use desk::calibrate::VerifyError;

/// Why there is no plan or no calibration.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum CalibrateError {
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{}: {source}", path.display())]
    Table { path: PathBuf, source: TableError },
    /// A visit of the fit, by its line.
    #[error("{}: line {line}: {reason}", path.display())]
    Visit {
        path: PathBuf,
        line: usize,
        reason: &'static str,
    },
    #[error("{}: {source}", path.display())]
    Fit { path: PathBuf, source: FitError },
    #[error("the fit is no calibration: {0}")]
    File(#[from] FileError),
    #[error("{}: {source}", path.display())]
    Calibration { path: PathBuf, source: FileError },
    #[error(transparent)]
    Measure(#[from] desk::calibrate::MeasureError),
    #[error(transparent)]
    Apply(#[from] desk::calibrate::ApplyError),
    #[error(transparent)]
    Verify(#[from] VerifyError),
    #[error("{}: no verification as `tripivot calibrate verify --json` tells it: {source}", path.display())]
    Verified {
        path: PathBuf,
        source: serde_json::Error,
    },
    #[error(transparent)]
    Report(desk::calibrate::report::ReportError),
    /// The file is there, and was begun otherwise.
    #[error("{}: this is another measurement, begun as '{found}'; now it is '{wanted}'", path.display())]
    Begun {
        path: PathBuf,
        found: String,
        wanted: String,
    },
    #[error("--kit ends: ends of guides are touched, and no instrument is read")]
    NothingToRead,
    #[error(
        "--reader: what reads the instrument? Only a simulated machine has a simulated one beside it"
    )]
    NoReader,
    #[error("the numbers of the instrument leave nothing to compute with")]
    Lost,
}

impl CalibrateError {
    /// Whether the request was sound and what was measured is not.
    pub(in crate::cli) const fn is_failure(&self) -> bool {
        if let Self::Verify(VerifyError::Ends) = self {
            return false;
        }
        matches!(
            self,
            Self::Fit { .. }
                | Self::File(_)
                | Self::Lost
                | Self::Measure(_)
                | Self::Apply(_)
                | Self::Verify(_)
                | Self::Report(_)
        )
    }
}
