//! `tripivot calibrate`: what a built machine is off its drawing.

mod fit;
mod plan;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use calibration::file::FileError;
use calibration::table::TableError;
use calibration::{FitError, Noise};
use kinematics::Geometry;

use super::arguments::{CalibrateCommand, NoiseArguments};
use super::error::CliError;

/// Length over which theta is measured, m, unless its noise is told: two beams of an interferometer.
const BASE_M: f64 = 0.05;
const NM_PER_MM: f64 = 1e6;
const URAD_PER_RAD: f64 = 1e6;

/// Why there is no plan or no calibration.
#[derive(Debug, thiserror::Error)]
pub(super) enum CalibrateError {
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
    pub(super) const fn is_failure(&self) -> bool {
        matches!(self, Self::Fit { .. } | Self::File(_) | Self::Lost)
    }
}

pub(super) fn run(command: &CalibrateCommand) -> Result<ExitCode, CliError> {
    match command {
        CalibrateCommand::Plan(arguments) => plan::run(arguments),
        CalibrateCommand::Fit(arguments) => fit::run(arguments),
    }
}

/// In track radii and rad.
fn noise(arguments: &NoiseArguments) -> Noise {
    let radius_m = Geometry::REFERENCE.radius_mm * 1e-3;
    Noise {
        length: arguments.noise / radius_m,
        angle_rad: arguments.noise_theta.unwrap_or(arguments.noise / BASE_M),
        encoder_rad: Noise::ENCODER_RAD,
    }
}

/// A length in track radii in nm.
fn nm(length: f64) -> f64 {
    length * Geometry::REFERENCE.radius_mm * NM_PER_MM
}

fn read(path: &Path) -> Result<String, CalibrateError> {
    fs::read_to_string(path).map_err(|source| CalibrateError::Unreadable {
        path: path.to_owned(),
        source,
    })
}

/// One line of what is told.
fn line(what: &str, text: &str) -> String {
    format!("{what:<24}{text}\n")
}
