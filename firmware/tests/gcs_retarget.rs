//! Targets and stops by command at random ticks: the setpoint never steps, and the last target is reached exactly.

mod gcs_bench;

use firmware::mode::Mode;
use gcs_bench::Bench;

/// Largest change of velocity in a tick: an urgent stop brakes as hard as a pivot can, 300 rad/s^2 at 20 kHz, in rad/s.
const SMOOTH: f32 = 1.5e-2;

/// SplitMix64's sequence, a number below `n`.
fn random(state: &mut u64, n: u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) % n
}

#[test]
fn retargets_and_stops_at_any_tick() {
    let mut state = 20_260_214;
    for _ in 0..60 {
        let mut bench = Bench::ready();
        for _ in 0..12 {
            // Within a circle of 76 mm.
            let [x, y] = [0, 1].map(|_| random(&mut state, 1_080) as f64 / 10.0 - 54.0);
            let w = random(&mut state, 7_200) as f64 / 10.0 - 360.0;
            let line = match random(&mut state, 6) {
                0 => format!("MOV X {x}"),
                1 => format!("MOV W {w}"),
                2 => String::from("HLT"),
                3 => String::from("STP"),
                _ => format!("MOV X {x} Y {y} W {w}"),
            };
            let error = bench.error_after(&line);
            assert!(error == "0" || error == "10", "{line}: {error}");
            bench.run(random(&mut state, 2) * random(&mut state, 6_000));
        }
        let [x, y] = [0, 1].map(|_| random(&mut state, 1_080) as f64 / 10.0 - 54.0);
        assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W 12.5")), "0");
        bench.run_to_rest();
        for (axis, value) in [("X", x), ("Y", y), ("W", 12.5)] {
            let off = bench.value(&format!("POS? {axis}")) - value;
            assert!(off.abs() < 8.4e-8, "{axis} {off}");
        }
        assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
    }
}

#[test]
fn a_target_in_motion_is_taken_without_a_stop() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(3_000);
    bench.say("MOV X 70 Y 8\n");
    bench.run_to_rest();
    // A stop first would have been a third plan.
    assert_eq!(bench.tick.log, ["move", "move"]);
    assert!((bench.value("POS? X") - 70.0).abs() < 8.4e-8);
    assert!((bench.value("POS? Y") - 8.0).abs() < 8.4e-8);
}

#[test]
fn a_stop_of_a_transition_stands_still_where_it_says() {
    for stop in ["HLT", "STP"] {
        for wait in [0, 1, 30, 300, 2_000] {
            let mut bench = Bench::ready();
            bench.say("MOV X 60\n");
            bench.run(3_000);
            bench.say("MOV X 20 Y 30 W 90\n");
            bench.run(wait);
            assert_eq!(bench.error_after(stop), "10");
            bench.run_to_rest();
            assert_eq!(bench.tick.now.mode, Mode::Holding);
            for axis in ["X", "Y", "W"] {
                let (at, target) = (
                    bench.value(&format!("POS? {axis}")),
                    bench.value(&format!("MOV? {axis}")),
                );
                assert!(
                    (at - target).abs() < 8.4e-8,
                    "{stop} {wait} {axis}: {at} {target}"
                );
            }
            assert!(bench.value("POS? W") < 80.0, "{stop} {wait}");
            assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
        }
    }
}

#[test]
fn near_the_rim_it_stops_first() {
    let mut bench = Bench::ready();
    bench.say("MOV X 80\n");
    bench.run(8_000);
    assert!(bench.value("POS? X") > 70.0);
    bench.say("MOV X 70 Y 30\n");
    bench.run_to_rest();
    assert!((bench.value("POS? Y") - 30.0).abs() < 8.4e-8);
}

/// Off to the side and round: a target that is planned in slices.
const FAR: &str = "MOV X -30 Y 50 W 200\n";

/// In motion, and just sent there.
fn sent_far() -> Bench {
    let mut bench = Bench::ready();
    bench.say("MOV X 60 W 90\n");
    bench.run(3_000);
    bench.say(FAR);
    bench
}

#[test]
fn what_lies_ahead_takes_over_from_its_head() {
    let mut bench = sent_far();
    bench.run_to_rest();
    // The line, the head, and what goes on from it.
    assert_eq!(bench.tick.log, ["move", "move", "move"]);
    for (axis, value) in [("X", -30.0), ("Y", 50.0), ("W", 200.0)] {
        let off = bench.value(&format!("POS? {axis}")) - value;
        assert!(off.abs() < 8.4e-8, "{axis} {off}");
    }
    assert!(bench.tick.worst_jump < 6.92e-3, "{}", bench.tick.worst_jump);
}

/// A command side that is busy with something else, as with writing to flash: the stage comes to rest in the head, and
/// goes on.
#[test]
fn a_head_that_nothing_follows_comes_to_rest() {
    let mut bench = sent_far();
    bench.run(2);
    for _ in 0..6_000 {
        bench.tick.run();
    }
    assert_eq!(bench.tick.now.mode, Mode::Holding);
    assert_eq!(bench.tick.log, ["move", "move"]);
    bench.run_to_rest();
    assert!((bench.value("POS? Y") - 50.0).abs() < 8.4e-8);
    assert!(bench.tick.worst_jump < 6.92e-3, "{}", bench.tick.worst_jump);
}

/// While a head is under way: a stop, and a target that is refused, which changes nothing.
#[test]
fn in_a_head_commands_are_taken_as_ever() {
    let mut bench = sent_far();
    bench.run(20);
    assert_eq!(bench.error_after("MOV X 200"), "7");
    bench.run(60);
    bench.run_to_rest();
    assert!((bench.value("POS? Y") - 50.0).abs() < 8.4e-8);

    let mut bench = sent_far();
    bench.run(20);
    assert_eq!(bench.error_after("HLT"), "10");
    bench.run_to_rest();
    let [at, target] = ["POS? Y", "MOV? Y"].map(|ask| bench.value(ask));
    assert!((at - target).abs() < 8.4e-8 && at < 45.0, "{at} {target}");
}
