//! The arguments, as clap reads them.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use tripivot::cli::VERSION;
use tripivot::cli::stage::SimulatedStage;
use tripivot::cli::stage::Simulation;

/// The image for the controller's chip: run on an emulated chip, looked at, counted.
///
/// Exit codes: 0 done; 1 the stage faulted, chip and host differ, or a proof fails; 2 the command line, a file or a number is wrong.
#[derive(Parser, Debug)]
#[command(version = VERSION)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Run a script, or motion from a seed, on the image for the controller's chip, emulated, and compare it with the host to the bit.
    Chip(ChipRun),
    /// Let GCS clients drive the emulated chip over its serial line, one at a time, over TCP.
    ChipServe(ChipServe),
    /// Commission an unknown machine whose controller is the emulated chip, over its serial line, with a simulated person beside it. What the
    /// chip is told in the end goes into a file, since its emulated flash takes nothing; a second chip that keeps that moves the machine. Exit
    /// code 1 if a step fails. Takes some minutes.
    ChipCommission(ChipCommission),
    /// Count the instructions that parts of the library take on the emulated chip, over random states.
    Cost(CostRun),
    /// Let the control loop run on the emulated chip while the serial line is full, and tell when its ticks start.
    ChipLoad(ChipLoad),
    /// Write what goes over the chip's pins in the demonstration, tick by tick, both ways: for another emulator to be held against.
    ChipPins(ChipPins),
    /// Follow one tick of a move on the emulated chip, instruction by instruction, and tell what they are spent on.
    ChipTick(ChipTick),
    /// What ticks take in cycles of the real core and its flash, by what they are used for: a model of both over the instructions that
    /// ran on the emulated chip.
    ChipCycles(ChipCycles),
    /// Flip single bits of the emulated chip's RAM while it works, and tell what the controller makes of them.
    ChipUpsets(ChipUpsets),
    /// Prove of the chip's image that its control loop cannot panic and how deep its stack gets; print what it takes of flash and
    /// RAM. Exit code 1 if the proof fails.
    ImageCheck,
    /// Give the chip's image its checksum, which it checks at every start. To be done after `cargo stage`, before flashing.
    Seal,
}

/// A run on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipRun {
    /// The script [default: the demonstration].
    pub(super) file: Option<PathBuf>,
    /// Instead of a script demanding motion from the seed, compared at so many ticks, with what they cost.
    #[arg(long, value_name = "N", conflicts_with_all = ["file", "out", "every"], value_parser = value_parser!(u64).range(1..))]
    pub(super) ticks: Option<u64>,
    /// Flip one bit of an encoder count on the host alone at this tick, counted from 0: the comparison has to find it, exit code 1.
    #[arg(long, value_name = "TICK", requires = "ticks")]
    pub(super) flip: Option<u64>,
    /// The stage is off its drawing as a workshop builds it, and the controller keeps its calibration.
    #[arg(long, requires = "ticks")]
    pub(super) calibrated: bool,
    #[command(flatten)]
    pub(super) simulation: Simulation,
}

/// The emulated chip, served.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipServe {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50001")]
    pub(super) listen: String,
    /// Listen at an address that other machines reach: anybody there can drive the stage.
    #[arg(long)]
    pub(super) allow_remote: bool,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
}

/// An unknown machine.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipCommission {
    /// Which.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(super) unknown: u64,
    /// Folder for the report and the settings.
    #[arg(long, value_name = "DIR", default_value = "tripivot-chip-commission")]
    pub(super) out: PathBuf,
}

/// Where the repository keeps the figures, for a program that is run where it was built.
const FIGURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../firmware/figures.csv");

const LIMITS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../firmware/cycle-limits.csv"
);

/// Load on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipLoad {
    /// Ticks.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = value_parser!(u64).range(1_000..=10_000_000))]
    pub(super) ticks: u64,
}

/// What goes over the pins.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipPins {
    /// Ticks.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = value_parser!(u64).range(1..=2_000_000))]
    pub(super) ticks: u64,
    /// The file.
    pub(super) file: PathBuf,
}

/// Cycles of ticks.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipCycles {
    /// Ticks of each use, about.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = value_parser!(u64).range(40..=4_000))]
    pub(super) ticks: u64,
    /// Functions and lines named that wait most.
    #[arg(long, value_name = "N", default_value_t = 15)]
    pub(super) top: usize,
    /// Compare with the limits that the repository keeps, and the model with llvm-mca: exit code 1 when a tick is over its limit, or
    /// the two are more than 2 % apart.
    #[arg(long)]
    pub(super) check: bool,
    /// Write the limits that these ticks give.
    #[arg(long, conflicts_with = "check")]
    pub(super) write: bool,
    /// The limits.
    #[arg(long, value_name = "FILE", default_value = LIMITS)]
    pub(super) limits: PathBuf,
}

/// Bits that flip.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipUpsets {
    /// Runs, each with one bit.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub(super) runs: u64,
    /// Seed of the runs' seeds.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// One of the runs again, by the number of its part of the memory and its seed, as they are printed.
    #[arg(long, value_name = "PART:SEED", conflicts_with_all = ["runs", "seed"])]
    pub(super) only: Option<String>,
}

/// One tick on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(super) struct ChipTick {
    /// The tick, counted from the start; the move begins at 100.
    #[arg(long, value_name = "N", default_value_t = 600, value_parser = value_parser!(u64).range(..100_000))]
    pub(super) tick: u64,
    /// What to sum up by.
    #[arg(long, default_value = "file")]
    pub(super) by: Place,
}

/// Where an instruction is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(super) enum Place {
    /// The file.
    File,
    /// The function, with its file.
    Function,
    /// The line.
    Line,
}

/// Counting on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(super) struct CostRun {
    /// Random states: each is a call of every part, or ten and more where calls are short [default: 300; with --check as many as
    /// the figures are of].
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1_000_000))]
    pub(super) states: Option<u32>,
    /// Seed of the random states.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u32,
    /// Only parts with this in their name, as "motion".
    #[arg(long, value_name = "NAME", default_value = "")]
    pub(super) only: String,
    /// Compare with the figures that the repository keeps: exit code 1 when a part has grown by more than 3 %.
    #[arg(long, conflicts_with_all = ["states", "seed", "only"])]
    pub(super) check: bool,
    /// Write the figures.
    #[arg(long, conflicts_with_all = ["check", "seed", "only"])]
    pub(super) write: bool,
    /// The figures.
    #[arg(long, value_name = "FILE", default_value = FIGURES)]
    pub(super) figures: PathBuf,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}
