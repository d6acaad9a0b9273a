//! The conditions of a run, out of its options.

use super::run::RunOptions;
use crate::machine::plant::Imperfections;
use crate::report::Conditions;

/// What a run with these options on the host is made under. Who calls may know better which program and machine it is.
#[must_use]
pub fn run_conditions(options: &RunOptions) -> Conditions {
    Conditions {
        program: concat!("hal-sim ", env!("CARGO_PKG_VERSION")).to_owned(),
        machine: "simulated reference stage, controller on the host".to_owned(),
        seed: options.seed,
        mismatch_percent: options.mismatch_percent,
        payload_kg: options.payload_kg,
        without: without(&options.imperfections),
        eccentricity: options.imperfections.encoder_eccentricity,
        settings: None,
    }
}

/// What is switched off, by its name on the command line.
fn without(on: &Imperfections) -> Vec<&'static str> {
    [
        (on.dry_friction, "dry-friction"),
        (on.viscous_friction, "viscous-friction"),
        (on.compliance, "compliance"),
        (on.backlash, "backlash"),
        (on.torque_ripple, "torque-ripple"),
        (on.encoder_noise, "encoder-noise"),
        (on.dead_time, "dead-time"),
        (on.pwm_quantisation, "pwm-quantisation"),
    ]
    .into_iter()
    .filter_map(|(is_on, name)| (!is_on).then_some(name))
    .collect()
}
