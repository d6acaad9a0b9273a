//! The command line `image`: what can be asked of the image.
//!
//! Exit codes: 0 done; 1 the stage faulted, chip and host differ, or a proof fails; 2 the command line, a file or a number is wrong.

mod arguments;
mod chip;
mod chip_commission;
mod chip_cycles;
mod chip_load;
mod chip_pins;
mod chip_serve;
mod chip_tick;
mod chip_upsets;
mod cost;
mod error;
mod exercise;
mod image_check;
mod period;
mod place;
mod seal;

use std::process::ExitCode;

use clap::Parser;
use tripivot::cli::usage;

use arguments::{Arguments, Command};
use error::CliError;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage("image", &error),
    };
    match obey(arguments) {
        Ok(code) => code,
        Err(CliError::OutputClosed) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("image: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn obey(arguments: Arguments) -> Result<ExitCode, CliError> {
    match arguments.command {
        Command::Chip(chip) => chip::run(&chip),
        Command::ChipPins(arguments) => chip_pins::run(&arguments),
        Command::ChipServe(arguments) => chip_serve::run(&arguments),
        Command::ChipCommission(arguments) => chip_commission::run(&arguments),
        Command::Cost(arguments) => cost::run(&arguments),
        Command::ChipLoad(arguments) => chip_load::run(&arguments),
        Command::ChipCycles(arguments) => chip_cycles::run(&arguments),
        Command::ChipTick(arguments) => chip_tick::run(&arguments),
        Command::ChipUpsets(arguments) => chip_upsets::run(&arguments),
        Command::ImageCheck => image_check::run(),
        Command::Seal => seal::run(),
    }
}
