//! What the carriages do on their guides, made up for by a controller that has been told of it: twins of the same machine, of which one's
//! controller knows nothing of its guides.

use firmware::parameters::Parameters;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::machine::plant::Imperfections;
use hal_sim::report::{Move, Run};
use hal_sim::rig::run::{RunOptions, controller_parameters, run_machine, stage_parameters};
use hal_sim::rig::script::Script;
use hal_sim::rig::{Told, with_gains_fitted, with_guides_told, with_machine_told};
use std::sync::LazyLock;

/// A kind machine whose carriages have friction, on guides that give way, or one of both.
fn machine(guide_friction: bool, guide_compliance: bool) -> RunOptions {
    RunOptions {
        mismatch_percent: 0.0,
        imperfections: Imperfections {
            guide_friction,
            guide_compliance,
            // It hides what is looked for.
            torque_ripple: false,
            ..Imperfections::CALIBRATED
        },
        ..RunOptions::default()
    }
}

/// Which twin: its controller is told of all of the machine but its guides, or of these too.
#[derive(Clone, Copy, PartialEq)]
enum Twin {
    Untold,
    Told,
}

fn parameters(options: &RunOptions, twin: Twin) -> Parameters {
    let stage = stage_parameters(options);
    let machine = with_machine_told(&controller_parameters(options), &stage);
    let fitted = with_gains_fitted(&machine, &stage);
    match twin {
        Twin::Untold => fitted,
        Twin::Told => with_guides_told(&fitted, &stage),
    }
}

fn run(options: &RunOptions, parameters: &Parameters, script: &str) -> Run {
    let script = Script::parse("guides", script).unwrap();
    let (stage, flash) = (stage_parameters(options), SettingsFlash::in_memory());
    let outcome = run_machine(&script, parameters, &stage, options, flash);
    assert_eq!(outcome.fault, None);
    outcome.run
}

const MOVES: &str = "FRF\nMOV X 40 Y 10 W 20\nWAC ONT? X = 1\nMOV X -40 Y 30 W -20\nWAC ONT? X = 1\nMOV X 0 Y -50\nWAC ONT? X = 1\n";

/// Errors of the following centre and of its true pose, rms, um; mean settling, ms.
fn errors(options: &RunOptions, twin: Twin) -> [f64; 3] {
    let run = run(options, &parameters(options, twin), MOVES);
    let statistics = run.trace.statistics();
    let settling: Vec<f64> = run.moves.iter().filter_map(Move::settle_s).collect();
    let mean_s = settling.iter().sum::<f64>() / settling.len() as f64;
    let [seen, truth] = [&statistics.moving.following, &statistics.moving.truth];
    [seen.xy_um.rms(), truth.xy_um.rms(), 1e3 * mean_s]
}

const TWINS: [Twin; 2] = [Twin::Untold, Twin::Told];

#[test]
fn friction_that_is_known_hardly_shows() {
    let options = machine(true, false);
    let [untold, told] = TWINS.map(|twin| errors(&options, twin));
    println!("untold {untold:?}, told {told:?}");
    // 48 and 167 nm.
    assert!(
        told[0] < 0.053 && untold[0] > 0.150,
        "{told:?} for {untold:?}"
    );
}

#[test]
fn a_platform_on_soft_guides_is_where_it_should_be() {
    let options = machine(false, true);
    let [untold, told] = TWINS.map(|twin| errors(&options, twin));
    println!("untold {untold:?}, told {told:?}");
    // 31 and 83 nm, 31 of them seen by the encoders: that is all that is left. The pushes for it cost 3 ms of settling.
    assert!(told[1] < 1.03 * told[0], "{told:?}");
    assert!(
        told[1] < 0.0346 && untold[1] > 0.070,
        "{told:?} for {untold:?}"
    );
    assert!(told[2] < 4.4, "{told:?}");
}

/// The same pose gone to from both sides: what stays between the two is what the guides keep of the friction.
#[test]
fn lost_motion_becomes_less() {
    static SCRIPT: LazyLock<String> = LazyLock::new(|| {
        let there =
            |x: i32, y: i32, w: i32| format!("MOV X {x} Y {y} W {w}\nWAC ONT? X = 1\nDEL 200\n");
        let mut script = "FRF\n".to_owned();
        for side in [1, -1, 1, -1] {
            script += &there(30 * side, 20 * side, 10 * side);
            script += &there(0, 0, 0);
        }
        script
    });
    let options = machine(true, true);
    let [untold, told] = TWINS.map(|twin| {
        let run = run(&options, &parameters(&options, twin), &SCRIPT);
        lost_nm(&run)
    });
    println!("untold {untold:?} nm, told {told:?} nm");
    // 4.9 and 27 nm.
    assert!(told < 5.4 && untold > 24.0, "{told} for {untold}");
}

/// What no encoder sees of the centre's error at rest, nm rms.
fn lost_nm(run: &Run) -> f64 {
    1e3 * run.trace.statistics().at_rest.unseen.xy_um.rms()
}

#[test]
fn a_machine_that_has_ideal_guides_is_told_of_none() {
    let stage = StageParameters::REFERENCE;
    let told = with_guides_told(&Parameters::REFERENCE, &stage);
    assert_eq!(told, Parameters::REFERENCE);
    assert_eq!(Told::Everything.calibration(&stage), None);
}
