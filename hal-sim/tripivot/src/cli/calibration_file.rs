//! A built machine's errors from a file: what is off the drawing, pivot by pivot.
//!
//! Ours is a JSON object with `pivots`, three objects of the keys of [`BuiltPivot`]. The flat one of the published
//! poses is read as it is (`flat_calibration`). All of a file has to be right: a key too many or too few is named.

use std::io;
use std::path::{Path, PathBuf};

use drawing::read_text;
use kinematics::{CoefficientError, Corrections, Geometry, PivotCoefficients, Series};
use serde::Deserialize;
use serde_json::Value;

use super::flat_calibration;

/// Longest file: several times what 144 numbers take.
const LONGEST_BYTES: u64 = 1 << 16;
/// The keys by which the two kinds of file are told apart.
const OUR_KEY: &str = "pivots";
const FLAT_KEY: &str = "z0";

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

/// The errors of three pivots.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BuiltMachine {
    pivots: [BuiltPivot; 3],
}

/// [`PivotCoefficients`] with lengths in mm.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BuiltPivot {
    encoder_zero_rad: f64,
    radius_error_mm: f64,
    ring_centre_mm: [f64; 2],
    guide_error_rad: f64,
    guide_offset_mm: f64,
    encoder_rad: [[f64; 2]; 12],
    runout_mm: [[f64; 2]; 5],
    straightness_mm: [f64; 8],
}

impl BuiltPivot {
    fn coefficients(self) -> PivotCoefficients {
        let radii = |mm: f64| mm / Geometry::REFERENCE.radius_mm;
        PivotCoefficients {
            encoder_zero_rad: self.encoder_zero_rad,
            radius_error: radii(self.radius_error_mm),
            ring_centre: self.ring_centre_mm.map(radii),
            guide_error_rad: self.guide_error_rad,
            guide_offset: radii(self.guide_offset_mm),
            encoder_rad: self.encoder_rad,
            runout: self.runout_mm.map(|pair| pair.map(radii)),
            straightness: self.straightness_mm.map(radii),
        }
    }
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
    let told = |error: serde_json::Error| error.to_string();
    let document: Value = serde_json::from_str(text).map_err(told)?;
    if document.get(OUR_KEY).is_some() {
        let machine: BuiltMachine = serde_json::from_str(text).map_err(told)?;
        Ok(machine.pivots.map(BuiltPivot::coefficients))
    } else if document.get(FLAT_KEY).is_some() {
        flat_calibration::pivots(text)
    } else {
        Err(format!(
            "no calibration: neither '{OUR_KEY}' nor '{FLAT_KEY}' is in it"
        ))
    }
}
