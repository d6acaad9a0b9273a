//! `tripivot calibrate`: what a built machine is off its drawing.

mod apply;
mod demo;
pub(super) mod error;
mod fit;
mod measure;
mod plan;
mod reader;
mod report;
mod verify;

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use calibration::Noise;
use calibration::file::Calibration;
use kinematics::Geometry;

use super::arguments::{CalibrateCommand, NoiseArguments};
use super::error::CliError;
use error::CalibrateError;

/// Length over which theta is measured, m, unless its noise is told: two beams of an interferometer.
const BASE_M: f64 = 0.05;
const NM_PER_MM: f64 = 1e6;
const URAD_PER_RAD: f64 = 1e6;

pub(super) fn run(command: &CalibrateCommand) -> Result<ExitCode, CliError> {
    match command {
        CalibrateCommand::Plan(arguments) => plan::run(arguments),
        CalibrateCommand::Measure(arguments) => measure::run(arguments),
        CalibrateCommand::Fit(arguments) => fit::run(arguments),
        CalibrateCommand::Apply(arguments) => apply::run(arguments),
        CalibrateCommand::Verify(arguments) => verify::run(arguments),
        CalibrateCommand::Report(arguments) => report::run(arguments),
        CalibrateCommand::Demo(arguments) => demo::run(arguments),
        CalibrateCommand::Undo(arguments) => apply::undo(arguments),
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

fn calibration(path: &Path) -> Result<Calibration, CalibrateError> {
    Calibration::from_text(&read(path)?).map_err(|source| {
        let path = path.to_owned();
        CalibrateError::Calibration { path, source }
    })
}

/// One line of what is told.
fn line(what: &str, text: &str) -> String {
    format!("{what:<24}{text}\n")
}
