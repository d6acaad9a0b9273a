//! Options of commissioning.

use super::super::number::whole;
use super::super::stage::Machine;
use super::controller::Controller;
use clap::Args;
use std::path::PathBuf;

/// Commissioning.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Commission {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// A simulated machine, with a simulated person beside it, in place of a controller that runs.
    #[command(flatten)]
    pub(in super::super) machine: Machine,
    /// Seed of the simulated noise.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub(in super::super) seed: u64,
    /// Folder for the report; of a simulated machine for its controller's settings, too.
    #[arg(long, value_name = "DIR", default_value = "tripivot-commission")]
    pub(in super::super) out: PathBuf,
    /// Begin with this step, on a controller that was commissioned before: what the steps before it found is in its parameters.
    #[arg(long, value_name = "STEP", conflicts_with_all = ["only", "list"])]
    pub(in super::super) from: Option<String>,
    /// Run this step alone, as after a repair, and keep what it finds.
    #[arg(long, value_name = "STEP", conflicts_with = "list")]
    pub(in super::super) only: Option<String>,
    /// List the steps; no machine is needed.
    #[arg(long)]
    pub(in super::super) list: bool,
}
