//! What the controller reaches once it is told the machine's numbers, as a table: `cargo bench -p hal-sim --bench told`.
//!
//! The demonstration on machines that are off the controller's model: as the controller comes; told the drives', the platform's and
//! the payload's true numbers, with velocity and integral gain scaled by R / Kt and scheduled by the inertia; the same with firmer
//! gains; and told the motors' ripple besides. All of it is what `SPA` can set.

use firmware::parameters::Parameters;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::run::{
    RunOptions, RunOutcome, controller_parameters, run, run_machine, stage_parameters,
};
use hal_sim::rig::script::Script;
use hal_sim::rig::{Told, with_gains_firmer};

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
        for (told, is_firmer) in [
            (Told::Nothing, false),
            (Told::Machine, false),
            (Told::Machine, true),
            (Told::MachineAndRipple, false),
            (Told::MachineAndRipple, true),
        ] {
            let mut parameters = told.parameters(&as_it_comes, &stage);
            let mut words = told.to_string();
            if is_firmer {
                parameters = with_gains_firmer(&parameters);
                words += ", firmer gains";
            }
            let figures = demonstration(&parameters, &stage, &options);
            println!("| kind, {mismatch_percent} % off | {payload_kg} | {words} | {figures} |");
        }
    }
    for (payload_kg, told) in [
        (0.0, Told::Nothing),
        (0.0, Told::Machine),
        (0.0, Told::Reference),
        (0.0, Told::Everything),
        (5.0, Told::Reference),
        (5.0, Told::Everything),
    ] {
        let options = RunOptions {
            payload_kg,
            told,
            ..RunOptions::reference()
        };
        let script = Script::demonstration().expect("it is a script");
        let figures = figures(run(&script, &options));
        println!("| reference stage | {payload_kg} | {told} | {figures} |");
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
    figures(outcome)
}

fn figures(outcome: RunOutcome) -> String {
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
