//! Options of commissioning.

use super::super::number::{whole, within};
use super::super::stage::Machine;
use super::controller::Controller;
use clap::Args;
use desk::commission::MOST_ALSO_CARRIED_KG;
use std::path::PathBuf;

/// Commissioning.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Commission {
    #[command(flatten)]
    pub(in super::super) on: Commissioned,
    #[command(flatten)]
    pub(in super::super) load: Load,
    /// Begin with this step, on a controller that was commissioned before: what the steps before it found is in its parameters.
    #[arg(long, value_name = "STEP", conflicts_with_all = ["only", "list"])]
    pub(in super::super) from: Option<String>,
    /// Run this step alone, as after a repair, and keep what it finds.
    #[arg(long, value_name = "STEP", conflicts_with = "list")]
    pub(in super::super) only: Option<String>,
    /// Find the encoders' zeros without a jig: each ring is moved until a guide is at its end (step `ends` in place of `zeros`). Two minutes more,
    /// and x is where pivot 1's encoder reads 0.
    #[arg(long, conflicts_with_all = ["only", "list", "undo"])]
    pub(in super::super) without_jig: bool,
    /// Do not wait for Enter: the platform is in its jig already. For a step alone, since in all of them it is turned by hand before.
    #[arg(long, requires = "only")]
    pub(in super::super) yes: bool,
    /// List the steps; no machine is needed.
    #[arg(long)]
    pub(in super::super) list: bool,
    /// Give the controller back what it was told before the last run into the folder of --out, and have that kept.
    #[arg(long, conflicts_with_all = ["from", "only", "list"])]
    pub(in super::super) undo: bool,
}

/// Another payload.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Tune {
    #[command(flatten)]
    pub(in super::super) on: Commissioned,
    #[command(flatten)]
    pub(in super::super) load: Load,
}

/// What the platform carries.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Load {
    /// Weight that stands on the platform at times besides what is on it now, at most: a cylinder of 50 mm radius in its middle. Gains and limits of
    /// motion are for both.
    #[arg(long, value_name = "KG", default_value_t = 0.0, value_parser = within(0.0..=MOST_ALSO_CARRIED_KG))]
    pub(in super::super) also_carries: f64,
}

/// The machine that is commissioned, tuned or looked at.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Commissioned {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// A simulated machine, with a simulated person beside it, in place of a controller that runs.
    #[command(flatten)]
    pub(in super::super) machine: Machine,
    /// Seed of the simulated noise.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub(in super::super) seed: u64,
    /// Folder for the report, its numbers (results.json, which the next run into it is held against), the loops' lines as tables, what the
    /// controller was told before (before.txt) and what it keeps now (settings.txt); of a simulated machine for its controller's flash, too.
    #[arg(long, value_name = "DIR", default_value = "tripivot-commission")]
    pub(in super::super) out: PathBuf,
    /// Periods of the encoders' scale in a turn, as their data sheet has them (lines of an optical scale), for the step `sde`; without it those
    /// that the controller has been told (0x54500E00). A simulated machine has its data sheet.
    #[arg(long, value_name = "PERIODS", value_parser = whole(1..=100_000))]
    pub(in super::super) scale_periods: Option<u32>,
    /// Temperature of the air, deg C, for the report.
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = within(-50.0..=100.0))]
    pub(in super::super) temperature: Option<f64>,
}
