//! What is a connection's own: its constant velocities, its answers, and the stage, if it has asked for that.

mod gcs_bench;

use firmware::fault::FaultKind;
use gcs_bench::Bench;

/// Axes that are commanded to move at constant velocities.
fn jogs(bench: &mut Bench) -> String {
    bench
        .say("JOG? X Y W\n")
        .replace(" \n", " ")
        .replace('\n', "")
}

#[test]
fn a_jog_ends_smoothly_with_its_connection() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "JOG W 90\n");
    bench.run(4_000);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=90");
    bench.disconnect(other);
    bench.run_to_rest();
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=0");
    // As smoothly as it began: what 7,200 deg/s^2 make of a tick, half of what a stop makes.
    assert!(bench.tick.worst_jump < 0.0069, "{}", bench.tick.worst_jump);
    // Nobody has been refused anything, and the stage takes commands.
    assert_eq!(bench.error_after("MOV X 1"), "0");
}

#[test]
fn a_jog_of_another_connection_goes_on() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "JOG W 90 X 1\n");
    bench.say("JOG X 2\n");
    bench.run(4_000);
    bench.disconnect(other);
    bench.run(6_000);
    assert_eq!(jogs(&mut bench), "X=2 Y=0 W=0");
    bench.say("JOG X 0\n");
    bench.run_to_rest();
}

#[test]
fn a_connection_that_ends_does_not_stop_what_took_over_from_its_jog() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "JOG X 5\n");
    bench.run(2_000);
    bench.say("MOV X 20\n");
    bench.disconnect(other);
    bench.run_to_rest();
    assert_eq!(bench.value("MOV? X"), 20.0);
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

#[test]
fn a_jog_lasts_as_long_as_its_connection_has_said_and_is_renewed() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("JTM?\n"), "0\n");
    for (line, error) in [
        ("JTM 300", "0"),
        ("JTM 9", "17"),
        ("JTM -1", "17"),
        ("JTM 1e9", "17"),
        ("JTM", "24"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("JTM?\n"), "300\n");
    bench.say("JOG W 90\n");
    let moves = bench.tick.log.len();
    for _ in 0..10 {
        bench.run(1_990);
        bench.say("JOG W 90\n");
    }
    // Renewed, not planned again.
    assert_eq!(bench.tick.log.len(), moves);
    bench.run(5_990);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=90");
    bench.run(10);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=0");
    bench.run_to_rest();
    assert_eq!(bench.error_after("JTM 0\nJOG W 90"), "0");
    bench.run(20_000);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=90");
    // What is in force is meant too.
    assert_eq!(bench.error_after("JTM 100"), "0");
    bench.run(1_900);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=90");
    bench.run(200);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=0");
}

#[test]
fn the_jog_of_a_macro_is_nobodys() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "MAC BEG m\nJOG W 90\nMAC END\nMAC START m\n");
    bench.run(2_000);
    bench.disconnect(other);
    bench.run(10_000);
    assert_eq!(jogs(&mut bench), "X=0 Y=0 W=90");
}

#[test]
fn who_moves_is_told_that_another_connection_has_stopped_it() {
    for stop in ["STP\n", "\x18", "HLT\n", "SVO X 0\n"] {
        let mut bench = Bench::ready();
        let (mover, third) = (bench.connect(), bench.connect());
        bench.say_to(mover, "MOV X 50\n");
        bench.run(1_000);
        bench.say(stop);
        assert_eq!(bench.say_to(mover, "ERR?\nERR?\n"), "10\n0\n", "{stop}");
        assert_eq!(bench.say_to(third, "ERR?\n"), "0\n", "{stop}");
        bench.run_to_rest();
        // Nothing moves any more: nobody is told anything.
        bench.say("ERR?\n");
        bench.say(stop);
        assert_eq!(bench.say("ERR?\n"), "0\n", "{stop}");
        assert_eq!(bench.say_to(mover, "ERR?\n"), "0\n", "{stop}");
    }
}

#[test]
fn questions_of_a_client_that_waits_survive_the_stop_of_another() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MAC BEG m\nMOV X 9\nMAC END\n");
    let lines = "WAC POS? X = 5\nMOV X 3\nMOV? X\nMAC START m\nVAR A 1\nMAC ERR?\nERR?\nSVO X 0\n\x04VAR?\nERR?\nMOV";
    assert_eq!(bench.say_to(other, lines), "65536\n");
    bench.say("\x18");
    assert_eq!(bench.answers_of(other), b"X=0\n\n10\n\n0\n");
    // The line that had begun is over with its LF; what comes then is carried out.
    bench.say_to(other, " X 4\nMOV X 2\n");
    bench.run_to_rest();
    assert_eq!(bench.say("MOV? X\nSVO? X\n"), "X=2\nX=1\n");
    // The same with its own stop.
    assert_eq!(
        bench.say_to(other, "WAC POS? X = 5\nMOV X 3\nMOV? X\n\x18ERR?\n"),
        "X=2\n10\n"
    );
}

#[test]
fn acknowledging_a_fault_clears_it_on_every_connection() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    bench.run(3);
    bench.say("FLC\n");
    assert_eq!(bench.say("ERR?\n"), "0\n");
    assert_eq!(bench.say_to(other, "ERR?\n"), "0\n");
    // What has nothing to do with the fault stays.
    bench.say_to(other, "MOV Q 1\n");
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    bench.run(3);
    bench.say_to(other, "MOV Q 1\n");
    bench.say("FLC\n");
    assert_eq!(bench.say_to(other, "ERR?\n"), "15\n");
}

#[test]
fn a_servo_asked_for_before_the_reference_is_an_event_and_no_error() {
    let mut bench = Bench::new();
    for axis in ["X", "Y", "W"] {
        assert_eq!(bench.error_after(&format!("SVO {axis} 1")), "0");
    }
    let events = bench.say("EVT?\n");
    assert_eq!(
        events
            .matches("servo asked for before the reference")
            .count(),
        1,
        "{events}"
    );
}

#[test]
fn a_servo_is_not_switched_on_while_the_stage_moves() {
    let mut bench = Bench::ready();
    bench.say("SVO X 0\n");
    for tick in 0..400 {
        // 0.2 rad/s.
        bench
            .tick
            .place(0.0, 0.0, f64::from(tick) * 0.2 / 20_000.0 * 57.3);
        bench.run(1);
    }
    bench.offer(0, b"SVO X 1\nERR?\nFRF\nERR?\n");
    bench.tick.place(0.0, 0.0, 400.0 * 0.2 / 20_000.0 * 57.3);
    bench.service(0);
    assert_eq!(bench.answers_of(0), b"53\n53\n");
    bench.run(10);
    assert_eq!(bench.error_after("SVO X 1"), "0");
    assert_eq!(bench.say("SVO? X\n"), "X=1\n");
}

#[test]
fn what_clients_probe_is_answered() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.say("TPC?\nJON? 1\nJON?\nJON? 2 1\n"),
        "0\n1=0\n1=0\n1=0 \n2=0\n"
    );
    assert_eq!(bench.say("HIN? X\nHIN? X W\nERR?\n"), "X=0\nX=0 \nW=0\n0\n");
    assert_eq!(bench.error_after("JON? 9"), "17");
}

/// What `OWN?` says under a name.
fn owned(bench: &mut Bench, number: usize, name: &str) -> String {
    let reply = bench.say_to(number, "OWN?\n");
    let value = reply
        .lines()
        .find_map(|line| line.trim().strip_prefix(name)?.strip_prefix('='));
    value.expect("a value").to_owned()
}

#[test]
fn an_owner_alone_commands_and_everybody_stops() {
    let mut bench = Bench::ready();
    let (other, third) = (bench.connect(), bench.connect());
    assert_eq!(owned(&mut bench, 0, "OWNER"), "(nobody)");
    bench.session(other).set_name("192.0.2.7:4711");
    assert_eq!(bench.say_to(other, "OWN 1\nERR?\n"), "0\n");
    assert_eq!(owned(&mut bench, 0, "OWNER"), "192.0.2.7:4711");
    assert_eq!(
        (
            owned(&mut bench, 0, "MINE"),
            owned(&mut bench, other, "MINE")
        ),
        ("0".into(), "1".into())
    );
    for line in [
        "OWN 1",
        "MOV X 1",
        "MVR X 1",
        "JOG W 1",
        "SVO X 0",
        "FRF",
        "VLS 10",
        "SPA 1 0x54500100 100",
        "WPA 100",
        "RPA",
        "RBT",
        "FLC",
        "KSW A X 1",
        "SPI R 1",
        "NLM X -5",
        "SCT T 10",
        "WGO 1 1",
        "MAC BEG m",
        "MAC DEL m",
        "MAC START m",
        "STE X 1",
    ] {
        assert_eq!(bench.error_after(line), "4002", "{line}");
    }
    for line in [
        "OWN 0",
        "CCL 1 ADVANCED",
        "HBT 1000",
        "JTM 300",
        "VAR A 1",
        "DRT 0 0 0",
        "LST",
        "HBT 0",
    ] {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
    assert_eq!(bench.say("VAR?\nMAC?\nPOS? X\n"), "A=1\n\nX=0.000000000\n");
    for stop in ["STP\n", "\x18", "HLT\n"] {
        assert_eq!(bench.say_to(other, "MOV X 50\nERR?\n"), "0\n");
        bench.run(1_000);
        assert_eq!(bench.say_to(third, &format!("{stop}ERR?\n")), "10\n");
        bench.run_to_rest();
        assert!(bench.value("MOV? X") < 49.0, "{stop}");
        assert_eq!(bench.say_to(other, "ERR?\nMOV X 0\n"), "10\n");
        bench.run_to_rest();
    }
    // Given away, and free again with the end of the connection.
    bench.say_to(other, "OWN 0\n");
    assert_eq!(bench.say_to(third, "OWN 1 Bob\nOWN 1\nERR?\n"), "0\n");
    assert_eq!(owned(&mut bench, 0, "OWNER"), "Bob");
    bench.disconnect(third);
    assert_eq!(owned(&mut bench, 0, "OWNER"), "(nobody)");
    assert_eq!(bench.error_after("MOV X 1"), "0");
    assert_eq!(owned(&mut bench, other, "LAST"), "connection 1");
    for (line, error) in [
        ("OWN", "24"),
        ("OWN 2", "17"),
        ("OWN 1 a b", "24"),
        ("OWN 1 a-b", "1006"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
}

#[test]
fn a_macro_may_what_its_starter_may() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MAC BEG m\nDEL 100\nMOV X 5\nMAC END\nMAC START m\n");
    bench.say_to(other, "OWN 1\n");
    bench.run(2_100);
    assert_eq!(bench.say("MAC ERR?\nMOV? X\n"), "m 2=4002 <MOV X 5>\nX=0\n");
    bench.say_to(other, "MAC START m\n");
    bench.run(2_100);
    bench.run_to_rest();
    assert_eq!(bench.say("MAC ERR?\nMOV? X\n"), "\nX=5\n");
}

#[test]
fn a_pose_that_the_stage_can_not_take_is_no_reference() {
    for (x, y, is_reached) in [(0.0, 80.4, true), (80.6, 0.0, false), (-86.6, -49.9, false)] {
        let mut bench = Bench::cold();
        bench.tick.place(x, y, 10.0);
        bench.run(2);
        bench.say("FRF\n");
        bench.run(100);
        let expected = if is_reached { "0\n" } else { "4003\n" };
        assert_eq!(bench.say("ERR?\n"), expected, "{x} {y}");
        let told = format!("the encoders show X {x:.1} Y {y:.1} W 10.0, out of reach");
        let events = bench.say("EVT?\n");
        assert_eq!(events.contains(&told), !is_reached, "{events}");
        assert_eq!(bench.tick.log.is_empty(), !is_reached);
        assert_eq!(bench.value("SVO? X"), f64::from(u8::from(is_reached)));
    }
}
