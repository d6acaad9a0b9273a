//! Streamed targets and running waveforms by command. The bounds of `worst_jump`, a change of velocity in a tick, are what there is and
//! a tenth more.

mod gcs_bench;

use firmware::mode::Mode;
use gcs_bench::Bench;

fn say_all(bench: &mut Bench, lines: &[&str]) {
    for line in lines {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
}

/// The setpoint now: x and y, mm, and w, deg.
fn setpoint(bench: &Bench) -> [f64; 3] {
    let unit = 1.0 / 4_294_967_296.0;
    let [x, y, w] = bench.tick.now.setpoint.map(|units| units as f64 * unit);
    [x * 100.0, y * 100.0, w * 360.0]
}

/// Sends a target every `period` ticks, `count` of them; the setpoints at every tick.
fn stream(
    bench: &mut Bench,
    period: u64,
    count: u64,
    target: impl Fn(f64) -> [f64; 3],
) -> Vec<[f64; 3]> {
    let mut path = Vec::new();
    for i in 0..count {
        let [x, y, w] = target(i as f64 * period as f64 / 20_000.0);
        let line = format!("MOV X {x:.9} Y {y:.9} W {w:.9}\n");
        assert!(bench.offer(0, line.as_bytes()));
        for _ in 0..period {
            bench.run(1);
            path.push(setpoint(bench));
        }
    }
    path
}

/// From rest, into a circle of 10 mm whose speed grows for half a second, and out of it at 2.5 s.
fn circle(t: f64) -> [f64; 3] {
    let ramp = |t: f64| {
        let u = (t / 0.5).clamp(0.0, 1.0);
        0.5 * u * u * u * (1.0 - u / 2.0) + (t - 0.5).max(0.0)
    };
    let turn = ramp(t)
        - if t > 2.0 {
            t - 2.0 - 0.25 + ramp((2.5 - t).max(0.0))
        } else {
            0.0
        };
    let phase = 1.5 * turn * std::f64::consts::TAU;
    [10.0 - 10.0 * phase.cos(), 10.0 * phase.sin(), 30.0 * turn]
}

#[test]
fn cycle_times() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("SCT?\nSCT? T\n"), "T=10\nT=10\n");
    for (line, error) in [
        ("SCT", "24"),
        ("SCT T", "24"),
        ("SCT Q 1", "17"),
        ("SCT T 0.4", "17"),
        ("SCT T 101", "17"),
        ("SCT T 1", "0"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("SCT?\n"), "T=1\n");
}

#[test]
fn streamed_targets_are_followed_and_the_end_is_quiet() {
    for (ms, period) in [(5.0, 100), (1.0, 20)] {
        let mut bench = Bench::ready();
        say_all(&mut bench, &["SPA 1 0x19001900 1", &format!("SCT T {ms}")]);
        let path = stream(&mut bench, period, 60_000 / period, circle);
        // The same path, later: the latency is the same all along.
        let off = |late: usize| {
            let pairs = path[late..].iter().enumerate().step_by(97);
            pairs.fold(0.0f64, |worst, (tick, at)| {
                let wanted = circle(tick as f64 / 20_000.0);
                worst.max((at[0] - wanted[0]).hypot(at[1] - wanted[1]))
            })
        };
        let (late, least) = (0..30 * period as usize)
            .step_by(period as usize / 20)
            .map(|late| (late, off(late)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(least < 0.0050, "{ms} ms: {late} ticks late, {least} mm off");
        assert!(bench.tick.worst_jump < 4.9e-4, "{}", bench.tick.worst_jump);
        bench.run_to_rest();
        assert_eq!(bench.say("ERR?\n"), "0\n");
        let [x, y, w] = circle(3.0);
        for (axis, value) in [("X", x), ("Y", y), ("W", w)] {
            assert!((bench.value(&format!("POS? {axis}")) - value).abs() < 6.2e-8);
            assert!((bench.value(&format!("MOV? {axis}")) - value).abs() < 6.2e-8);
        }
        // And once more from there.
        let path = stream(&mut bench, period, 20, |_| [x, y, w]);
        assert!((path.last().unwrap()[0] - x).abs() < 6.2e-8);
    }
}

#[test]
fn a_stream_that_dries_up_stops_and_says_so() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    say_all(&mut bench, &["SPA 1 0x19001900 1", "SCT T 2"]);
    stream(&mut bench, 40, 500, circle);
    assert_eq!(bench.say("ERR?\n\x05"), "0\n23\n");
    bench.run_to_rest();
    for connection in [0, other] {
        assert_eq!(bench.say_to(connection, "ERR?\n"), "220\n");
    }
    assert!(bench.tick.worst_jump < 1.63e-3, "{}", bench.tick.worst_jump);
    assert!((bench.value("MOV? X") - bench.value("POS? X")).abs() < 7.9e-8);
    say_all(&mut bench, &["SPA 1 0x19001900 0", "MOV X 0 Y 0 W 0"]);
    bench.run_to_rest();
    assert!(bench.value("POS? X").abs() < 6.2e-8);
}

#[test]
fn a_stream_that_is_too_fast_loses_targets_and_says_so() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["SPA 1 0x19001900 1", "SCT T 100"]);
    let mut refused = 0;
    for i in 0..60 {
        match bench
            .error_after(&format!("MOV X {}", i as f64 * 1e-3))
            .as_str()
        {
            "0" => assert_eq!(refused, 0),
            "221" => refused += 1,
            other => panic!("{other}"),
        }
    }
    assert!(refused > 10 && refused < 40, "{refused}");
    // What was taken is carried out.
    bench.run(20_000);
    assert_eq!(bench.tick.now.mode, Mode::Moving);
}

#[test]
fn a_stream_that_asks_for_too_much_stops() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["SPA 1 0x19001900 1", "SCT T 10"]);
    assert_eq!(bench.error_after("MOV X 90"), "7");
    // A single target is a step as well, if nothing follows.
    assert_eq!(bench.error_after("MOV X 5"), "0");
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\nMOV? X\n"), "8\nX=0\n");
    // One so near that it is none is reached.
    assert_eq!(bench.error_after("MOV X 0.001"), "0");
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\nMOV? X\n"), "0\nX=0.001\n");
    stream(&mut bench, 200, 100, |t| {
        // A step of 5 mm in a hundredth of a second.
        [if t > 0.5 { 5.0 } else { 0.0 }, 0.0, 0.0]
    });
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\n"), "8\n");
    assert!(bench.tick.worst_jump < 8.3e-6, "{}", bench.tick.worst_jump);
}

#[test]
fn stops_and_jogs_in_a_stream() {
    for stop in ["HLT", "STP"] {
        let mut bench = Bench::ready();
        say_all(&mut bench, &["SPA 1 0x19001900 1", "SCT T 5"]);
        stream(&mut bench, 100, 200, circle);
        assert_eq!(bench.error_after("JOG W 10"), "89");
        assert_eq!(bench.error_after("SPA 1 0x19001900 0"), "53");
        assert_eq!(bench.error_after("SCT T 1"), "53");
        assert_eq!(bench.error_after("KEN ZERO"), "93");
        assert_eq!(bench.error_after(stop), "10");
        bench.run_to_rest();
        assert_eq!(bench.say("ERR?\n"), "0\n");
        assert!(bench.tick.worst_jump < 5.9e-3);
        let [at, target] = ["POS? X", "MOV? X"].map(|query| bench.value(query));
        assert!((at - target).abs() < 6.2e-8);
    }
}

/// Two waves that make a circle of 10 mm around (0, 0), once a second, and one that turns.
const CIRCLE: [&str; 6] = [
    "WAV 1 X SIN_P 1000 20 -10 1000 0 500",
    "WAV 2 X SIN_P 1000 20 -10 1000 250 500",
    "WAV 3 X RAMP 2000 40 -5 2000 0 200 1000",
    "WSL 1 1 2 2 6 3",
    "WTR 0 20 1",
    "WGC 1 3 2 3 6 1",
];

#[test]
fn waves_run_on_their_path_from_rest_to_rest() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &CIRCLE);
    say_all(&mut bench, &["WGO 1 1 2 1"]);
    assert_eq!(
        bench.say("\x09WGO?\n"),
        "3\n1=1 \n2=1 \n3=0 \n4=0 \n5=0 \n6=0\n"
    );
    for line in [
        "MOV X 1",
        "MVR W 1",
        "JOG W 1",
        "WGO 6 1",
        "WAV 1 X LIN 2 1 0 2 0 0",
        "WCL 3",
        "WTR 0 30 1",
    ] {
        assert_eq!(bench.error_after(line), "73", "{line}");
    }
    // First to where the waves begin.
    let start = [-10.0, 0.0];
    let mut off = 0.0f64;
    let mut turned = 0.0;
    let mut last: Option<f64> = None;
    let mut is_there = false;
    for _ in 0..100_000 {
        bench.run(1);
        let [x, y, _] = setpoint(&bench);
        is_there |= (x - start[0]).hypot(y - start[1]) < 1e-6;
        if is_there {
            off = off.max((x.hypot(y) - 10.0).abs());
            let angle = y.atan2(x);
            let step = angle - last.unwrap_or(angle);
            turned += step - std::f64::consts::TAU * (step / std::f64::consts::TAU).round();
            last = Some(angle);
        }
        if is_there && bench.tick.now.settled {
            break;
        }
    }
    assert!(off < 2.72e-5, "{off} mm off the circle");
    // Three cycles, but for the last point, which is the first.
    let turns = turned.abs() / std::f64::consts::TAU;
    assert!((turns - 2.999).abs() < 1e-10, "{turns}");
    assert_eq!(bench.say("\x09\x05ERR?\n"), "0\n0\n0\n");
    assert!(bench.tick.worst_jump < 2.2e-3, "{}", bench.tick.worst_jump);
    let [at, target] = ["POS? X", "MOV? X"].map(|query| bench.value(query));
    assert!((at - target).abs() < 6.2e-8);
}

#[test]
fn waves_without_end_are_stopped() {
    for stop in ["WGO 6 0", "HLT", "STP", "\x18"] {
        let mut bench = Bench::ready();
        say_all(&mut bench, &CIRCLE);
        say_all(&mut bench, &["WGC 1 0 2 0 6 0", "WGO 1 1 2 1 6 1"]);
        assert_eq!(bench.say("\x09"), "23\n");
        bench.run(150_000);
        assert_eq!(bench.say("\x09ERR?\n"), "23\n0\n");
        let error = if stop.starts_with('W') { "0" } else { "10" };
        assert_eq!(bench.error_after(stop), error, "{stop}");
        assert_eq!(bench.say("\x09"), "0\n");
        bench.run_to_rest();
        assert_eq!(bench.say("ERR?\n"), "0\n");
        assert!(bench.tick.worst_jump < 7.6e-3);
        say_all(&mut bench, &["MOV X 0 Y 0 W 0"]);
        bench.run_to_rest();
    }
}

#[test]
fn waves_that_can_not_be_are_refused() {
    let mut bench = Bench::new();
    say_all(
        &mut bench,
        &["WAV 1 X SIN_P 100 20 -10 100 0 50", "WSL 1 1"],
    );
    assert_eq!(bench.error_after("WGO 1 1"), "5");
    let mut bench = Bench::ready();
    say_all(
        &mut bench,
        &["WAV 1 X SIN_P 100 20 70 100 0 50", "WSL 1 1", "WTR 0 200 0"],
    );
    // It begins inside and goes out: that is met on the way.
    say_all(&mut bench, &["WGO 1 1"]);
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\n\x09"), "7\n0\n");
    say_all(&mut bench, &["WAV 1 X SIN_P 100 2 81 100 0 50"]);
    assert_eq!(bench.error_after("WGO 1 1"), "7");
    // Too fast: 40 mm in 5 ms.
    say_all(
        &mut bench,
        &["WAV 1 X SIN_P 100 40 0 100 0 50", "WTR 0 10 0", "WGO 1 1"],
    );
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\n\x09"), "8\n0\n");
    assert!(bench.tick.worst_jump < 2.2e-3, "{}", bench.tick.worst_jump);
    for line in ["WTR 0 9 0", "WTR 0 2001 0"] {
        assert_eq!(bench.error_after(line), "17", "{line}");
    }
}
