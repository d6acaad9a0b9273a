//! Constant velocities, and velocities of single axes, by command.

mod gcs_bench;

use firmware::mode::Mode;
use gcs_bench::Bench;

/// Largest change of velocity in a tick: 7,200 deg/s^2 at 20 kHz, in rad/s.
const SMOOTH: f32 = 6.5e-3;

fn say_all(bench: &mut Bench, lines: &[&str]) {
    for line in lines {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
}

/// The speed of an axis now, mm/s or deg/s, over a tenth of a second.
/// Two positions of seven decimals, 0.1 s apart, tell no more of a speed.
const SPEED_READ: f64 = 1.1e-6;

fn speed(bench: &mut Bench, axis: &str) -> f64 {
    let query = format!("POS? {axis}");
    let from = (bench.value(&query), bench.tick.now.tick);
    bench.run(2_000);
    let to = (bench.value(&query), bench.tick.now.tick);
    (to.0 - from.0) / (to.1 - from.1) as f64 * 20_000.0
}

#[test]
fn theta_turns_until_it_is_told_otherwise() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("JOG?\n"), "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n");
    say_all(&mut bench, &["JOG W 90"]);
    assert_eq!(bench.say("JOG? W\n\x05ONT? W\n"), "W=90\n20\nW=0\n");
    bench.run(6_000);
    assert!((speed(&mut bench, "W") - 90.0).abs() < SPEED_READ);
    // Faster, and back, without a stop.
    say_all(&mut bench, &["JOG W 300"]);
    bench.run(6_000);
    assert!((speed(&mut bench, "W") - 300.0).abs() < SPEED_READ);
    say_all(&mut bench, &["JOG W -45"]);
    bench.run(6_000);
    assert!((speed(&mut bench, "W") + 45.0).abs() < SPEED_READ);
    say_all(&mut bench, &["JOG W 0"]);
    assert_eq!(bench.say("JOG? W\n"), "W=0\n");
    bench.run_to_rest();
    let (at, target) = (bench.value("POS? W"), bench.value("MOV? W"));
    assert!((at - target).abs() < 5.6e-8, "{at} {target}");
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

#[test]
fn several_axes_at_once_each_for_itself() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["JOG W 60", "JOG X 5", "JOG Y -4"]);
    bench.run(4_000);
    assert_eq!(bench.say("JOG? X Y W\n\x05"), "X=5 \nY=-4 \nW=60\n23\n");
    for (axis, wanted) in [("X", 5.0), ("Y", -4.0), ("W", 60.0)] {
        assert!(
            (speed(&mut bench, axis) - wanted).abs() < SPEED_READ,
            "{axis}"
        );
    }
    // One stops, the others go on.
    say_all(&mut bench, &["JOG X 0"]);
    bench.run(4_000);
    for (axis, wanted) in [("X", 0.0), ("Y", -4.0), ("W", 60.0)] {
        assert!(
            (speed(&mut bench, axis) - wanted).abs() < SPEED_READ,
            "{axis}"
        );
    }
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

#[test]
fn stops_and_targets_end_a_jog() {
    for stop in ["HLT", "STP", "\x18"] {
        let mut bench = Bench::ready();
        say_all(&mut bench, &["JOG X 20 W 90"]);
        bench.run(4_000);
        assert_eq!(bench.error_after(stop), "10");
        assert_eq!(bench.say("JOG?\n").matches("=0").count(), 6);
        bench.run_to_rest();
        for axis in ["X", "W"] {
            let at = bench.value(&format!("POS? {axis}"));
            let target = bench.value(&format!("MOV? {axis}"));
            assert!(at > 3.0 && (at - target).abs() < 5.6e-8, "{stop} {axis}");
        }
    }
    // A target of one axis: the other comes to rest as soon as it can, and does not come back.
    let mut bench = Bench::ready();
    say_all(&mut bench, &["JOG W 90"]);
    bench.run(20_000);
    let turned = bench.value("POS? W");
    say_all(&mut bench, &["MOV X 10"]);
    assert_eq!(bench.say("JOG? W\n"), "W=0\n");
    bench.run_to_rest();
    let at = bench.value("POS? W");
    assert!(turned < at && at < turned + 10.0, "{turned} {at}");
    assert!((bench.value("POS? X") - 10.0).abs() < 5.6e-8);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

#[test]
fn a_jog_takes_over_from_a_move() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["MOV X 60"]);
    bench.run(3_000);
    // No velocity for what does not jog: the move goes on.
    say_all(&mut bench, &["JOG W 0"]);
    assert_eq!(bench.say("MOV? X\n"), "X=60\n");
    say_all(&mut bench, &["JOG W 30"]);
    bench.run(10_000);
    assert!(bench.value("POS? X") < 60.0);
    assert!((speed(&mut bench, "W") - 30.0).abs() < SPEED_READ);
    assert!(speed(&mut bench, "X").abs() < SPEED_READ);
}

#[test]
fn the_way_ends_before_the_edge() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["PLM X 30", "JOG X 50"]);
    bench.run_to_rest();
    let at = bench.value("POS? X");
    assert!((29.5..=30.0).contains(&at), "{at}");
    assert_eq!(bench.say("JOG? X\n"), "X=0\n");
    assert!((bench.value("MOV? X") - at).abs() < 5.6e-8);
    say_all(&mut bench, &["JOG Y -100"]);
    bench.run_to_rest();
    let [x, y] = ["X", "Y"].map(|axis| bench.value(&format!("POS? {axis}")));
    assert!(x.hypot(y) <= 80.0 && x.hypot(y) > 60.0, "{x} {y}");
}

#[test]
fn velocities_are_those_of_the_work_frame() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["KSW A W 90", "KEN A", "JOG X 10"]);
    bench.run(4_000);
    assert!((speed(&mut bench, "X") - 10.0).abs() < SPEED_READ);
    assert!(speed(&mut bench, "Y").abs() < SPEED_READ);
    assert!(bench.tick.now.setpoint[1] > 0);
}

#[test]
fn what_is_refused() {
    let mut bench = Bench::new();
    assert_eq!(bench.error_after("JOG W 1"), "5");
    let mut bench = Bench::ready();
    for (line, error) in [
        ("JOG", "24"),
        ("JOG W", "24"),
        ("JOG W fast", "25"),
        ("JOG Q 1", "15"),
        ("JOG W 1 W 2", "22"),
        ("JOG Z 1", "7"),
        ("JOG Z 0", "0"),
        ("JOG W 361", "8"),
        ("JOG X 201", "8"),
        ("JOG X 150 Y 150", "8"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert!(bench.tick.log.is_empty());
    // In motion too, and what is under way goes on.
    say_all(&mut bench, &["JOG W 40"]);
    bench.run(2_000);
    assert_eq!(bench.error_after("JOG X 150 Y 150"), "8");
    assert_eq!(bench.say("JOG? X W\n"), "X=0 \nW=40\n");
    bench.run(2_000);
    assert!((speed(&mut bench, "W") - 40.0).abs() < SPEED_READ);
}

#[test]
fn velocities_of_single_axes() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.say("VEL?\n"),
        "X=200 \nY=200 \nZ=0 \nU=0 \nV=0 \nW=360\n"
    );
    for (line, error) in [
        ("VEL X 201", "8"),
        ("VEL X 0", "8"),
        ("VEL W 400", "8"),
        ("VEL Z 1", "8"),
        ("VEL Z 0", "0"),
        ("VEL X 50 Y 201", "8"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("VEL? X Y\n"), "X=200 \nY=200\n");
    say_all(&mut bench, &["VEL X 20 W 30"]);
    assert_eq!(
        bench.say("VEL? X Y W\nVLS?\n"),
        "X=20 \nY=200 \nW=30\n200\n"
    );
    // Y is as slow as the line asks for: 40 to 20.
    let fastest = |bench: &mut Bench, line: &str| {
        say_all(bench, &[line]);
        let mut fastest = [0.0f64; 3];
        let unit = 100.0 / 4_294_967_296.0 * 20_000.0 / 20.0;
        while bench.tick.now.mode == Mode::Moving {
            let from = bench.tick.now.setpoint;
            bench.run(20);
            let to = bench.tick.now.setpoint;
            for i in 0..3 {
                let per_unit = if i == 2 { unit * 3.6 } else { unit };
                fastest[i] = fastest[i].max((to[i] - from[i]).abs() as f64 * per_unit);
            }
        }
        bench.run_to_rest();
        fastest
    };
    let [x, y, _] = fastest(&mut bench, "MOV X 20 Y 40");
    assert!(
        (x - 20.0).abs() < 1.4e-5 && (y - 40.0).abs() < 2.1e-6,
        "{x} {y}"
    );
    let [x, y, _] = fastest(&mut bench, "MOV Y -40");
    assert!(x == 0.0 && y > 150.0, "{y}");
    let [_, _, w] = fastest(&mut bench, "MOV W 20");
    assert!((w - 30.0).abs() < 1.6e-3, "{w}");
    assert_eq!(bench.error_after("JOG W 31"), "8");
    say_all(&mut bench, &["JOG W 30"]);
}
