//! What the servos learn, over a restart: used from the first move on.

use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

const MOVES: [&str; 3] = [
    "MOV X 20 Y 5 W 30",
    "MOV X -20 Y -5 W -30",
    "MOV X 0 Y 0 W 0",
];

/// Largest following error of a pivot in the first of the moves, encoder counts, after a restart.
fn first_move(bench: &mut Bench) -> u64 {
    bench.reset("the watchdog: the control loop stood still");
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
    // 452 and 245.
    assert!(with < 270 && without > 400, "{with} of {without}");
}
