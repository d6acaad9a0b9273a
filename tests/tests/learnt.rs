//! What the servos learn: over a restart, used from the first move on; at the highest gain that is allowed; and where there is nothing
//! to be learnt.

use commissioning::tuning::IDENTIFIED_LEARNING;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::run::{RunOptions, controller_parameters, run_machine, stage_parameters};
use hal_sim::rig::script::Script;
use hal_sim::rig::{with_drives_told, with_ripple_told};
use tests::Bench;

const MOVES: [&str; 3] = [
    "MOV X 20 Y 5 W 30",
    "MOV X -20 Y -5 W -30",
    "MOV X 0 Y 0 W 0",
];

/// Largest following error of a pivot in the first of the moves, encoder counts, after a restart.
fn first_move(bench: &mut Bench) -> u64 {
    bench.reset("the watchdog: the control loop or the command side stood still");
    bench.run(20);
    bench.say("FLC\nFRF\n");
    bench.settle();
    bench.forget_errors();
    bench.say(&format!("{}\n", MOVES[0]));
    bench.settle();
    bench.worst_error_counts()
}

#[test]
fn the_first_move_after_a_restart_is_led_by_what_was_kept() {
    let mut bench = Bench::new(&stage_parameters(&RunOptions {
        mismatch_percent: 20.0,
        ..RunOptions::default()
    }));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    for line in MOVES.iter().cycle().take(6) {
        bench.say(&format!("{line}\n"));
        bench.settle();
    }
    let without = first_move(&mut bench);
    // Forgotten, but for what that move has taught: once more from the beginning.
    for line in MOVES.iter().cycle().take(6) {
        bench.say(&format!("{line}\n"));
        bench.settle();
    }
    assert_eq!(bench.error_after("WPA 100"), "0");
    let with = first_move(&mut bench);
    println!("without {without}, with {with} counts");
    // 421 and 184.
    assert!(with < 203 && without > 400, "{with} of {without}");
}

/// Highest value that the parameter may have.
const MOST: f64 = 1.0;

/// The slowest loop that there is: motors weaker by a third, all else heavier by as much, and a load that the controller does not know.
fn slowest_machine() -> RunOptions {
    RunOptions {
        mismatch_percent: 35.0,
        payload_kg: 5.0,
        ..RunOptions::default()
    }
}

/// What the controller knows of its machine.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    Nothing,
    Drives,
    DrivesAndRipple,
}

/// Root mean square of the pivots' following errors over the demonstration, encoder counts.
fn demonstration(learning: f64, options: &RunOptions, told: Told) -> f64 {
    let stage = stage_parameters(options);
    let mut parameters = controller_parameters(options);
    if told != Told::Nothing {
        parameters = with_drives_told(&parameters, &stage);
    }
    if told == Told::DrivesAndRipple {
        parameters = with_ripple_told(&parameters, &stage);
    }
    parameters.servo.learning = learning;
    let script = Script::demonstration().expect("it is a script");
    let outcome = run_machine(
        &script,
        &parameters,
        &stage,
        options,
        SettingsFlash::in_memory(),
    );
    assert_eq!(outcome.fault, None, "learning {learning}");
    outcome.run.facts().following_error.pivots_lsb.rms
}

/// Moves at full speed, again and again: the errors of the last ones are no larger than those of the first.
#[test]
fn the_highest_learning_that_is_allowed_is_stable_on_the_slowest_machine() {
    let mut bench = Bench::new(&stage_parameters(&slowest_machine()));
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    assert_eq!(bench.error_after(&format!("SPA 1 0x54500303 {MOST}")), "0");
    assert_eq!(bench.error_after("SPA 1 0x54500303 1.01"), "17");
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    let mut rounds = Vec::new();
    for _ in 0..8 {
        bench.forget_errors();
        for line in MOVES {
            bench.say(&format!("{line}\n"));
            bench.settle();
        }
        rounds.push(bench.worst_error_counts());
    }
    println!("{rounds:?} counts");
    assert_eq!(bench.fault(), None);
    assert!(
        rounds[7] <= rounds[1] && rounds[1] < rounds[0],
        "{rounds:?}"
    );
    let [without, with] =
        [0.0, MOST].map(|learning| demonstration(learning, &slowest_machine(), Told::Nothing));
    println!("demonstration: {without:.2} without, {with:.2} counts rms");
    assert!(with < 0.57 * without, "{with} of {without}");
}

/// A quarter of the highest learning is what an identified machine is given ([`hal_sim::rig::with_machine_told`]): it adds nothing where
/// there is nothing to be learnt.
#[test]
fn learning_adds_no_error_on_an_identified_machine() {
    for mismatch_percent in [0.0, 20.0] {
        let options = RunOptions {
            mismatch_percent,
            ..RunOptions::default()
        };
        let [without, with] = [0.0, IDENTIFIED_LEARNING]
            .map(|learning| demonstration(learning, &options, Told::DrivesAndRipple));
        println!("{mismatch_percent} %: {without:.3} without, {with:.3} counts rms");
        // 0.651 and 0.644; 0.703 and 0.694.
        assert!(with <= without, "{mismatch_percent} %: {with} of {without}");
    }
}

/// Where the motors' ripple is not told, learning answers to it: it makes the integral faster while the stage moves.
#[test]
fn learning_adds_next_to_nothing_where_ripple_alone_is_not_told() {
    for (mismatch_percent, most) in [(0.0, [1.0081, 1.0418]), (20.0, [1.0094, 1.0513])] {
        let options = RunOptions {
            mismatch_percent,
            ..RunOptions::default()
        };
        let [without, slow, with] = [0.0, IDENTIFIED_LEARNING, MOST]
            .map(|learning| demonstration(learning, &options, Told::Drives));
        println!(
            "{mismatch_percent} %: {without:.3} without, {slow:.3} at {IDENTIFIED_LEARNING}, {with:.3} counts rms"
        );
        assert!(
            slow < most[0] * without,
            "{mismatch_percent} %: {slow} of {without}"
        );
        assert!(
            with < most[1] * without,
            "{mismatch_percent} %: {with} of {without}"
        );
    }
}
