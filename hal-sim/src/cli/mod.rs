//! The command line `tripivot`: what can be asked of it, and the answers that need no simulation.
//!
//! Exit codes: 0 done; 1 the stage faulted, or the pose is out of reach; 2 the command line, a file or a number is wrong.

mod arguments;
mod check;
#[cfg(feature = "chip")]
mod chip;
#[cfg(feature = "chip")]
mod chip_load;
#[cfg(all(feature = "chip", unix))]
mod chip_serve;
#[cfg(feature = "chip")]
mod chip_tick;
#[cfg(feature = "chip")]
mod cost;
mod direct;
mod error;
#[cfg(feature = "chip")]
mod exercise;
mod faults;
#[cfg(feature = "chip")]
mod image_check;
mod inverse;
mod map;
#[cfg(unix)]
mod record;
mod rows;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod settings;
mod simulate;
mod units;
#[cfg(unix)]
mod view;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use error::CliError;

/// Something went wrong on the way of a valid request: a fault, a pose out of reach.
const FAILED: u8 = 1;
/// The request cannot be served as it stands.
const BAD_REQUEST: u8 = 2;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage(&error),
    };
    match obey(arguments) {
        Ok(code) => code,
        Err(CliError::OutputClosed) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("tripivot: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// Help and version as clap prints them; an error in one line, its first paragraph.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nobody is left to be told when standard output is closed.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let text = error.render().to_string();
    let paragraph: Vec<&str> = (text.lines().map(str::trim))
        .take_while(|line| !line.is_empty())
        .collect();
    let line = paragraph.join(" ");
    let line = line.strip_prefix("error: ").unwrap_or(&line);
    eprintln!("tripivot: {line} (see --help)");
    ExitCode::from(BAD_REQUEST)
}

fn obey(arguments: Arguments) -> Result<ExitCode, CliError> {
    match arguments.command {
        None => simulate::demonstration(&arguments.simulation),
        Some(Command::Run {
            file,
            settings,
            simulation,
        }) => simulate::script(&file, &simulation, settings.as_deref()),
        #[cfg(unix)]
        Some(Command::Serve(arguments)) => serve::run(&arguments),
        #[cfg(unix)]
        Some(Command::View(arguments)) => view::run(&arguments),
        #[cfg(feature = "chip")]
        Some(Command::Chip(chip)) => chip::run(&chip),
        #[cfg(all(feature = "chip", unix))]
        Some(Command::ChipServe(arguments)) => chip_serve::run(&arguments),
        #[cfg(feature = "chip")]
        Some(Command::Cost(arguments)) => cost::run(&arguments),
        #[cfg(feature = "chip")]
        Some(Command::ChipLoad(arguments)) => chip_load::run(&arguments),
        #[cfg(feature = "chip")]
        Some(Command::ChipTick(arguments)) => chip_tick::run(&arguments),
        #[cfg(feature = "chip")]
        Some(Command::ImageCheck) => image_check::run(),
        #[cfg(unix)]
        Some(Command::Record(arguments)) => record::run(&arguments),
        Some(Command::Faults(arguments)) => faults::run(&arguments),
        #[cfg(unix)]
        Some(Command::Settings(command)) => settings::run(&command),
        Some(Command::Inverse(numbers)) => inverse::run(&numbers),
        Some(Command::Direct(numbers)) => direct::run(&numbers),
        Some(Command::Check(pose)) => check::run(&pose),
        Some(Command::Map(map)) => map::run(&map),
    }
}
