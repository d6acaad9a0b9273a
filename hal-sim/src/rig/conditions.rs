//! The conditions of a run, out of its options.

use super::run::RunOptions;
use crate::machine::plant::Imperfections;
use crate::report::Conditions;

/// What a run with these options on the host is made under. Who calls may know better which program and machine it is.
#[must_use]
pub fn run_conditions(options: &RunOptions) -> Conditions {
    Conditions {
        program: concat!("hal-sim ", env!("CARGO_PKG_VERSION")).to_owned(),
        machine: format!("simulated {}, controller on the host", options.machine_name),
        seed: options.seed,
        mismatch_percent: options.mismatch_percent,
        payload_kg: options.payload_kg,
        without: Imperfections::CALIBRATED.beyond(options.imperfections),
        with: (options.imperfections).beyond(Imperfections::CALIBRATED),
        settings: None,
    }
}
