//! What is told of drives that are no more what their parameters say, and that nothing is told of those that are.

use hal_sim::machine::devices::EncoderFault;
use hal_sim::machine::plant::External;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;
use tests::trouble::PIVOT;

const COUNTS_PER_A: f64 = 1.0 / firmware::control::units::CURRENT_A_PER_COUNT;
/// Moves at full speed, of some seconds together, in which each pivot turns both ways for longer than a finding takes.
const ROUND: [&str; 4] = [
    "MOV X 40 Y 20 W 170",
    "MOV X -30 Y 40 W -60",
    "MOV X 20 Y -50 W 120",
    "MOV X 0 Y 0 W -170",
];
/// Rounds for one finding, and those after which a change has been told.
const FOR_ONE: usize = 2;
const FOR_ALL: usize = 8;
/// Bad frames in a row that may be bridged, in a test: more than are as it comes.
const BRIDGED: u32 = 10;

/// A machine that is as its parameters say, holding.
fn known() -> Bench {
    let mut bench = Bench::new(&stage_parameters(&RunOptions {
        mismatch_percent: 0.0,
        ..RunOptions::default()
    }));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench
}

fn go_round(bench: &mut Bench, times: usize) {
    for line in ROUND.iter().cycle().take(times * ROUND.len()) {
        bench.say(&format!("{line}\n"));
        bench.settle();
    }
}

/// What `EVT?` has of drives, without numbers and ticks.
fn told(bench: &mut Bench) -> Vec<String> {
    let events = bench.say("EVT?\n");
    let what = |line: &str| Some(line.trim_end().splitn(3, ' ').nth(2)?.to_owned());
    (events.lines().filter_map(what))
        .filter(|event| event.contains(", pivot"))
        .collect()
}

fn with_external(bench: &mut Bench, change: impl FnOnce(&mut External)) {
    let mut external = External::default();
    change(&mut external);
    bench.rig.front.stage.plant.set_external(external);
}

fn more_current(bench: &mut Bench, amperes: f64) {
    let inputs = bench.rig.front.stage.analog_inputs();
    inputs.current_offset_counts[PIVOT] += amperes * COUNTS_PER_A;
}

#[test]
fn a_weaker_motor_is_told_and_told_again_when_it_is_as_it_was() {
    let mut bench = known();
    assert_eq!(bench.drive_condition(PIVOT), None);
    go_round(&mut bench, FOR_ONE);
    let [ratio, offset_a, friction_n_m] = bench.drive_condition(PIVOT).expect("it has turned");
    println!("sound: {ratio}, {offset_a} A, {friction_n_m} N m");
    assert!((ratio - 1.0).abs() < 0.02 && offset_a.abs() < 0.1 && friction_n_m.abs() < 0.5);
    with_external(&mut bench, |external| external.lost_torque[PIVOT] = 0.07);
    go_round(&mut bench, FOR_ALL);
    assert_eq!(told(&mut bench), [""; 0]);
    with_external(&mut bench, |external| external.lost_torque[PIVOT] = 0.2);
    go_round(&mut bench, FOR_ALL);
    let weak =
        "motor constant 0.80 of its parameter: a weak motor, or the supply's sensor, pivot 2";
    assert_eq!(told(&mut bench), [weak]);
    // Half of the way back is not as it was.
    with_external(&mut bench, |external| external.lost_torque[PIVOT] = 0.07);
    go_round(&mut bench, FOR_ALL);
    assert_eq!(told(&mut bench), [weak]);
    with_external(&mut bench, |_| ());
    go_round(&mut bench, FOR_ALL);
    let again = "motor constant as its parameter says again, pivot 2";
    assert_eq!(told(&mut bench), [weak, again]);
    assert_eq!(bench.fault(), None);
    // Both survive a reset.
    bench.reset("the watchdog: the control loop or the command side stood still");
    bench.run(20);
    assert_eq!(told(&mut bench), [weak, again]);
}

#[test]
fn a_current_sensor_that_is_off_is_told() {
    let mut bench = known();
    more_current(&mut bench, 0.15);
    go_round(&mut bench, FOR_ALL);
    assert_eq!(told(&mut bench), [""; 0]);
    more_current(&mut bench, -0.75);
    go_round(&mut bench, FOR_ALL);
    let [ratio, offset_a, _] = bench.drive_condition(PIVOT).expect("it has turned");
    println!("0.6 A less: {ratio}, {offset_a} A");
    let told = told(&mut bench);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].starts_with("current sensor reads some -0."),
        "{told:?}"
    );
    assert!(
        told[0].ends_with("A besides what flows, pivot 2"),
        "{told:?}"
    );
    assert_eq!(bench.fault(), None);
}

#[test]
fn more_friction_is_told() {
    let mut bench = known();
    with_external(&mut bench, |external| {
        external.more_friction_n_m[PIVOT] = 0.8
    });
    go_round(&mut bench, FOR_ALL);
    assert_eq!(told(&mut bench), [""; 0]);
    with_external(&mut bench, |external| {
        external.more_friction_n_m[PIVOT] = 2.5
    });
    go_round(&mut bench, FOR_ALL);
    let told = told(&mut bench);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("friction 2."), "{told:?}");
    assert!(
        told[0].ends_with(" N m over its parameters, pivot 2"),
        "{told:?}"
    );
    assert_eq!(bench.fault(), None);
}

#[test]
fn a_loose_coupling_is_told_by_its_knocks() {
    let mut bench = known();
    go_round(&mut bench, FOR_ALL);
    assert_eq!(told(&mut bench), [""; 0]);
    with_external(&mut bench, |external| external.loose_rad[PIVOT] = 0.05e-3);
    let go_on = |bench: &mut Bench| {
        // With that play it does not settle.
        for line in ROUND {
            bench.say(&format!("{line}\n"));
            bench.run(12_000);
        }
    };
    go_on(&mut bench);
    let events = told(&mut bench);
    assert_eq!(events.len(), 1, "{events:?}");
    assert!(events[0].starts_with("5 knocks in 0."), "{events:?}");
    assert!(
        events[0].ends_with(" rad/s^2, pivot 2: a loose coupling, or something that strikes it"),
        "{events:?}"
    );
    // Once in ten seconds.
    go_on(&mut bench);
    assert_eq!(told(&mut bench), events);
    for _ in 0..4 {
        go_on(&mut bench);
    }
    let are_knocks = |event: &&String| event.contains("knocks");
    assert_eq!(told(&mut bench).iter().filter(are_knocks).count(), 2);
    assert_eq!(bench.fault(), None);
    // It survives a reset.
    bench.reset("the watchdog: the control loop or the command side stood still");
    bench.run(20);
    assert_eq!(told(&mut bench)[..1], events);
}

/// A reading that comes back from where bridged frames have led is no knock, however often.
#[test]
fn bridged_frames_are_no_knocks() {
    let mut bench = known();
    bench.set(&[(0x5450_0502, f64::from(BRIDGED))]);
    for line in ROUND.iter().cycle().take(8) {
        bench.send(&format!("{line}\n"));
        for _ in 0..20 {
            bench.rig.front.stage.encoders[PIVOT].set_fault(EncoderFault::StuckHigh);
            bench.run(BRIDGED);
            bench.rig.front.stage.encoders[PIVOT].set_fault(None);
            bench.run(200);
        }
        bench.settle();
    }
    let events = told(&mut bench);
    let is_bridged = |event: &String| event.contains("bad encoder frames bridged");
    assert!(
        !events.is_empty() && events.iter().all(is_bridged),
        "{events:?}"
    );
}

/// A motor that does not drive tells nothing: what was learnt in slow motion, and a hand that turns the platform with the servo off.
#[test]
fn nothing_is_said_of_a_stage_that_is_turned_by_hand() {
    let mut bench = known();
    more_current(&mut bench, 0.2);
    bench.say("JOG W 17\n");
    bench.run(20_000);
    bench.say("HLT\nERR?\n");
    bench.settle();
    assert_eq!(bench.error_after("SVO X 0"), "0");
    for turn in 0..12 {
        let way = if turn % 2 == 0 { 1.0 } else { -1.0 };
        for push in [4.0, 0.2, -4.0] {
            with_external(&mut bench, |external| {
                external.ring_torque_n_m = [way * push; 3];
            });
            bench.run(if push == 0.2 { 8_000 } else { 1_500 });
        }
        with_external(&mut bench, |_| ());
        bench.run(10_000);
    }
    let turned = bench.rig.front.stage.plant.pivot_rates_rad_s();
    println!("{turned:?} rad/s at last");
    assert_eq!(bench.drive_condition(PIVOT), None);
    assert_eq!(told(&mut bench), [""; 0]);
}

/// What was seen is not held against other parameters.
#[test]
fn other_parameters_begin_anew() {
    let mut bench = known();
    go_round(&mut bench, FOR_ONE);
    assert!(bench.drive_condition(PIVOT).is_some());
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    // Its resistance; the guides' friction.
    for line in ["SPA 1 0x54500802 2.2", "SPA 1 0x54500706 1"] {
        assert_eq!(bench.error_after(line), "0");
        assert_eq!(bench.drive_condition(PIVOT), None, "{line}");
        go_round(&mut bench, FOR_ONE);
        assert!(bench.drive_condition(PIVOT).is_some(), "{line}");
    }
}
