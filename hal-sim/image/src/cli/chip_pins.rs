//! `chip-pins`: what goes over the chip's pins.

use std::process::ExitCode;

use super::arguments::ChipPins;
use super::error::CliError;
use crate::chip;

pub(super) fn run(arguments: &ChipPins) -> Result<ExitCode, CliError> {
    let text = chip::pins(arguments.ticks)?;
    std::fs::write(&arguments.file, text)
        .map_err(|error| CliError::Value(format!("{}: {error}", arguments.file.display())))?;
    Ok(ExitCode::SUCCESS)
}
