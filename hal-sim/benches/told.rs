//! What the controller reaches once it is told the machine's numbers, as a table: `cargo bench -p hal-sim --bench told`.
//!
//! The demonstration on machines that are off the controller's model: as the controller comes; told the drives', the platform's and
//! the payload's true numbers, with velocity and integral gain scaled by R / Kt and scheduled by the inertia; and told the motors'
//! ripple besides. All of it is what `SPA` can set.

use firmware::control::servo::{ServoConfig, carried_inertia};
use firmware::parameters::{Harmonic, Parameters};
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::run::{RunOptions, controller_parameters, run_machine, stage_parameters};
use hal_sim::rig::script::Script;
use hal_sim::rig::with_drives_told;

fn main() {
    println!(
        "| machine | load, kg | told | centre, um rms / peak | settling after the profile, ms: mean / worst |"
    );
    println!("|---|---|---|---|---|");
    for (mismatch_percent, payload_kg) in [
        (0.0, 0.0),
        (20.0, 0.0),
        (-20.0, 0.0),
        (35.0, 0.0),
        (-35.0, 0.0),
        (20.0, 5.0),
        (35.0, 5.0),
    ] {
        let options = RunOptions {
            mismatch_percent,
            payload_kg,
            ..RunOptions::default()
        };
        let stage = stage_parameters(&options);
        let as_it_comes = controller_parameters(&options);
        let told = told(&as_it_comes, &stage);
        let with_ripple = with_ripple(&told, &stage);
        for (words, parameters) in [
            ("nothing", as_it_comes),
            ("machine", told),
            ("machine and ripple", with_ripple),
        ] {
            let figures = demonstration(&parameters, &stage, &options);
            println!("| {mismatch_percent} % off | {payload_kg} | {words} | {figures} |");
        }
    }
}

fn demonstration(parameters: &Parameters, stage: &StageParameters, options: &RunOptions) -> String {
    let script = Script::demonstration().expect("it is a script");
    let outcome = run_machine(
        &script,
        parameters,
        stage,
        options,
        SettingsFlash::in_memory(),
    );
    if let Some(fault) = outcome.fault {
        return format!("{fault} |");
    }
    let facts = outcome.run.facts();
    let centre = &facts.true_error.centre_um;
    let settling: Vec<f64> = (outcome.run.moves.iter())
        .filter_map(|one| Some(one.settle_s()? * 1e3))
        .collect();
    let mean = settling.iter().sum::<f64>() / settling.len() as f64;
    let worst = settling.iter().fold(0.0_f64, |worst, &one| worst.max(one));
    format!(
        "{:.3} / {:.3} | {mean:.1} / {worst:.1}",
        centre.rms, centre.peak
    )
}

/// The controller's parameters with the machine's true numbers in place of the model's.
fn told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = with_drives_told(parameters, stage);
    // What the reference gains are for: the inertia at a pivot in the middle of the reference stage.
    told.servo.scheduled_inertia_kg_m2 = middle_inertia_kg_m2();
    let payload = &stage.plant.payload;
    let (sin, cos) = payload.direction_rad.sin_cos();
    let platform = &mut told.platform;
    platform.payload_kg = payload.mass_kg;
    platform.payload_inertia_kg_m2 = payload.inertia_kg_m2;
    platform.payload_centre_mm = [cos, sin].map(|part| part * payload.eccentricity_m * 1e3);
    told
}

fn middle_inertia_kg_m2() -> f64 {
    let reference = Parameters::REFERENCE;
    let body = ServoConfig::new(&reference).body;
    let carried = carried_inertia(&body, &[1.0; 3], &[1.0; 3], 0);
    reference.drives[0].inertia_kg_m2 + f64::from(carried)
}

fn with_ripple(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let plant = &stage.plant;
    for ripple in &mut told.servo.ripple {
        ripple.harmonics[0] = Harmonic {
            periods: plant.ripple_periods_per_motor_turn * plant.gear_ratio,
            amplitude_n_m: plant.ripple_n_m,
            phase_deg: 0.0,
        };
    }
    told
}
