//! A built machine's errors from a file: what is off the drawing, pivot by pivot.
//!
//! It is what `calibrate fit` writes, or the JSON object of the published poses as it is (`flat_calibration`). All of a file has to be
//! right: a key too many or too few is named.

use std::io;
use std::path::{Path, PathBuf};

use calibration::file::Calibration as FittedMachine;
use drawing::read_text;
use kinematics::{CoefficientError, Corrections, PivotCoefficients, Series};

use super::flat_calibration;

/// Longest file: several times what 144 numbers take.
const LONGEST_BYTES: u64 = 1 << 16;

/// What a machine's encoders read, exactly.
pub(super) type Calibration = Corrections<f64, Series<f64>>;

/// Why a calibration file is not taken.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// It cannot be read.
    #[error("{}: {error}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// It does not say what it should.
    #[error("{}: {reason}", path.display())]
    Content {
        /// Which.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A number is too large.
    #[error("{}: {error} (track radii or rad)", path.display())]
    Coefficient {
        /// Which file.
        path: PathBuf,
        /// Which number.
        error: CoefficientError,
    },
}

/// The calibration in a file.
pub(super) fn read(path: &Path) -> Result<Calibration, CalibrationError> {
    let path = path.to_owned();
    let text = match read_text(&path, LONGEST_BYTES) {
        Ok(text) => text,
        Err(error) => return Err(CalibrationError::File { path, error }),
    };
    let pivots = match pivots(&text) {
        Ok(pivots) => pivots,
        Err(reason) => return Err(CalibrationError::Content { path, reason }),
    };
    Corrections::new(&pivots, Series::new)
        .map_err(|error| CalibrationError::Coefficient { path, error })
}

/// The numbers of either kind of file, or what is wrong with it.
fn pivots(text: &str) -> Result<[PivotCoefficients; 3], String> {
    if text.trim_start().starts_with('{') {
        return flat_calibration::pivots(text);
    }
    let fitted = FittedMachine::from_text(text).map_err(|error| error.to_string())?;
    Ok(fitted.machine())
}
