//! Iterative learning on the simulated machine: a move that is repeated is followed better each time, and never worse for long.

use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

const LEVEL: &str = "CCL 1 ADVANCED\n";
/// The motors' ripple as it is: 26 periods a motor turn behind a gear of 50.
const RIPPLE: &str = "SPA 1 0x54500A00 1300 1 0x54500A01 0.03\n";
const OUT: &str = "MOV X 30 Y 10 W 20\n";
const BACK: &str = "MOV X 0 Y 0 W 0\n";

fn machine(mismatch_percent: f64, told: &str) -> Bench {
    let mut bench = Bench::new(&stage_parameters(&RunOptions {
        mismatch_percent,
        ..RunOptions::default()
    }));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench.say(LEVEL);
    bench.say(told);
    there_and_back(&mut bench);
    bench
}

fn there_and_back(bench: &mut Bench) {
    for line in [OUT, BACK] {
        bench.say(line);
        bench.settle();
    }
}

/// Root mean square of the pivots' following errors over the way out, tick by tick, encoder counts.
fn way_out(bench: &mut Bench) -> f64 {
    bench.send(OUT);
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..5_000 {
        bench.tick();
        let sample = bench.sample();
        for (pivot, setpoint) in sample.pivots.iter().zip(&sample.pivot_setpoints) {
            let counts = (*pivot - *setpoint).units() as f64 / 64.0;
            sum += counts * counts;
            count += 1.0;
        }
    }
    bench.settle();
    bench.say(BACK);
    bench.settle();
    (sum / count).sqrt()
}

fn told(bench: &mut Bench, name: &str) -> String {
    let told = bench.say("ILC?\n");
    let line = (told.lines()).find(|line| line.starts_with(&format!("{name}=")));
    line.unwrap_or_else(|| panic!("{name} in {told:?}"))
        .to_owned()
}

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
        let mut bench = machine(mismatch, known);
        assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
        let errors: Vec<f64> = (0..6).map(|_| way_out(&mut bench)).collect();
        println!(
            "{mismatch} % {known:?}: {errors:.3?}, {}",
            told(&mut bench, "OUT")
        );
        // The first is the one without.
        assert!(errors[5] < most_counts, "{mismatch}: {errors:?}");
    }
}

/// A correction of the wrong size: a trial may be worse, the next one is not, and in the end none is.
#[test]
fn it_stops_where_it_grows() {
    // A model of the drive with a sixth of its inertia and resistance: the inverse is far from one.
    let mut bench = machine(20.0, "SPA 1 0x54500807 0.001 1 0x54500802 0.3\n");
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    let errors: Vec<f64> = (0..20).map(|_| way_out(&mut bench)).collect();
    println!("{errors:.3?}, {}", told(&mut bench, "OUT"));
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
    let mut bench = machine(20.0, "");
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    // Another one is to wait until that has its move.
    assert_eq!(bench.error_after("ILC LEARN BACK"), "1005");
    assert!(told(&mut bench, "OUT").starts_with("OUT=waiting TRIALS=0 "));
    there_and_back(&mut bench);
    there_and_back(&mut bench);
    assert!(told(&mut bench, "OUT").starts_with("OUT=learning TRIALS=2 "));
    // Another way to the same target.
    bench.say("VLS 100\n");
    there_and_back(&mut bench);
    assert!(told(&mut bench, "OUT").starts_with("OUT=learning TRIALS=2 "));
    bench.say("VLS 200\n");
    // A move that is broken off teaches nothing, and does no harm.
    bench.say(OUT);
    bench.run(2_000);
    bench.say("HLT\nERR?\n");
    bench.settle();
    bench.say(BACK);
    bench.settle();
    assert!(told(&mut bench, "OUT").starts_with("OUT=learning TRIALS=2 "));
    assert_eq!(bench.error_after("ILC FREEZE OUT"), "0");
    there_and_back(&mut bench);
    assert!(told(&mut bench, "OUT").starts_with("OUT=frozen TRIALS=2 "));
    assert_eq!(bench.error_after("ILC FREEZE BACK"), "17");
    assert_eq!(bench.error_after("ILC FORGET OUT"), "0");
    assert_eq!(bench.say("ILC?\n"), "\n");
    assert_eq!(bench.fault(), None);
}

/// A circle of 4 mm: half a second and the ways in and out of it.
#[test]
fn waves_learn_as_moves_do() {
    let mut bench = machine(20.0, "");
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
        errors.push(last_counts(&told(&mut bench, "CIRCLE")));
        bench.say("MOV X -2 Y 0\n");
        bench.settle();
    }
    println!("{errors:.3?}, {}", told(&mut bench, "CIRCLE"));
    // 8.37 and 0.50.
    assert!(errors[0] > 5.0 && errors[5] < 0.55, "{errors:?}");
    // Stopped in the middle it teaches nothing.
    bench.say("WGO 1 1 2 1\n");
    bench.run(4_000);
    bench.say("HLT\nERR?\n");
    bench.settle();
    let after = told(&mut bench, "CIRCLE");
    assert!(after.contains("TRIALS=6 "), "{after}");
    assert_eq!(bench.fault(), None);
}
