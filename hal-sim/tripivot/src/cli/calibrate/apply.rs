//! `tripivot calibrate apply` and `undo`: a calibration for a controller, and its end.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::file::Calibration;
use desk::calibrate::{ApplyError, apply, switch_off};

use super::super::arguments::{CalibrateApply, CalibratedMachine};
use super::super::error::CliError;
use super::error::CalibrateError;
use super::measure::machine;
use super::read;

pub(super) fn run(arguments: &CalibrateApply) -> Result<ExitCode, CliError> {
    let path = &arguments.file;
    // Before anything is asked of the machine.
    let calibration = Calibration::from_text(&read(path)?).map_err(|source| {
        let path = path.clone();
        CalibrateError::Calibration { path, source }
    })?;
    let mut machine = machine(&arguments.stage)?;
    let told = apply(machine.as_mut(), &calibration).map_err(CalibrateError::Apply)?;
    tell(&told)
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
