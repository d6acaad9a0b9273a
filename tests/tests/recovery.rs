//! `RCV`: a stage found out of its reach is driven back in, slowly, gently, and never further out.

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::External;
use kinematics::{Geometry, Pose, margins};
use tests::Bench;

/// Parameters: smallest angle between pivots, and the largest voltages of a motor, always and in recovery.
const SEPARATION_DEG: u32 = 0x5450_0203;
const LARGEST_VOLTAGE: u32 = 0x5450_080D;
const RECOVERY_VOLTAGE: u32 = 0x5450_080E;
/// Speed of the way, with what noise and rounding add.
const FASTEST_MM_S: f64 = 5.5;
/// Duty of 6 V of 48, PWM counts.
const MOST_COUNTS: i16 = 525;
/// By how much the measured pose may go further out than it was found: what the loop lets it, mm.
const OUTWARDS_MM: f64 = 0.01;

/// Poses out of reach, mm, mm and deg: out of the disk alone, short of a guide's start, beyond its end.
const OUTSIDE: [([f64; 3], &str); 3] = [
    ([82.0, 0.0, 71.5], "disk"),
    ([82.0, 0.0, 15.0], "start of a guide"),
    ([82.0, 0.0, 90.0], "end of a guide"),
];

/// A stage just switched on, with its platform left here (mm, mm, deg).
fn left_at([x, y, w]: [f64; 3]) -> Bench {
    let mut bench = Bench::new(&StageParameters::REFERENCE);
    let pose = [x / 1e3, y / 1e3, w.to_radians()];
    bench.rig.front.stage.plant.set_pose_at_rest(pose);
    bench.run(20);
    bench
}

/// Where the machine is: its distance from the middle, mm.
fn distance_mm(bench: &Bench) -> f64 {
    let [x, y, _] = bench.rig.front.stage.plant.pose();
    1e3 * x.hypot(y)
}

fn has_told(bench: &mut Bench, words: &str) -> bool {
    bench.say("EVT?\n").contains(words)
}

/// Runs until the recovery is over; all the way it is slow, gentle, and never further out than before.
fn run_to_end(bench: &mut Bench) {
    let mut nearest = distance_mm(bench);
    while bench.rig.interpreter.is_recovering() {
        bench.tick();
        assert_eq!(bench.fault(), None);
        let [vx, vy, _] = bench.rig.front.stage.plant.velocity();
        assert!(1e3 * vx.hypot(vy) < FASTEST_MM_S);
        assert!(
            bench
                .outputs
                .duty
                .iter()
                .all(|duty| duty.0.abs() <= MOST_COUNTS)
        );
        let now = distance_mm(bench);
        assert!(now < nearest + OUTWARDS_MM, "{now} {nearest}");
        nearest = nearest.min(now);
    }
}

#[track_caller]
fn assert_refused_where_it_was_left(bench: &mut Bench) {
    assert_eq!(bench.error_after("FRF"), "4003");
    assert_eq!(bench.mode(), Mode::Off);
}

#[track_caller]
fn assert_recovers(bench: &mut Bench) {
    assert_refused_where_it_was_left(bench);
    assert_eq!(bench.error_after("RCV 1"), "0");
    run_to_end(bench);
    assert!(has_told(bench, "recovered: in reach, held"));
    // With the limits of before: full voltage, and moves as fast as ever.
    assert_eq!(bench.mode(), Mode::Holding);
    assert_eq!(bench.error_after("FRF"), "0");
    assert_eq!(bench.error_after("MOV X 0 Y 0"), "0");
    bench.settle();
    assert_eq!(bench.say("RCV?\n"), "0\n");
    assert!(distance_mm(bench) < 0.01);
}

#[test]
fn a_stage_left_out_of_its_reach_comes_back() {
    for (pose, what) in OUTSIDE {
        let [x, y, w] = pose;
        let found = Pose {
            x: x / 100.0,
            y: y / 100.0,
            theta: w.to_radians(),
        };
        let room = margins(&Geometry::REFERENCE, &found).expect("a pose");
        let is_out = [
            room.disk < -0.005,
            room.guide_start < -0.005,
            room.guide_end < -0.005,
        ];
        let expected = ["disk", "start of a guide", "end of a guide"].map(|limit| limit == what);
        assert_eq!(is_out[1..], expected[1..], "{what}: {room:?}");
        assert!(is_out[0], "{what}");
        assert_recovers(&mut left_at(pose));
    }
}

#[test]
fn pivots_that_stand_too_close_come_apart() {
    let mut bench = left_at([79.3, 0.0, 90.0]);
    bench.set(&[(SEPARATION_DEG, 35.0)]);
    assert_recovers(&mut bench);
}

/// Asked for, and under way for a tenth of a second.
fn on_the_way(bench: &mut Bench) {
    assert_eq!(bench.error_after("RCV 1"), "0");
    bench.run_until("in motion", |bench| bench.mode() == Mode::Moving);
    bench.run(2_000);
    assert_eq!(bench.mode(), Mode::Moving);
}

#[track_caller]
fn assert_given_up(bench: &mut Bench) {
    run_to_end(bench);
    assert!(has_told(bench, "recovery has ended on its way, servo off"));
    assert!(distance_mm(bench) > 80.5, "{}", distance_mm(bench));
    assert_eq!(bench.say("RCV?\nSVO? X\n"), "0\nX=0\n");
    // As it was before: out of reach, and held by nothing but another recovery.
    assert_refused_where_it_was_left(bench);
    let is_referenced = bench.value("FRF? X") == 1.0;
    let servo_on = if is_referenced { "4003" } else { "0" };
    assert_eq!(bench.error_after("SVO X 1"), servo_on);
    assert_recovers(bench);
}

#[test]
fn a_stop_ends_it_with_the_servo_off() {
    for (stop, error) in [
        ("STP", "10"),
        ("\x18", "10"),
        ("HLT", "10"),
        ("RCV 0", "0"),
        ("SVO X 0", "0"),
    ] {
        let mut bench = left_at(OUTSIDE[0].0);
        on_the_way(&mut bench);
        assert_eq!(bench.error_after(stop), error, "{stop:?}");
        assert_given_up(&mut bench);
    }
    // Before the motion has begun, too.
    let mut bench = left_at(OUTSIDE[0].0);
    assert_eq!(bench.error_after("RCV 1\nSTP"), "10");
    assert_given_up(&mut bench);
}

#[test]
fn a_silent_client_ends_it() {
    let mut bench = left_at(OUTSIDE[0].0);
    bench.say("HBT 100\n");
    on_the_way(&mut bench);
    bench.run(2_100);
    bench.say("HBT 0\n");
    assert_given_up(&mut bench);
    // One that has to ask again and again, and does not: this long, and no longer.
    let mut bench = left_at(OUTSIDE[0].0);
    bench.say("JTM 150\n");
    on_the_way(&mut bench);
    assert_eq!(bench.error_after("RCV 1"), "0");
    bench.run(2_500);
    assert!(bench.rig.interpreter.is_recovering());
    bench.run(600);
    bench.say("JTM 0\n");
    assert_given_up(&mut bench);
}

#[test]
fn it_ends_with_its_connection() {
    let mut bench = left_at(OUTSIDE[0].0);
    on_the_way(&mut bench);
    bench.reconnect();
    assert_given_up(&mut bench);
}

#[test]
fn nothing_else_can_be_asked_of_it() {
    let mut bench = left_at(OUTSIDE[0].0);
    on_the_way(&mut bench);
    for line in [
        "MOV X 90",
        "MVR X 5",
        "JOG X 10",
        "FRF",
        "SVO X 1",
        "SPI R 1",
        "SPA 1 0x54500100 50",
        "RBT",
    ] {
        assert_eq!(
            bench.error_after(line),
            if line == "SPI R 1" { "93" } else { "53" },
            "{line}"
        );
    }
    assert_ne!(bench.say("\x05"), "0\n");
    run_to_end(&mut bench);
    // In reach there is nothing to recover, held or not.
    assert_eq!(bench.error_after("RCV 1"), "4004");
    bench.settle();
    assert_eq!(bench.error_after("SVO X 0\nRCV 1"), "4004");
    for (line, error) in [("RCV", "24"), ("RCV 2", "17"), ("RCV X 1", "25")] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
}

/// What stands in the way is pushed with no more than the voltage of recovery, and then it is a fault.
#[test]
fn an_obstacle_is_pushed_gently() {
    let mut bench = left_at(OUTSIDE[0].0);
    on_the_way(&mut bench);
    let mut external = External::default();
    external.force_n[0] = 400.0;
    bench.rig.front.stage.plant.set_external(external);
    bench.run_until("a fault", |bench| bench.fault().is_some());
    let kind = bench.fault_kind();
    assert!(
        matches!(kind, Some(FaultKind::FollowingError | FaultKind::Stalled)),
        "{kind:?}"
    );
    bench
        .rig
        .front
        .stage
        .plant
        .set_external(External::default());
    bench.run(2_000);
    assert_eq!(bench.say("RCV?\n"), "0\n");
    assert_eq!(bench.error_after("RCV 1"), "1024");
    bench.say("FLC\n");
    bench.run(4_000);
    assert_recovers(&mut bench);
}

/// The limit of voltage holds in ordinary motion too, and the integral does not wind up at it.
#[test]
fn the_voltage_limit_holds_and_winds_nothing_up() {
    let mut bench = Bench::ready();
    bench.set(&[(LARGEST_VOLTAGE, 6.0), (RECOVERY_VOLTAGE, 6.0)]);
    // Over the 8.6 N m of 6 V, for 4 ms.
    bench.push(12.0);
    let mut largest = 0;
    for _ in 0..80 {
        bench.tick();
        largest = bench
            .outputs
            .duty
            .map(|duty| duty.0.abs())
            .into_iter()
            .fold(largest, i16::max);
    }
    bench.push(0.0);
    assert_eq!((largest, bench.fault()), (MOST_COUNTS, None));
    bench.run(2_000);
    bench.forget_errors();
    bench.run(2_000);
    assert!(
        bench.worst_error_counts() < 10,
        "{}",
        bench.worst_error_counts()
    );
}

/// What the way back relies on: towards the middle, at the same orientation, no limit comes closer.
#[test]
fn on_the_way_back_all_margins_grow() {
    const ROUNDING: f64 = 1e-9;
    let room = |radius: f64, direction: f64, theta: f64| {
        let (x, y) = (radius * direction.cos(), radius * direction.sin());
        let room = margins(&Geometry::REFERENCE, &Pose { x, y, theta }).expect("a pose");
        // Far from a limit it may come closer; it stays far.
        let near = |margin: f64| margin.min(0.1);
        [
            room.disk,
            room.guide_start,
            room.guide_end,
            room.separation_rad,
        ]
        .map(near)
    };
    for (direction, theta) in (0..36).flat_map(|i| (0..24).map(move |k| (i, k))) {
        let (direction, theta) = (f64::from(direction) * 0.175, f64::from(theta) * 0.0873);
        let mut before = room(0.99, direction, theta);
        for step in 1..=60 {
            let now = room(0.99 - 0.005 * f64::from(step), direction, theta);
            let is_better = (0..4).all(|i| now[i] >= before[i] - ROUNDING);
            assert!(is_better, "{direction} {theta} {step}: {before:?} {now:?}");
            before = now;
        }
    }
}
