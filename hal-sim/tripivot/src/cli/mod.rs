//! The command line `tripivot`: what can be asked of it, and the answers that need no simulation.
//!
//! Exit codes: 0 done; 1 the stage faulted or never settled, or the pose is out of reach; 2 the command line, a file or a number
//! is wrong.
//!
//! | file | idea |
//! |---|---|
//! | `arguments`, `number`, `usage`, `error` | what is typed, and what is said of it where it is wrong |
//! | `stage`, `machine`, `simulate`, `serve` | the simulated stage: its options, its numbers, a run, in real time |
//! | `sensitivity` | what each of its imperfections decides |
//! | `commission` | from an unknown machine to one that moves; a new payload; what a loop is |
//! | `view`, `record`, `settings`, `board` | in front of a controller that runs already |
//! | `faults` | the campaign of faults |
//! | `calibrate` | what a built machine is off its drawing |
//! | `inverse`, `direct`, `check`, `map` | kinematics |
//! | `calibration_file`, `flat_calibration` | a built machine's errors from a file |
//! | `rows`, `units`, `json` | numbers in and out |
//! | `pages` | completions and man pages |
//! | `signal` | Ctrl-C |

mod arguments;
mod board;
mod calibrate;
mod calibration_file;
mod check;
mod commission;
mod direct;
mod error;
mod faults;
mod flat_calibration;
mod inverse;
mod json;
mod machine;
mod map;

mod number;
mod pages;

mod record;
mod rows;
mod sensitivity;
mod serve;
mod settings;
pub mod signal;
mod simulate;
pub mod stage;
mod units;

mod usage;

mod view;

pub use arguments::VERSION;
use arguments::{Arguments, Command};
use clap::Parser;
use error::CliError;
use std::process::ExitCode;
pub use usage::usage;

/// Exit code: something went wrong on the way of a valid request: a fault, a stage that does not settle, a pose out of reach.
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

fn obey(arguments: Arguments) -> Result<ExitCode, CliError> {
    match arguments.command {
        None => simulate::demonstration(&arguments.simulation, arguments.output.json),
        Some(Command::Run {
            file,
            settings,
            simulation,
            output,
        }) => simulate::script(&file, &simulation, settings.as_deref(), output.json),
        Some(Command::Serve(arguments)) => serve::run(&arguments),
        Some(Command::View(arguments)) => view::run(&arguments),
        Some(Command::Record(arguments)) => record::run(&arguments),
        Some(Command::Board(arguments)) => board::run(&arguments),
        Some(Command::Commission(arguments)) => commission::run(&arguments),
        Some(Command::Tune(arguments)) => commission::tune(&arguments),
        Some(Command::Frf(arguments)) => commission::frf(&arguments),
        Some(Command::Machine(arguments)) => machine::run(&arguments),
        Some(Command::Sensitivity(arguments)) => sensitivity::run(&arguments),
        Some(Command::Faults(arguments)) => faults::run(&arguments),
        Some(Command::Settings(command)) => settings::run(&command),
        Some(Command::Calibrate(command)) => calibrate::run(&command),
        Some(Command::Inverse(numbers)) => inverse::run(&numbers),
        Some(Command::Direct(numbers)) => direct::run(&numbers),
        Some(Command::Check(pose)) => check::run(&pose),
        Some(Command::Map(map)) => map::run(&map),
        Some(Command::Completions { shell }) => pages::completions(shell),
        Some(Command::Man { out }) => pages::man(&out),
    }
}
