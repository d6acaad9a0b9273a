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
    // The stop does not begin: the way to the target takes its place at its first tick.
    assert_eq!(bench.tick.log, ["move", "move", "move"]);
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

/// In motion, and just sent somewhere else.
fn sent(elsewhere: &str) -> Bench {
    let mut bench = Bench::ready();
    bench.say("MOV X 60 W 90\n");
    bench.run(3_000);
    bench.say(elsewhere);
    bench
}

#[test]
fn a_sooner_way_takes_over_from_the_first() {
    let mut bench = sent("MOV X 58 Y 50\n");
    bench.run_to_rest();
    // The line, the stop, the first way, and a sooner one.
    assert_eq!(bench.tick.log, ["move"; 4]);
    for (axis, value) in [("X", 58.0), ("Y", 50.0), ("W", 90.0)] {
        let off = bench.value(&format!("POS? {axis}")) - value;
        assert!(off.abs() < 8.4e-8, "{axis} {off}");
    }
    assert!(bench.tick.worst_jump < 6.92e-3, "{}", bench.tick.worst_jump);
}

/// A command side that is busy with something else, as with writing to flash: the stage comes to rest in the stop that it
/// was sent first, and goes on.
#[test]
fn a_stop_that_nothing_follows_comes_to_rest() {
    let mut bench = sent("MOV X 20 Y 60 W 300\n");
    for _ in 0..6_000 {
        bench.tick.run();
    }
    assert_eq!(bench.tick.now.mode, Mode::Holding);
    assert_eq!(bench.tick.log, ["move", "move"]);
    bench.run_to_rest();
    assert!((bench.value("POS? Y") - 60.0).abs() < 8.4e-8);
    assert!(bench.tick.worst_jump < 6.92e-3, "{}", bench.tick.worst_jump);
}

/// Whoever stops a stage urgently finds it at rest, whatever comes after.
#[test]
fn what_comes_after_an_urgent_stop_waits_for_rest() {
    for command in ["MOV X -60", "JOG X -50"] {
        for wait in [0, 4, 20, 60, 200, 400] {
            let mut bench = Bench::ready();
            bench.say("MOV X 60\n");
            bench.run(3_000);
            assert_eq!(bench.error_after("STP"), "10");
            bench.run(wait);
            assert_eq!(bench.error_after(command), "0");
            let rests = (0..1_000).any(|_| {
                bench.run(1);
                bench.tick.now.mode == Mode::Holding
            });
            assert!(rests, "{command} {wait}");
            bench.run(2_000);
            assert_eq!(bench.tick.now.mode, Mode::Moving, "{command} {wait}");
        }
    }
}
