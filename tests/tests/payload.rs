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
    for mismatch_percent in [-20.0, 0.0, 20.0] {
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
        assert!(
            statistics.error_xy_um.rms() < 3.0,
            "{mismatch_percent} %: {} um",
            statistics.error_xy_um.rms()
        );
        for one in &outcome.run.moves {
            let settle_s = one.settle_s();
            assert!(
                settle_s.is_some_and(|s| s < 0.08),
                "{mismatch_percent} %, {:?}: {settle_s:?}",
                one.target
            );
        }
    }
}
