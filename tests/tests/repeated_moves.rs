//! Iterative learning on the simulated machine: a move that is repeated is followed better each time, and never worse for long.

use tests::Bench;
use tests::repeated::{BACK, OUT};

/// The motors' ripple as it is: 26 periods a motor turn behind a gear of 50.
const RIPPLE: &str = "SPA 1 0x54500A00 1300 1 0x54500A01 0.03\n";

/// Of the last trial, as it is told: mean over each point's time.
fn last_counts(told: &str) -> f64 {
    let mut words = told
        .split(' ')
        .filter_map(|word| word.strip_prefix("LAST="));
    words
        .next()
        .and_then(|word| word.parse().ok())
        .expect("a number")
}

/// What a controller knows of a machine changes where it begins, not where it ends.
#[test]
fn after_five_trials_little_is_left() {
    for (mismatch, known, most_counts) in [
        (0.0, "", 1.0),
        (0.0, RIPPLE, 1.0),
        (20.0, "", 2.0),
        (-20.0, RIPPLE, 1.0),
    ] {
        let mut bench = Bench::repeating(mismatch, known);
        assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
        let errors: Vec<f64> = (0..6).map(|_| bench.way_out()).collect();
        println!(
            "{mismatch} % {known:?}: {errors:.3?}, {}",
            bench.table("OUT")
        );
        // The first is the one without.
        assert!(errors[5] < most_counts, "{mismatch}: {errors:?}");
    }
}

/// A correction of the wrong size: a trial may be worse, the next one is not, and in the end none is.
#[test]
fn it_stops_where_it_grows() {
    // A model of the drive with a sixth of its inertia and resistance: the inverse is far from one.
    let mut bench = Bench::repeating(20.0, "SPA 1 0x54500807 0.001 1 0x54500802 0.3\n");
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    let errors: Vec<f64> = (0..20).map(|_| bench.way_out()).collect();
    println!("{errors:.3?}, {}", bench.table("OUT"));
    let better = |pair: &[f64]| pair[1] < 1.05 * errors[0];
    assert!(
        errors
            .windows(2)
            .all(|pair| better(pair) || pair[0] < 1.05 * errors[0])
    );
    assert!(
        errors[16..].iter().all(|error| *error < 0.8 * errors[0]),
        "{errors:?}"
    );
    // 1.66 times at worst.
    assert!(
        errors.iter().all(|error| *error < 1.83 * errors[0]),
        "{errors:?}"
    );
}

#[test]
fn a_table_is_of_its_move_alone() {
    let mut bench = Bench::repeating(20.0, "");
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    // Another one is to wait until that has its move.
    assert_eq!(bench.error_after("ILC LEARN BACK"), "1005");
    assert!(bench.table("OUT").starts_with("OUT=waiting TRIALS=0 "));
    bench.there_and_back();
    bench.there_and_back();
    assert!(bench.table("OUT").starts_with("OUT=learning TRIALS=2 "));
    // Another way to the same target.
    bench.say("VLS 100\n");
    bench.there_and_back();
    assert!(bench.table("OUT").starts_with("OUT=learning TRIALS=2 "));
    bench.say("VLS 200\n");
    // A move that is broken off teaches nothing, and does no harm.
    bench.say(OUT);
    bench.run(2_000);
    bench.say("HLT\nERR?\n");
    bench.settle();
    bench.say(BACK);
    bench.settle();
    assert!(bench.table("OUT").starts_with("OUT=learning TRIALS=2 "));
    assert_eq!(bench.error_after("ILC FREEZE OUT"), "0");
    bench.there_and_back();
    assert!(bench.table("OUT").starts_with("OUT=frozen TRIALS=2 "));
    assert_eq!(bench.error_after("ILC FREEZE BACK"), "17");
    assert_eq!(bench.error_after("ILC FORGET OUT"), "0");
    assert_eq!(bench.say("ILC?\n"), "\n");
    assert_eq!(bench.fault(), None);
}

/// A circle of 4 mm: half a second and the ways in and out of it.
#[test]
fn waves_learn_as_moves_do() {
    let mut bench = Bench::repeating(20.0, "");
    bench.say("WAV 1 X SIN_P 500 4 -2 500 0 250\nWAV 2 X SIN_P 500 4 -2 500 125 250\n");
    bench.say("WSL 1 1 2 2\nWGC 1 1 2 1\nWTR 1 20 1\n");
    // To where it begins: the next motion is the wave itself.
    let run = |bench: &mut Bench| {
        bench.say("WGO 1 1 2 1\n");
        bench.settle();
    };
    run(&mut bench);
    bench.say("MOV X -2 Y 0\n");
    bench.settle();
    assert_eq!(bench.error_after("ILC LEARN CIRCLE"), "0");
    let mut errors = Vec::new();
    for _ in 0..6 {
        run(&mut bench);
        errors.push(last_counts(&bench.table("CIRCLE")));
        bench.say("MOV X -2 Y 0\n");
        bench.settle();
    }
    println!("{errors:.3?}, {}", bench.table("CIRCLE"));
    // 8.37 and 0.50.
    assert!(errors[0] > 5.0 && errors[5] < 0.55, "{errors:?}");
    // Stopped in the middle it teaches nothing.
    bench.say("WGO 1 1 2 1\n");
    bench.run(4_000);
    bench.say("HLT\nERR?\n");
    bench.settle();
    assert!(bench.table("CIRCLE").contains("TRIALS=6 "));
    assert_eq!(bench.fault(), None);
}
