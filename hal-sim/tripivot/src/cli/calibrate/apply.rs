//! `tripivot calibrate apply` and `undo`: a calibration for a controller, and its end.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::file::Made;
use calibration::table::Table;
use desk::calibrate::{ApplyError, Evidence, apply, switch_off};
use kinematics::Geometry;

use super::super::arguments::{CalibrateApply, CalibratedMachine};
use super::super::error::CliError;
use super::error::CalibrateError;
use super::measure::machine;
use super::{calibration, read};

pub(super) fn run(arguments: &CalibrateApply) -> Result<ExitCode, CliError> {
    // Before anything is asked of the machine.
    let calibration = calibration(&arguments.file)?;
    let evidence = evidence(arguments, &calibration.made)?;
    let mut machine = machine(&arguments.stage)?;
    let told = apply(machine.as_mut(), &calibration, &evidence).map_err(CalibrateError::Apply)?;
    tell(&told)
}

fn evidence(arguments: &CalibrateApply, made: &Made) -> Result<Evidence, CliError> {
    let path = &arguments.measured;
    let table =
        Table::from_text(&read(path)?, Geometry::REFERENCE.radius_mm).map_err(|source| {
            let path = path.clone();
            CalibrateError::Table { path, source }
        })?;
    let over = arguments.over.as_deref().map(calibration);
    Ok(Evidence {
        instrument: table.instrument(made.noise()),
        visits: table.visits,
        references: table.references,
        over: over.transpose()?,
    })
}

pub(super) fn undo(stage: &CalibratedMachine) -> Result<ExitCode, CliError> {
    let mut machine = machine(stage)?;
    let told = switch_off(machine.as_mut())
        .map_err(|error| CalibrateError::Apply(ApplyError::Controller(error)))?;
    tell(&told)
}

fn tell(told: &str) -> Result<ExitCode, CliError> {
    (io::stdout().write_all(format!("{told}\n").as_bytes())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}
