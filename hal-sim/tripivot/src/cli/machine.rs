//! `tripivot machine`: the numbers of the simulated machine.

use std::io::{Write, stdout};
use std::process::ExitCode;

use hal_sim::machine::file::to_text;

use super::error::CliError;
use super::stage::Machine;

/// Prints them.
pub(super) fn run(machine: &Machine) -> Result<ExitCode, CliError> {
    let text = to_text(&machine.parameters()?);
    stdout()
        .write_all(text.as_bytes())
        .map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}
