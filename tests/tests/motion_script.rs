//! The script that shows what the motion layer does: every line of it is taken, and it ends at home.

use std::path::Path;

use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;

#[test]
fn every_line_of_the_motion_script_is_carried_out() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hal-sim/scripts/motion.gcs");
    let script = Script::read(&path).expect("a good script");
    let outcome = run(&script, &RunOptions::default());
    println!("{}", outcome.run.summary());
    assert_eq!(outcome.fault, None);
    // A line that is refused ends the run before the last one, which asks where the stage is.
    let (asked, _) = outcome.answers.last().expect("an answer");
    assert_eq!(asked, "POS?");
    let last = outcome.run.moves.last().expect("it moves");
    assert!(
        last.target[0].hypot(last.target[1]) < 1e-3,
        "{:?}",
        last.target
    );
}
