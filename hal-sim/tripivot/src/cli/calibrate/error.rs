//! Why there is no plan or no calibration.

use std::path::PathBuf;

use calibration::FitError;
use calibration::file::FileError;
use calibration::table::TableError;

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
    #[error("the numbers of the instrument leave nothing to compute with")]
    Lost,
}

impl CalibrateError {
    /// Whether the request was sound and what was measured is not.
    pub(in crate::cli) const fn is_failure(&self) -> bool {
        matches!(self, Self::Fit { .. } | Self::File(_) | Self::Lost)
    }
}
