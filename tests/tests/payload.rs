//! A load that the controller knows nothing of: the stage goes slower into its window, and nothing else happens.

use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;

const SCRIPT: &str = "FRF
WAC ONT? W = 1
MOV X 70 W 200
WAC ONT? W = 1
DEL 20
MOV X -40 Y 50 W -100
WAC ONT? W = 1
DEL 20
MOV X 0 Y 0 W 0
WAC ONT? W = 1
DEL 100
";

#[test]
fn an_unknown_payload_is_carried_whatever_the_mismatch() {
    let script = Script::parse("payload", SCRIPT).expect("a good script");
    // What it does, and a tenth more.
    for (mismatch_percent, most_um, most_s) in [
        (-20.0, 0.338, 0.0216),
        (0.0, 0.192, 0.0207),
        (20.0, 1.01, 0.0488),
    ] {
        let outcome = run(
            &script,
            &RunOptions {
                payload_kg: 5.0,
                mismatch_percent,
                ..RunOptions::default()
            },
        );
        assert_eq!(outcome.fault, None, "{mismatch_percent} %");
        let statistics = outcome.run.trace.statistics();
        let rms_um = statistics.moving.truth.xy_um.rms();
        let settled_s = (outcome.run.moves.iter())
            .map(|one| one.settle_s().expect("settled"))
            .fold(0.0, f64::max);
        println!("{mismatch_percent} %: {rms_um} um rms, settled in {settled_s} s at the latest");
        assert!(
            rms_um < most_um && settled_s < most_s,
            "{mismatch_percent} %: {rms_um} um, {settled_s} s"
        );
    }
}
