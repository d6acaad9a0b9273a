//! `tripivot calibrate report`: all that is known of a calibration, as one page.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::table::Table;
use desk::calibrate::Told;
use desk::calibrate::report::{Report, page};
use drawing::write_file;
use kinematics::Geometry;

use super::super::arguments::CalibrateReport;
use super::super::error::CliError;
use super::error::CalibrateError;
use super::{calibration, line, read};

pub(super) fn run(arguments: &CalibrateReport) -> Result<ExitCode, CliError> {
    let calibration = calibration(&arguments.file)?;
    let path = &arguments.measured;
    let measured = Table::from_text(&read(path)?, Geometry::REFERENCE.radius_mm);
    let measured = measured.map_err(|source| {
        let path = path.clone();
        CalibrateError::Table { path, source }
    })?;
    let verified: Option<Told> = match &arguments.verified {
        Some(path) => {
            let told = serde_json::from_str(&read(path)?);
            Some(told.map_err(|source| CalibrateError::Verified {
                path: path.clone(),
                source,
            })?)
        }
        None => None,
    };
    let report = Report {
        calibration: &calibration,
        measured: &measured,
        verified: verified.as_ref(),
        truth: None,
    };
    let text = page(&report).map_err(CalibrateError::Report)?;
    write_file(&arguments.out, text.as_bytes())?;
    let told = line("report in", &arguments.out.display().to_string());
    (io::stdout().write_all(told.as_bytes())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}
