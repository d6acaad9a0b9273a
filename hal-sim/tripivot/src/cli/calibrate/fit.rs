//! `tripivot calibrate fit`: a calibration file from what was measured.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use calibration::file::Calibration;
use calibration::table::Table;
use calibration::{FitError, Instrument};
use desk::calibrate::{FitTold, Fitted, FittedError};
use drawing::write_file;
use kinematics::Geometry;

use super::super::arguments::CalibrateFit;
use super::super::error::CliError;
use super::super::json;
use super::error::CalibrateError;
use super::{lines, noise, read};

pub(super) fn run(arguments: &CalibrateFit) -> Result<ExitCode, CliError> {
    let path = &arguments.file;
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let table = Table::from_text(&read(path)?, radius_mm).map_err(|source| {
        let path = path.clone();
        CalibrateError::Table { path, source }
    })?;
    let instrument = table.instrument(noise(&arguments.noise));
    let fitted = fitted(
        &table,
        &instrument,
        &arguments.serial,
        arguments.temperature,
        path,
    )?;
    let text = fitted.calibration.to_text();
    // What would be refused when it is read is not written.
    Calibration::from_text(&text).map_err(CalibrateError::File)?;
    write_file(&arguments.out, text.as_bytes())?;
    let told = FitTold::new(&fitted, &table, &arguments.out.display().to_string());
    if arguments.json {
        json::print(&told)?;
    } else {
        (io::stdout().write_all(lines(&told.lines()).as_bytes())).map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The fit, and its calibration.
pub(super) fn fitted(
    table: &Table,
    instrument: &Instrument,
    serial: &str,
    temperature_c: Option<f64>,
    path: &Path,
) -> Result<Fitted, CalibrateError> {
    Fitted::new(table, instrument, serial, temperature_c).map_err(|error| match error {
        FittedError::Fit(error) => at_line(path, table, error),
        FittedError::Lost => CalibrateError::Lost,
    })
}

/// Says where in the file what a fit refuses stands.
fn at_line(path: &Path, table: &Table, error: FitError) -> CalibrateError {
    let path = path.to_owned();
    match error {
        FitError::Visit { visit, reason } => CalibrateError::Visit {
            path,
            line: table.lines.get(visit).copied().unwrap_or(0),
            reason,
        },
        source => CalibrateError::Fit { path, source },
    }
}
