//! The command line `tripivot`: what can be asked of it, and the answers that need no simulation.
//!
//! Exit codes: 0 done; 1 the stage faulted, or the pose is out of reach; 2 the command line, a file or a number is wrong.

mod arguments;
mod check;
mod direct;
mod error;
mod faults;
mod inverse;
mod map;
#[cfg(unix)]
mod record;
mod rows;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod settings;
#[cfg(unix)]
pub mod signal;
mod simulate;
pub mod stage;
mod units;
#[cfg(unix)]
mod view;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use error::CliError;

pub use arguments::VERSION;

/// Exit code: something went wrong on the way of a valid request: a fault, a pose out of reach.
pub const FAILED: u8 = 1;
/// Exit code: the request cannot be served as it stands.
pub const BAD_REQUEST: u8 = 2;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage("tripivot", &error),
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

/// What a program of this name says of its command line: help and version as clap prints them; an error in one line, its first
/// paragraph.
pub fn usage(program: &str, error: &clap::Error) -> ExitCode {
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
    eprintln!("{program}: {line} (see --help)");
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
