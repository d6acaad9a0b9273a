//! The arguments, as clap reads them.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};

use crate::report::DEFAULT_EVERY;

#[cfg(feature = "chip")]
mod chip;
#[cfg(unix)]
mod controller;
mod kinematics;

#[cfg(all(feature = "chip", unix))]
pub(super) use chip::ChipServe;
#[cfg(feature = "chip")]
pub(super) use chip::{ChipLoad, ChipRun, ChipTick, CostRun, Place};
#[cfg(unix)]
pub(super) use controller::{Controller, RecordRun, SettingsCommand, View};
pub(super) use kinematics::{Map, PivotRows, PoseArguments, PoseRows, Quantity};

/// Tripivot: a simulated planar XY-Theta stage under its real controller.
///
/// Without a command it runs the built-in demonstration: a tour of the disk, three turns of the platform, and back.
#[derive(Parser, Debug)]
#[command(version, args_conflicts_with_subcommands = true)]
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
    /// Run a script, or motion from a seed, on the image for the controller's chip, emulated, and compare it with the host to the bit.
    #[cfg(feature = "chip")]
    Chip(ChipRun),
    /// Let GCS clients drive the emulated chip over its serial line, one at a time, over TCP.
    #[cfg(all(feature = "chip", unix))]
    ChipServe(ChipServe),
    /// Count the instructions that parts of the library take on the emulated chip, over random states.
    #[cfg(feature = "chip")]
    Cost(CostRun),
    /// Let the control loop run on the emulated chip while the serial line is full, and tell when its ticks start.
    #[cfg(feature = "chip")]
    ChipLoad(ChipLoad),
    /// Follow one tick of a move on the emulated chip, instruction by instruction, and tell what they are spent on.
    #[cfg(feature = "chip")]
    ChipTick(ChipTick),
    /// Prove of the chip's image that its control loop cannot panic and how deep its stack gets; print what it takes of flash and
    /// RAM. Exit code 1 if the proof fails.
    #[cfg(feature = "chip")]
    ImageCheck,
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

/// Options of a simulation.
#[derive(Args, Clone, Debug)]
pub(super) struct Simulation {
    /// Folder for trace and picture [default: target/tripivot/<name>].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Write every N-th tick into the trace.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_EVERY, value_parser = value_parser!(u32).range(1..))]
    pub(super) every: u32,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// The simulated stage.
#[derive(Args, Clone, Debug)]
pub(super) struct SimulatedStage {
    /// Seed of the simulated noise: the same seed gives the same trace.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// By how much the simulated stage departs from the controller's model of it: heavier, more friction, weaker motors.
    #[arg(long, value_name = "PERCENT", default_value_t = 20.0, allow_negative_numbers = true, value_parser = mismatch_percent)]
    pub(super) mismatch: f64,
    /// Load on the platform that the controller knows nothing of, 0 to 5 kg, 20 mm off the centre.
    #[arg(long, value_name = "KG", default_value_t = 0.0, value_parser = payload_kg)]
    pub(super) payload: f64,
    /// Imperfections of the simulated stage to switch off.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(super) without: Vec<Imperfection>,
    /// Switch on the eccentricity of the encoders: a stage that has not been calibrated.
    #[arg(long)]
    pub(super) eccentricity: bool,
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

/// What a simulated stage can do without.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(super) enum Imperfection {
    /// All of them.
    All,
    /// Coulomb, static and presliding friction.
    DryFriction,
    /// Viscous friction.
    ViscousFriction,
    /// Elastic transmission.
    Compliance,
    /// Dead zone in the transmission.
    Backlash,
    /// Torque ripple of the motors.
    TorqueRipple,
    /// Encoder noise.
    EncoderNoise,
    /// Dead time of the bridges.
    DeadTime,
    /// Counts of the PWM.
    PwmQuantisation,
}

/// Beyond that the simulated motors have no torque, or the platform no mass.
const MISMATCH_LIMIT_PERCENT: f64 = 80.0;

/// What the reference stage carries at most.
const PAYLOAD_LIMIT_KG: f64 = 5.0;

fn payload_kg(text: &str) -> Result<f64, String> {
    let kg: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=PAYLOAD_LIMIT_KG).contains(&kg) {
        Ok(kg)
    } else {
        Err(format!("not between 0 and {PAYLOAD_LIMIT_KG}"))
    }
}

fn mismatch_percent(text: &str) -> Result<f64, String> {
    let percent: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if percent.abs() <= MISMATCH_LIMIT_PERCENT {
        Ok(percent)
    } else {
        Err(format!(
            "not from -{MISMATCH_LIMIT_PERCENT} to {MISMATCH_LIMIT_PERCENT}"
        ))
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
