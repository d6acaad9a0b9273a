//! The arguments, as clap reads them.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, value_parser};

use super::stage::{SimulatedStage, Simulation};

#[cfg(unix)]
mod controller;
mod kinematics;

#[cfg(unix)]
pub(super) use controller::{Controller, RecordRun, SettingsCommand, View};
pub(super) use kinematics::{Map, PivotRows, PoseArguments, PoseRows, Quantity};

/// Version and commit of this program.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("TRIPIVOT_COMMIT"));

/// Tripivot: a simulated planar XY-Theta stage under its real controller.
///
/// Without a command it runs the built-in demonstration: a tour of the disk, three turns of the platform, and back.
#[derive(Parser, Debug)]
#[command(version = VERSION, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) simulation: Simulation,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Run a script of GCS lines on the simulated stage.
    Run {
        /// The script.
        file: PathBuf,
        /// File that the controller keeps its settings in [default: nothing is kept].
        #[arg(long, value_name = "FILE")]
        settings: Option<PathBuf>,
        #[command(flatten)]
        simulation: Simulation,
    },
    /// Run the simulated stage in real time and let GCS clients drive it, over TCP and a pseudo-terminal.
    #[cfg(unix)]
    Serve(Serve),
    /// Watch and drive a controller that runs already, on a serial line or at a TCP address, in a browser.
    #[cfg(unix)]
    View(View),
    /// Record signals of a controller that runs already, every tick or less often: a table and a picture.
    #[cfg(unix)]
    Record(RecordRun),
    /// Write settings of a controller that runs already into a readable file, or bring them back from one.
    #[cfg(unix)]
    #[command(subcommand)]
    Settings(SettingsCommand),
    /// Break something in many short simulated runs, and see whether the controller notices. Exit code 1 if it does not.
    Faults(Faults),
    /// Pivot angles (deg) of a pose (mm, mm, deg).
    Inverse(PoseRows),
    /// Pose (mm, mm, deg) of three pivot angles (deg).
    Direct(PivotRows),
    /// Whether the stage can take a pose, and how far it is from each limit. Exit code 1 if it cannot.
    Check(PoseArguments),
    /// Draw a quantity over the disk as a contour picture.
    Map(Map),
}

/// The simulated stage, served.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(super) struct Serve {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50000")]
    pub(super) listen: String,
    /// Simulated seconds in a second.
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = speed)]
    pub(super) speed: f64,
    /// A pseudo-terminal besides, in place of the controller's serial line.
    #[arg(long)]
    pub(super) pty: bool,
    /// Address and port of the page to watch and drive the stage in a browser; `off` for none [default: 127.0.0.1:8080, or a
    /// free port if that is taken].
    #[arg(long, value_name = "ADDRESS")]
    pub(super) web: Option<String>,
    /// File that the controller keeps its settings in [default: nothing is kept].
    #[arg(long, value_name = "FILE")]
    pub(super) settings: Option<PathBuf>,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
}

/// A campaign of faults.
#[derive(Args, Clone, Debug)]
pub(super) struct Faults {
    /// Runs with a fault; as many are run without.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = value_parser!(u32).range(1..=10_000_000))]
    pub(super) runs: u32,
    /// Seed of the campaign.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Threads [default: as many as there are processors].
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(super) jobs: Option<usize>,
    /// Run the run of this seed again, alone, and tell about it.
    #[arg(long, value_name = "SEED", conflicts_with_all = ["runs", "seed", "jobs"])]
    pub(super) only: Option<u64>,
    /// Write all runs into this file, as CSV.
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

fn jobs(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(jobs @ 1..=1024) => Ok(jobs),
        _ => Err("not a number from 1 to 1024".to_owned()),
    }
}

/// Slowest and fastest: 20 ticks a second, and more than any machine computes.
#[cfg(unix)]
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

#[cfg(unix)]
fn speed(text: &str) -> Result<f64, String> {
    let speed: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if SPEEDS.contains(&speed) {
        Ok(speed)
    } else {
        Err(format!("not from {} to {}", SPEEDS.start(), SPEEDS.end()))
    }
}
