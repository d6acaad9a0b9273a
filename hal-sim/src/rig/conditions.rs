//! The conditions of a run, out of its options.

use super::Told;
use super::run::RunOptions;
use crate::machine::plant::Imperfections;
use crate::report::Conditions;

/// What the machine is called, and what the controller has been told of it.
#[must_use]
pub fn machine_name(options: &RunOptions) -> String {
    match options.told {
        Told::Nothing | Told::Reference => options.machine_name.clone(),
        told => format!("{} whose controller is told {told}", options.machine_name),
    }
}

/// What a run with these options on the host is made under. Who calls may know better which program and machine it is.
#[must_use]
pub fn run_conditions(options: &RunOptions) -> Conditions {
    Conditions {
        program: concat!("hal-sim ", env!("CARGO_PKG_VERSION")).to_owned(),
        machine: format!(
            "simulated {}, controller on the host",
            machine_name(options)
        ),
        seed: options.seed,
        mismatch_percent: options.mismatch_percent,
        payload_kg: options.payload_kg,
        without: Imperfections::CALIBRATED.beyond(options.imperfections),
        with: (options.imperfections).beyond(Imperfections::CALIBRATED),
        settings: None,
    }
}
