//! `tripivot calibrate`: what a built machine is off its drawing.

mod apply;
mod demo;
pub(super) mod error;
mod fit;
mod measure;
mod plan;
pub(super) mod reader;
mod report;
mod verify;

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use calibration::Noise;
use calibration::file::Calibration;
use desk::calibrate::Line;

use super::arguments::{CalibrateCommand, NoiseArguments};
use super::error::CliError;
use error::CalibrateError;

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
    desk::calibrate::noise(arguments.noise, arguments.noise_theta)
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

/// Lines of what is told.
fn lines(lines: &[Line]) -> String {
    let lines = lines.iter().map(|told| line(&told.what, &told.text));
    lines.collect()
}
