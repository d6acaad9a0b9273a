//! Motion by command: moves, retargets, stops, waits, and what the connections see of them meanwhile.

mod gcs_bench;

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::queues::{COMMAND_SLOTS, Command};
use gcs_bench::Bench;

/// Largest change of velocity in a tick: 7,200 deg/s^2 at 20 kHz, in rad/s.
const SMOOTH: f32 = 6.5e-3;
/// The same of the urgent stops here, and a tenth more. A pivot's 300 rad/s^2 are 15e-3, and x makes 1 track radius a second or less
/// of a
/// pivot's 1 rad/s.
const HARD: f32 = 9.8e-3;

#[test]
fn a_move_and_its_signs() {
    let mut bench = Bench::ready();
    // In one segment: the query is not answered before the move has reached the tick.
    assert_eq!(bench.say("MOV X 12.5\nONT? X Z\n\x05"), "X=0 \nZ=1\n1\n");
    assert_eq!(bench.say("MOV? X\nERR?\n"), "X=12.5\n0\n");
    bench.run_to_rest();
    assert_eq!(bench.say("ONT? X\n\x05"), "X=1\n0\n");
    assert!((bench.value("POS? X") - 12.5).abs() < 6.5e-8);
    assert_eq!(bench.tick.log, ["move"]);
}

#[test]
fn the_moving_mask_has_no_hexadecimal_letters() {
    for (line, mask) in [
        ("MOV X 1", "1"),
        ("MOV Y 1", "2"),
        ("MOV X 1 Y 1", "3"),
        ("MOV W 1", "20"),
        ("MOV X 1 W 1", "21"),
        ("MOV Y 1 W 1 Z 0", "22"),
        ("MOV X 1 Y 1 W 1", "23"),
        ("MOV X 0 W 1", "20"),
        ("MOV X 0 Z 0", "0"),
    ] {
        let mut bench = Bench::ready();
        assert_eq!(
            bench.say(&format!("{line}\n\x05")),
            format!("{mask}\n"),
            "{line}"
        );
    }
}

#[test]
fn the_mask_is_there_until_settled() {
    let mut bench = Bench::ready();
    bench.say("MOV X 0.01\n");
    while bench.tick.now.mode == Mode::Moving {
        assert_eq!(bench.say("\x05"), "1\n");
    }
    assert!(!bench.tick.now.settled);
    assert_eq!(bench.say("\x05"), "1\n");
    bench.run(2 * gcs_bench::DWELL);
    assert_eq!(bench.say("\x05"), "0\n");
}

#[test]
fn theta_keeps_its_turns() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("MOV W 370"), "0");
    bench.run_to_rest();
    assert!((bench.value("POS? W") - 370.0).abs() < 1.0e-8);
    assert_eq!(bench.error_after("MVR W -1090"), "0");
    bench.run_to_rest();
    assert!((bench.value("POS? W") + 720.0).abs() < 1.0e-8);
    assert_eq!(bench.say("MOV? W\n"), "W=-720\n");
    assert_eq!(bench.error_after("MOV W 3600000.001"), "7");
    assert_eq!(bench.error_after("MOV W 3600000"), "0");
}

#[test]
fn a_move_is_all_or_nothing() {
    let mut bench = Bench::ready();
    for line in [
        "MOV X 80.001",
        "MOV X 10 Y -81",
        "MOV X 60 Y 60",
        "MOV X 1 Y 2 W 4e6",
        "MVR X 90",
        "MOV X 1e300",
    ] {
        assert_eq!(bench.error_after(line), "7", "{line}");
        assert_eq!(bench.say("MOV? X Y W\n"), "X=0 \nY=0 \nW=0\n", "{line}");
    }
    assert!(bench.tick.log.is_empty());
    for line in ["MOV X 80", "MOV X 0 Y -80", "MOV X 48 Y 64"] {
        assert_eq!(bench.error_after(line), "0", "{line}");
        bench.run_to_rest();
    }
}

#[test]
fn relative_moves_add_to_the_last_target() {
    let mut bench = Bench::ready();
    bench.say("MVR X 1.5\nMVR X 1.5 W -2\n");
    assert_eq!(bench.say("MOV? X W\n"), "X=3 \nW=-2\n");
    bench.run_to_rest();
    assert!((bench.value("POS? X") - 3.0).abs() < 6.5e-8);
    assert!((bench.value("POS? W") + 2.0).abs() < 6.5e-8);
}

#[test]
fn a_move_in_motion_retargets_without_a_jump() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(1_000);
    assert_eq!(bench.error_after("MOV X -10 W 90"), "0");
    assert_eq!(bench.say("\x05MOV? X\n"), "21\nX=-10\n");
    // And again, before that is under way.
    bench.run(20);
    assert_eq!(bench.error_after("MOV X -20"), "0");
    bench.run_to_rest();
    assert!((bench.value("POS? X") + 20.0).abs() < 6.5e-8);
    assert!((bench.value("POS? W") - 90.0).abs() < 6.5e-8);
    // The line; a stop and the way that takes its place for each of the targets; and a sooner way to the second.
    assert_eq!(bench.tick.log, ["move"; 6]);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

#[test]
fn a_bad_move_in_motion_changes_nothing() {
    let mut bench = Bench::ready();
    bench.say("MOV X 20\n");
    bench.run(500);
    assert_eq!(bench.error_after("MOV X 200"), "7");
    bench.run_to_rest();
    assert!((bench.value("POS? X") - 20.0).abs() < 6.5e-8);
    assert_eq!(bench.tick.log, ["move"]);
}

#[test]
fn a_halt_is_smooth_and_a_stop_is_shorter() {
    let mut ways = Vec::new();
    for stop in ["HLT\n", "HLT X\n", "STP\n", "\x18", "\x18\n"] {
        let mut bench = Bench::ready();
        bench.say("MOV X 60\n");
        bench.run(3_000);
        let from = bench.value("POS? X");
        assert_eq!(bench.say(&format!("{stop}ERR?\n")), "10\n", "{stop:?}");
        bench.run_to_rest();
        let to = bench.value("POS? X");
        assert!(to < 50.0, "{stop:?}");
        // The target is where it stands now.
        assert!((bench.value("MOV? X") - to).abs() < 6.5e-8, "{stop:?}");
        assert_eq!(bench.tick.log, ["move", "move"]);
        assert!(bench.tick.worst_jump < HARD, "{}", bench.tick.worst_jump);
        ways.push(to - from);
    }
    let [halt, halt_x, stop, single, _] = ways[..] else {
        unreachable!()
    };
    assert_eq!(halt, halt_x);
    assert!(stop < 0.458 * halt, "{stop} {halt}");
    assert!(stop == single);
}

#[test]
fn a_stop_overrides_a_halt_and_a_pending_move() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(3_000);
    bench.say("MOV X -60\nHLT\nSTP\n");
    bench.run_to_rest();
    let at = bench.value("POS? X");
    assert!(at > 1.0 && at < 59.0, "{at}");
    bench.run(1_000);
    assert_eq!(bench.value("POS? X"), at);
    assert_eq!(bench.say("\x05"), "0\n");
}

#[test]
fn a_stop_overrides_a_halt_that_is_on_its_way() {
    let mut ways = Vec::new();
    for stop in ["HLT\n", "STP\n", "HLT\nSTP\n"] {
        let mut bench = Bench::ready();
        bench.say("MOV X 60\n");
        bench.run(3_000);
        let from = bench.value("POS? X");
        bench.say(stop);
        bench.run_to_rest();
        ways.push(bench.value("POS? X") - from);
    }
    assert!(ways[1] < ways[2] && ways[2] < 0.459 * ways[0], "{ways:?}");
}

#[test]
fn stops_at_rest_do_nothing_and_say_nothing() {
    let mut bench = Bench::ready();
    for stop in ["HLT", "STP", "\x18"] {
        assert_eq!(bench.error_after(stop), "0");
    }
    assert!(bench.tick.log.is_empty());
    assert_eq!(bench.error_after("MOV X 1"), "0");
    assert_eq!(bench.tick.log, ["move"]);
}

#[test]
fn a_stop_at_any_instant_comes_to_rest() {
    // The start, each segment, the last tick, and after it; a stop that is late for its splice is planned again.
    for wait in [
        0, 1, 2, 7, 40, 150, 400, 1_200, 1_560, 1_580, 1_590, 1_600, 1_610, 1_650,
    ] {
        let mut bench = Bench::ready();
        bench.offer(0, b"MOV X 10\n");
        bench.run(wait);
        assert_eq!(bench.error_after("HLT"), "10");
        bench.run_to_rest();
        assert_eq!(bench.error_after("MOV X 3"), "0", "{wait}");
        bench.run_to_rest();
        assert!((bench.value("POS? X") - 3.0).abs() < 6.5e-8, "{wait}");
        assert!(bench.tick.worst_jump < 2.2e-3, "{}", bench.tick.worst_jump);
    }
}

#[test]
fn a_stop_too_late_for_its_splice_is_planned_again() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(1_000);
    // The command side was away: its snapshot is of a past that the splice lies in.
    for _ in 0..60 {
        bench.tick.run();
    }
    assert_eq!(bench.error_after("HLT"), "10");
    bench.run_to_rest();
    assert_eq!(bench.tick.log, ["move", "refused", "move"]);
    assert!(bench.value("POS? X") < 50.0);
}

#[test]
fn servo_off_stops_the_motion_on_its_path_before_it_lets_go() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MOV X 60\n");
    bench.run(1_000);
    bench.say("MOV X -60\n");
    assert_eq!(bench.say_to(other, "SVO X 0\nERR?\n"), "0\n");
    // Still on, still on its path, and it takes nothing else.
    assert_eq!(bench.say("SVO? X\n"), "X=1\n");
    assert_ne!(bench.say("\x05"), "0\n");
    // The mover is told, once.
    assert_eq!(bench.say("ERR?\nERR?\n"), "10\n0\n");
    assert_eq!(bench.error_after("MOV X 1"), "5");
    bench.run_to_rest();
    bench.run(3);
    assert_eq!(
        bench.say("SVO?\n\x05"),
        "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n0\n"
    );
    assert_eq!(bench.tick.log.last(), Some(&"off"));
    // What the hardest stop makes of a tick, and no more: 14,400 deg/s^2.
    assert!(bench.tick.worst_jump < 0.0127, "{}", bench.tick.worst_jump);
    assert_eq!(bench.error_after("MOV X 1"), "5");
    bench.say("SVO X 1 Y 1 W 1\n");
    let at = bench.value("POS? X");
    assert!((bench.value("MOV? X") - at).abs() < 6.5e-8);
    bench.run_to_rest();
    assert!((bench.value("POS? X") - at).abs() < 6.5e-8);
}

#[test]
fn servo_is_one_for_all_axes_and_off_wins() {
    for (line, on) in [
        ("SVO X 0", 0.0),
        ("SVO X 0 Y 1", 0.0),
        ("SVO X 1 Y 0", 0.0),
        ("SVO W 0 Z 1", 0.0),
        ("SVO X 1 Z 0", 1.0),
    ] {
        let mut bench = Bench::ready();
        assert_eq!(bench.error_after(line), "0");
        assert_eq!(bench.value("SVO? Y"), on, "{line}");
    }
}

#[test]
fn a_fault_drops_what_was_pending() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(1_000);
    bench.say("MOV X -60\n");
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    bench.run(1);
    assert_eq!(bench.say("\x05ERR?\n"), "1\n1024\n");
    // What the motors have let go of goes on, and is shown as motion until it rests.
    bench.run_to_rest();
    let at = bench.value("POS? X");
    bench.run(100);
    assert!((bench.value("POS? X") - at).abs() < 1e-6);
    bench.say("FLC\nSVO X 1\n");
    bench.run(5_000);
    assert_eq!(bench.say("\x05ERR?\n"), "0\n0\n");
    assert!((bench.value("POS? X") - at).abs() < 1e-6);
}

#[test]
fn a_fault_is_shown_as_motion_for_long_enough_to_be_asked_for() {
    let mut bench = Bench::ready();
    bench.run(1_000);
    bench.say("MOV X 1\n");
    while bench.tick.now.mode != Mode::Holding {
        bench.run(1);
    }
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    // 100 ms, though the stage rests at once: clients ask for errors only while something moves.
    bench.run(1_990);
    assert_eq!(bench.say("\x05ERR?\n"), "1\n1024\n");
    bench.run(20);
    assert_eq!(bench.say("\x05"), "0\n");
    // A fault at rest ends no motion.
    bench.say("FLC\nSVO X 1\n");
    bench.run(1_000);
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    bench.run(1);
    assert_eq!(bench.say("\x05"), "0\n");
}

#[test]
fn velocity_scales_all_of_a_move() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("VLS?\nVLS 20\nVLS?\nERR?\n"), "200\n20\n0\n");
    bench.say("MOV X 40 W 720\n");
    bench.run(20_000);
    // A tenth of 360 deg/s.
    let w = bench.value("POS? W");
    assert!((w - 36.0).abs() < 0.276, "{w}");
}

/// How fast a move is at its fastest, deg/s.
fn peak_deg_s(bench: &mut Bench, line: &str) -> f64 {
    bench.say(line);
    let mut peak = 0.0_f64;
    while bench.say("\x05") != "0\n" {
        let before = bench.tick.now.setpoint[2];
        bench.run(20);
        let turns = (bench.tick.now.setpoint[2] - before) as f64 / 4_294_967_296.0;
        peak = peak.max(turns.abs() * 360.0 / 1e-3);
    }
    peak
}

#[test]
fn velocity_of_a_move_that_only_turns_is_in_degrees() {
    let mut bench = Bench::ready();
    // As the parameters have it until somebody says otherwise.
    let peak = peak_deg_s(&mut bench, "MOV W 360\n");
    assert!((peak - 360.0).abs() < 0.4, "{peak}");
    for (velocity, expected) in [(90.0, 90.0), (200.0, 200.0), (20.0, 20.0)] {
        bench.say(&format!("VLS {velocity}\n"));
        let target = 360.0 + velocity;
        let peak = peak_deg_s(&mut bench, &format!("MOV W {target}\n"));
        assert!((peak - expected).abs() < 0.4, "{velocity}: {peak}");
        // A new target in the middle keeps to it too.
        bench.say("MOV W 0\n");
        bench.run(4_000);
        let peak = peak_deg_s(&mut bench, &format!("MOV W {}\n", -velocity));
        assert!((peak - expected).abs() < 0.4, "{velocity}: {peak}");
        assert_eq!(bench.say("VLS?\n"), format!("{velocity}\n"));
    }
    // Under its own limit all the same.
    assert_eq!(bench.error_after("VEL W 10\nMOV W 0"), "0");
    bench.run_to_rest();
    let peak = peak_deg_s(&mut bench, "MOV W 20\n");
    assert!((peak - 10.0).abs() < 0.4, "{peak}");
}

#[test]
fn delays_hold_lines_and_not_bytes() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("DEL 10\nMOV? X\n\x04"), "65536\n");
    assert_eq!(bench.say("\x07CSV?\n"), "\u{B0}\n");
    bench.run(150);
    assert_eq!(bench.answers_of(0), b"");
    bench.run(50);
    assert_eq!(bench.answers_of(0), b"X=0\n2.0\n");
    assert_eq!(bench.say("\x07"), "\u{B1}\n");
}

#[test]
fn waiting_for_a_condition() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MOV X 10\nWAC ONT? X = 1\nMOV Y 5\nWAC POS? Y>=2.5\nPOS? Y\n");
    // Other connections are served meanwhile.
    assert_eq!(bench.say_to(other, "CSV?\n"), "2.0\n");
    assert_eq!(bench.tick.log, ["move"]);
    bench.run(10_000);
    assert_eq!(bench.tick.log, ["move", "move"]);
    let answer = String::from_utf8(bench.answers_of(0)).unwrap();
    let y: f64 = answer.trim_start_matches("Y=").trim_end().parse().unwrap();
    assert!((2.5..2.6).contains(&y), "{answer}");
    assert!(bench.session(0).is_idle());
}

#[test]
fn a_stop_ends_scripts_on_every_connection() {
    for (number, stop) in [(0, "\x18"), (1, "\x18"), (1, "STP\n")] {
        let mut bench = Bench::ready();
        let other = bench.connect();
        assert_eq!(other, 1);
        bench.say("MOV X 10\nWAC ONT? X = 1\nMOV Y 5\nMOV Y 6\nMOV Y 7");
        bench.say_to(number, stop);
        bench.run(10_000);
        // The rest of the line that was cut off is no command either.
        assert_eq!(bench.say("0\nERR?\n"), "10\n");
        assert_eq!(bench.value("MOV? Y"), 0.0);
        assert_eq!(bench.tick.log, ["move", "move"]);
    }
}

#[test]
fn a_fault_ends_a_wait() {
    let mut bench = Bench::ready();
    bench.say("MOV X 10\nWAC POS? X > 50\nMOV Y 5\n");
    bench.tick.fail(FaultKind::EncoderSilent, Some(2));
    assert_eq!(bench.say("ERR?\n"), "1024\n");
    assert!(bench.session(0).is_idle());
}

#[test]
fn a_full_input_is_offered_again() {
    let mut bench = Bench::ready();
    bench.say("DEL 1\n");
    let lines = "MVR X 0.001\n".repeat(200);
    let mut rest = lines.as_bytes();
    let taken = bench.session(0).receive(rest);
    assert!(taken < rest.len());
    rest = &rest[taken..];
    let mut ticks = 0;
    while !rest.is_empty() {
        let taken = bench.session(0).receive(rest);
        rest = &rest[taken..];
        bench.run(1);
        ticks += 1;
        assert!(ticks < 10_000, "stuck");
    }
    bench.run_to_rest();
    assert_eq!(bench.say("ERR?\n"), "0\n");
    let x = bench.value("MOV? X");
    assert!((x - 0.2).abs() < 1e-12, "{x}");
}

#[test]
fn a_full_queue_is_an_error_and_changes_nothing() {
    let mut bench = Bench::ready();
    for _ in 1..COMMAND_SLOTS {
        bench.queues.send(Command::Acknowledge).unwrap();
    }
    bench.offer(0, b"MOV X 1\nERR?\nSVO X 0\nERR?\nMOV? X\n\x05");
    assert_eq!(bench.answers_of(0), b"1005\n1005\nX=0\n0\n");
}

/// An output that is gone.
struct Broken;

impl embedded_io::ErrorType for Broken {
    type Error = embedded_io::ErrorKind;
}

impl embedded_io::Write for Broken {
    fn write(&mut self, _: &[u8]) -> Result<usize, Self::Error> {
        Err(embedded_io::ErrorKind::BrokenPipe)
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

#[test]
fn write_errors_come_back_and_the_rest_goes_on() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    for query in ["CSV?\n", "POS?\n", "HLP?\n", "\x05", "\x07"] {
        bench.session(0).receive(query.as_bytes());
        let result = bench.service_into(&mut Broken);
        assert_eq!(result, Err(embedded_io::ErrorKind::BrokenPipe), "{query:?}");
    }
    assert_eq!(bench.say_to(other, "CSV?\n"), "2.0\n");
}

#[test]
fn a_slow_panel_looks_further_ahead() {
    let mut bench = Bench::ready();
    bench.say("MOV X 60\n");
    bench.run(1_000);
    for round in 0..10 {
        // The snapshot that waits is 59 ticks old, older than the first look-ahead.
        for _ in 0..60 {
            bench.tick.run();
        }
        bench.offer(0, if round == 0 { b"HLT\n" } else { b"" });
    }
    bench.run_to_rest();
    assert_eq!(bench.tick.log, ["move", "refused", "move"]);
}

#[test]
fn a_move_after_a_stop_starts_from_where_it_stops() {
    for stop in ["STP", "HLT", "\x18"] {
        for wait in [0, 3_000] {
            let mut bench = Bench::ready();
            bench.offer(0, b"MOV X 60\n");
            bench.run(wait);
            bench.say(&format!("{stop}\nMVR X -1\nMOV Y 2\n"));
            bench.run_to_rest();
            let x = bench.value("POS? X");
            assert!(x < 50.0, "{stop}: {x}");
            assert!((bench.value("MOV? X") - x).abs() < 6.5e-8);
            assert!((bench.value("POS? Y") - 2.0).abs() < 6.5e-8);
            assert!(bench.tick.worst_jump < HARD, "{}", bench.tick.worst_jump);
        }
    }
}

#[test]
fn a_move_the_tick_refuses_is_planned_again_unless_stopped() {
    for (lines, log) in [
        ("MOV X 5\n", &["refused", "move"][..]),
        ("MOV X 5\nSTP\n", &["refused"][..]),
    ] {
        let mut bench = Bench::ready();
        bench.offer(0, lines.as_bytes());
        // The setpoint is no longer where the plan starts.
        bench.tick.place(1.0, 0.0, 0.0);
        bench.run_to_rest();
        assert_eq!(bench.tick.log, log, "{lines:?}");
        let x = bench.value("MOV? X");
        assert!((bench.value("POS? X") - x).abs() < 6.5e-8, "{lines:?}");
    }
}
