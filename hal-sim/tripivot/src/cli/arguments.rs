//! The arguments, as clap reads them.

use super::number::{whole, within};
use super::stage::{Machine, SimulatedStage, Simulation};
pub(super) use calibrate::{
    CalibrateApply, CalibrateCommand, CalibrateDemo, CalibrateFit, CalibrateMeasure, CalibratePlan,
    CalibrateReport, CalibrateVerify, CalibratedMachine, NoiseArguments,
};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
pub(super) use commission::{Commission, Commissioned, Tune};
pub(super) use controller::{Access, BoardRun, Controller, RecordRun, SettingsCommand, View};
pub(super) use kinematics::{Map, PivotRows, PoseArguments, PoseRows, Quantity};
use std::path::PathBuf;

mod calibrate;
mod commission;
mod controller;
mod kinematics;

/// Version and commit of this program.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("TRIPIVOT_COMMIT"));

/// Below the help.
const EXIT_CODES: &str = "Exit codes: 0 done; 1 the stage faulted or never settled, a fault was missed, or the pose is out of reach; \
    2 the command line, a file or a number is wrong.";

/// Tripivot: a simulated planar XY-Theta stage under its real controller.
///
/// Without a command it runs the built-in demonstration: a tour of the disk, three turns of the platform, and back.
#[derive(Parser, Debug)]
#[command(version = VERSION, after_help = EXIT_CODES, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) simulation: Simulation,
    #[command(flatten)]
    pub(super) output: RunOutput,
}

/// How a run tells what came of it.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct RunOutput {
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: run; conditions (program, machine, seed, mismatch_percent, payload_kg, without, with, settings);
    /// following_error (ticks; centre_um, theta_urad, pivots_lsb: each peak and rms); true_error (centre_um,
    /// theta_urad, of the true pose); unseen_error (the same, of what no encoder sees: sag); at_rest (ticks; following_error, true_error,
    /// unseen_error: lost motion, each as above); moves (start_s, profile_end_s, settled_s,
    /// settle_ms, x_mm, y_mm, theta_deg; null where the stage had not settled when the next move began or the run ended);
    /// never_settled, how many of those had a tenth of a second for it, or more; peak_duty (0 to 1);
    /// smallest_separation_deg; simulated_s; wall_s; answers (line, answer); fault (null without one); folder.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Run a script of GCS lines on the simulated stage.
    ///
    /// `! PUSH X 5 N 20 MS` (W: NM) pushes the platform, `! SHAKE Y 0.05 M/S2 8 HZ 2 S` shakes the floor; the script goes on at once.
    Run {
        /// The script.
        file: PathBuf,
        /// File that the controller keeps its settings in [default: nothing is kept].
        #[arg(long, value_name = "FILE")]
        settings: Option<PathBuf>,
        #[command(flatten)]
        simulation: Simulation,
        #[command(flatten)]
        output: RunOutput,
    },
    /// Run the simulated stage in real time and let GCS clients drive it, over TCP and a pseudo-terminal.
    Serve(Serve),
    /// Watch and drive a controller that runs already, on a serial line or at a TCP address, in a browser.
    View(View),
    /// Record signals of a controller that runs already, every tick or less often: a table and a picture.
    Record(RecordRun),
    /// Write settings of a controller that runs already into a readable file, or bring them back from one.
    #[command(subcommand)]
    Settings(SettingsCommand),
    /// Run the tests that are to be repeated on every board, over its command line; nothing moves without --move. Exit code 1 if one
    /// fails.
    Board(BoardRun),
    /// Bring up a machine that nobody knows: which plug is which, which way everything turns, zeros, windings, friction; and see it move.
    /// Every step tells what it measured, its limit and what to do where it fails. Exit code 1 at the first that does.
    Commission(Commission),
    /// Fit a commissioned controller to a new payload, without anybody's help: inertias, gains, notches, limits of motion.
    Tune(Tune),
    /// Measure the frequency response of a commissioned machine's loops, as tables and plots. Nothing is kept; the servo is off after it.
    Frf(Commissioned),
    /// Print the numbers of the simulated machine, as a file to change and to give back with --machine.
    Machine(Machine),
    /// How much each imperfection of the simulated machine decides: the demonstration with one more or less at a time, as a table.
    Sensitivity(SensitivityRun),
    /// Break something in many short simulated runs, and see whether the controller notices. Exit code 1 if it does not.
    Faults(Faults),
    /// Find what a built machine is off its drawing: where to measure, and the fit to what was measured.
    #[command(subcommand)]
    Calibrate(CalibrateCommand),
    /// Pivot angles (deg) of a pose (mm, mm, deg), or what the encoders of a built machine read. Exit code 1 if it is out of reach.
    Inverse(PoseRows),
    /// Pose (mm, mm, deg) of three pivot angles (deg), or of what the encoders of a built machine read.
    Direct(PivotRows),
    /// Whether the stage can take a pose, and how far it is from each limit. Exit code 1 if it cannot.
    Check(PoseArguments),
    /// Draw a quantity over the disk as a contour picture.
    Map(Map),
    /// Print a shell's completions of this command line.
    ///
    /// For bash: tripivot completions bash > ~/.local/share/bash-completion/completions/tripivot
    Completions {
        /// Which shell.
        shell: Shell,
    },
    /// Write the manual pages of this program and of each of its commands into a folder.
    Man {
        /// The folder.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

/// The simulated stage, served.
#[derive(Args, Clone, Debug)]
pub(super) struct Serve {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50000")]
    pub(super) listen: String,
    /// Simulated seconds in a second.
    #[arg(long, value_name = "N", default_value_t = 1.0, allow_negative_numbers = true, value_parser = within(SPEEDS))]
    pub(super) speed: f64,
    /// A pseudo-terminal besides, in place of the controller's serial line; not on Windows.
    #[arg(long)]
    pub(super) pty: bool,
    /// Address and port of the page to watch and drive the stage in a browser; `off` for none [default: 127.0.0.1:8080, or a
    /// free port if that is taken].
    #[arg(long, value_name = "ADDRESS")]
    pub(super) web: Option<String>,
    #[command(flatten)]
    pub(super) access: Access,
    /// File that the controller keeps its settings in [default: nothing is kept].
    #[arg(long, value_name = "FILE")]
    pub(super) settings: Option<PathBuf>,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
}

/// The demonstration on many machines.
#[derive(Args, Clone, Debug)]
pub(super) struct SensitivityRun {
    /// Machines that have one imperfection more than a kind one, or less, under a controller that is told of none [default: machines that have one
    /// less than the reference stage, under controllers that are told of theirs].
    #[arg(long)]
    pub(super) kind: bool,
    /// By how much the machines depart from the controller's model.
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, allow_negative_numbers = true, value_parser = within(-80.0..=80.0))]
    pub(super) mismatch: f64,
    /// Load on the platform that the controller knows nothing of, 0 to 5 kg.
    #[arg(long, value_name = "KG", default_value_t = 0.0, allow_negative_numbers = true, value_parser = within(0.0..=5.0))]
    pub(super) payload: f64,
    /// Threads [default: as many as there are processors].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(1..=1024_usize))]
    pub(super) jobs: Option<usize>,
}

/// A campaign of faults.
#[derive(Args, Clone, Debug)]
pub(super) struct Faults {
    /// Runs with a fault; as many are run without.
    #[arg(long, value_name = "N", default_value_t = 10_000, allow_negative_numbers = true, value_parser = whole(1..=10_000_000_u32))]
    pub(super) runs: u32,
    /// Seed of the campaign.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub(super) seed: u64,
    /// Threads [default: as many as there are processors].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(1..=1024_usize))]
    pub(super) jobs: Option<usize>,
    /// Run the run of this seed again, alone, and tell about it.
    #[arg(long, value_name = "SEED", allow_negative_numbers = true, value_parser = whole(0..=u64::MAX), conflicts_with_all = ["runs", "seed", "jobs"])]
    pub(super) only: Option<u64>,
    /// Run it on commissioned machines: a folder with a folder for each, by its number, as `SETTINGS=DIR cargo bench -p tripivot --bench
    /// commission` leaves them. Without, each run draws a machine, whose controller is told what its builder knows.
    #[arg(long, value_name = "DIR")]
    pub(super) commissioned: Option<PathBuf>,
    /// Seeds of runs whose problems are known: told, but no failure. One that has none any more is one.
    #[arg(long, value_name = "SEEDS", value_delimiter = ',', value_parser = whole(0..=u64::MAX))]
    pub(super) known: Vec<u64>,
    /// Write all runs into this file, as CSV.
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: runs, seed (both null with --only) and wall_s; faults, for each of them and at last for the runs without: fault, runs,
    /// detected, within_noise, within_days, within_push and beyond (not detected: inputs differ from the sound run's by less than noise, by
    /// less than that machine's own do on another day, as they would if somebody pushed, or by more), wrong, latency_ticks, way_mm,
    /// turn_deg, blow_j, deviation_mm and undetected_deviation_mm (median, most, worst each: most is what 99 of 100 stay under), blows, ended_braked, ended_released,
    /// ended_moving;
    /// missed, the runs with a fault that are not as they should be, and alarms, the runs without; told, those runs one by
    /// one, with --only both: seed, is_control, fault, tick, latched, latched_tick, latency_ticks, problem, text.
    #[arg(long)]
    pub(super) json: bool,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Slowest and fastest: 20 ticks a second, and more than any machine computes.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;
