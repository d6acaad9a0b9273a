//! Options of what runs on the emulated chip.

use std::path::PathBuf;

use clap::{Args, ValueEnum, value_parser};

#[cfg(unix)]
use super::SimulatedStage;
use super::Simulation;

/// A run on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct ChipRun {
    /// The script [default: the demonstration].
    pub(in super::super) file: Option<PathBuf>,
    /// Instead of a script demanding motion from the seed, compared at so many ticks, with what they cost.
    #[arg(long, value_name = "N", conflicts_with_all = ["file", "out", "every"], value_parser = value_parser!(u64).range(1..))]
    pub(in super::super) ticks: Option<u64>,
    /// Flip one bit of an encoder count on the host alone at this tick, counted from 0: the comparison has to find it, exit code 1.
    #[arg(long, value_name = "TICK", requires = "ticks")]
    pub(in super::super) flip: Option<u64>,
    #[command(flatten)]
    pub(in super::super) simulation: Simulation,
}

/// The emulated chip, served.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(in super::super) struct ChipServe {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50001")]
    pub(in super::super) listen: String,
    #[command(flatten)]
    pub(in super::super) stage: SimulatedStage,
}

/// Where the repository keeps the figures, for a program that is run where it was built.
const FIGURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/figures.csv");

/// Load on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct ChipLoad {
    /// Ticks.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = value_parser!(u64).range(1_000..=10_000_000))]
    pub(in super::super) ticks: u64,
}

/// One tick on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct ChipTick {
    /// The tick, counted from the start; the move begins at 100.
    #[arg(long, value_name = "N", default_value_t = 600, value_parser = value_parser!(u64).range(..100_000))]
    pub(in super::super) tick: u64,
    /// What to sum up by.
    #[arg(long, default_value = "file")]
    pub(in super::super) by: Place,
}

/// Where an instruction is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(in super::super) enum Place {
    /// The file.
    File,
    /// The function, with its file.
    Function,
    /// The line.
    Line,
}

/// Counting on the emulated chip.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CostRun {
    /// Random states: each is a call of every part, or ten and more where calls are short [default: 300; with --check as many as
    /// the figures are of].
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1_000_000))]
    pub(in super::super) states: Option<u32>,
    /// Seed of the random states.
    #[arg(long, default_value_t = 1)]
    pub(in super::super) seed: u32,
    /// Only parts with this in their name, as "motion".
    #[arg(long, value_name = "NAME", default_value = "")]
    pub(in super::super) only: String,
    /// Compare with the figures that the repository keeps: exit code 1 when a part has grown by more than 3 %.
    #[arg(long, conflicts_with_all = ["states", "seed", "only"])]
    pub(in super::super) check: bool,
    /// Write the figures.
    #[arg(long, conflicts_with_all = ["check", "seed", "only"])]
    pub(in super::super) write: bool,
    /// The figures.
    #[arg(long, value_name = "FILE", default_value = FIGURES)]
    pub(in super::super) figures: PathBuf,
    /// No progress bar.
    #[arg(long, short)]
    pub(in super::super) quiet: bool,
}
