//! Byte-exact transcripts: what is sent, what comes back, rule by rule.

mod panel_bench;

use firmware::fault::FaultKind;
use panel_bench::Bench;

const ZEROS: &str = "X=0.000000000 \nY=0.000000000 \nZ=0.000000000 \nU=0.000000000 \nV=0.000000000 \nW=0.000000000\n";

#[test]
fn identity() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.say("*IDN?\n"),
        "(c)2026 Tripivot, XYT-1 (C-887 compatible), 4711, 0.1.0\n"
    );
    assert_eq!(bench.say("CSV?\n"), "2.0\n");
    assert_eq!(bench.say("VER?\n"), "FW: 0.1.0\n");
    assert_eq!(bench.say("SSN?\n"), "4711\n");
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

#[test]
fn constants_are_answered_before_the_first_tick() {
    let mut bench = Bench::cold();
    bench.offer(0, b"CSV?\nPOS? X\n");
    assert_eq!(bench.answers_of(0), b"2.0\n");
    bench.run(1);
    assert_eq!(bench.answers_of(0), b"X=0.000000000\n");
}

#[test]
fn six_axes_in_order() {
    let mut bench = Bench::new();
    let axes = "X \nY \nZ \nU \nV \nW\n";
    assert_eq!(bench.say("SAI?\n"), axes);
    assert_eq!(bench.say("SAI? ALL\n"), axes);
    assert_eq!(bench.error_after("SAI? X"), "24");
}

#[test]
fn help_lists_what_is_there() {
    let mut bench = Bench::new();
    let help = bench.say("HLP?\n");
    let lines: Vec<_> = help.split(" \n").collect();
    assert!(!lines[0].starts_with('#'));
    assert_eq!(*lines.last().unwrap(), "end of help\n");
    let names: Vec<_> = lines[1..lines.len() - 1]
        .iter()
        .map(|line| line.split(' ').next().unwrap())
        .collect();
    assert_eq!(
        names.join(" "),
        "#3 #4 #5 #7 #24 *IDN? CSV? DEL ERR? FLC FLT? FRF FRF? HLT HLP? MOV MOV? MVR ONT? POS? SAI? SSN? STP SVO SVO? \
         TMN? TMX? VER? VLS VLS? WAC"
    );
    for name in names.iter().filter(|name| !name.starts_with('#')) {
        // With no parameters each is either understood or short of them, never unknown.
        if let Err(error) = firmware::panel::parse(name.as_bytes()) {
            assert_eq!(error.code.number(), 24, "{name}");
        }
    }
}

#[test]
fn several_lines_end_in_space_and_lf_but_the_last() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("MOV? X W\n"), "X=0 \nW=0\n");
    // In the controller's order, whatever the client's.
    assert_eq!(bench.say("MOV? W X\n"), "X=0 \nW=0\n");
    assert_eq!(bench.say("ONT?\n"), "X=1 \nY=1 \nZ=1 \nU=1 \nV=1 \nW=1\n");
    assert_eq!(
        bench.say("TMN?\n"),
        "X=-80 \nY=-80 \nZ=0 \nU=0 \nV=0 \nW=-3600000\n"
    );
    assert_eq!(bench.say("TMX? X Z W\n"), "X=80 \nZ=0 \nW=3600000\n");
}

#[test]
fn lines_in_any_dress() {
    let mut bench = Bench::ready();
    for line in [
        "frf? x\n",
        "  FRF?   X  \n",
        "FRF? X\r\n",
        "\r\n\nFRF? x\n\n",
        "FrF? X \r\n",
    ] {
        assert_eq!(bench.say(line), "X=1\n", "{line:?}");
    }
    assert_eq!(bench.say("FRF X  Y \n"), "");
    for (line, x) in [
        ("MOV X1\n", "1"),
        ("mov x+2.5\n", "2.5"),
        ("MOV X-1e-06\n", "-0.000001"),
        ("MOV X 0.333333333333\n", "0.333333333333"),
        ("MOV X2Y-3\n", "2"),
        ("MOV X -0\n", "0"),
        ("MOV X .5E1\n", "5"),
    ] {
        assert_eq!(bench.say(line), "");
        assert_eq!(bench.say("MOV? X\n"), format!("X={x}\n"), "{line:?}");
    }
    assert_eq!(bench.say("MOV? Y\n"), "Y=-3\n");
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

#[test]
fn single_bytes_between_and_inside_lines() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("\x05\n"), "0\n");
    assert_eq!(bench.say("\x05\x04\x07"), "0\n65536\n\u{B1}\n");
    assert_eq!(bench.say("SV\x05O? X\n"), "0\nX=1\n");
    // Not there yet: #6, #8, #9.
    for byte in ["\x06", "\x08", "\x09"] {
        assert_eq!(bench.say(byte), "");
        assert_eq!(bench.say("ERR?\n"), "2\n");
    }
}

#[test]
fn lines_split_and_merged() {
    let mut bench = Bench::ready();
    assert_eq!(bench.say("MO"), "");
    assert_eq!(bench.say("V? X"), "");
    assert_eq!(bench.say("\nMOV? Y\nCSV?\nMOV"), "X=0\nY=0\n2.0\n");
    assert_eq!(bench.say("? W\n"), "W=0\n");
}

#[test]
fn unknown_commands_answer_nothing() {
    let mut bench = Bench::ready();
    for line in [
        "QQQ?", "EAX X 1", "POS X 1", "MOVE X 1", "#5", "\u{e9}", "MOV?X",
    ] {
        assert_eq!(bench.error_after(line), "2", "{line}");
        assert_eq!(bench.say("ERR?\n"), "0\n");
    }
}

#[test]
fn lines_too_long() {
    let mut bench = Bench::ready();
    let fits = format!("MOV? X{}\n", " ".repeat(250));
    assert_eq!(bench.say(&fits), "X=0\n");
    for length in [251, 300, 5_000] {
        let too_long = format!("MOV? X{}\n", " ".repeat(length));
        assert_eq!(bench.say(&too_long), "", "{length}");
        assert_eq!(bench.say("ERR?\n"), "3\n");
    }
    // Single bytes act inside it, and its tail is not taken for a line.
    let tail = format!("{}\x04{}MOV X 1\nMOV? X\n", "A".repeat(300), " ".repeat(10));
    assert_eq!(bench.say(&tail), "65536\nX=0\n");
}

#[test]
fn parameters_are_checked() {
    let mut bench = Bench::ready();
    for (line, error) in [
        ("MOV", "24"),
        ("MOV X", "24"),
        ("MOV X 1 Y", "24"),
        ("MOV 1", "15"),
        ("MOV Q 1", "15"),
        ("MOV XY 1", "15"),
        ("MOV X 1 X 2", "22"),
        ("MOV X 1 x 2", "22"),
        ("MOV X =1", "25"),
        ("MOV X nan", "25"),
        ("MOV X inf", "25"),
        ("MOV X -inf", "25"),
        ("MOV X 1e999", "25"),
        ("MOV X 1.2.3", "25"),
        ("MOV X --1", "25"),
        ("POS? Q", "15"),
        ("POS? X X", "22"),
        ("CSV? X", "24"),
        ("STP X", "24"),
        ("SVO X", "24"),
        ("SVO X 2", "17"),
        ("SVO X 0.5", "17"),
        ("VLS", "24"),
        ("VLS X", "25"),
        ("VLS 200.1", "8"),
        ("VLS 0", "8"),
        ("VLS -5", "8"),
        ("DEL", "24"),
        ("DEL -1", "17"),
        ("DEL 1e30", "17"),
        ("WAC", "24"),
        ("WAC ONT?", "24"),
        ("WAC ONT? W", "24"),
        ("WAC ONT? W =", "24"),
        ("WAC ONT? W # 1", "1"),
        ("WAC ONT? W =< 1", "1"),
        ("WAC CSV? X = 1", "17"),
        ("WAC ONT? W = 1 2", "24"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert!(bench.tick.log.is_empty(), "{:?}", bench.tick.log);
}

#[test]
fn parse_errors_say_where_and_what() {
    for (line, column, expected) in [
        ("  XYZ 1", 3, "a command of those HLP? lists"),
        ("MOV X 1 Q 2", 9, "an axis: X, Y, Z, U, V or W"),
        ("MOV X", 6, "a number"),
        ("MOV X one", 7, "a number"),
        ("WAC ONT? W ~ 1", 12, "an operator: = != < <= > >="),
        ("CSV? 1", 6, "the end of the line"),
    ] {
        let error = firmware::panel::parse(line.as_bytes()).unwrap_err();
        assert_eq!((error.column, error.expected), (column, expected), "{line}");
    }
    let error = firmware::panel::parse(b"MOV X 1 X 2").unwrap_err();
    assert_eq!(
        error.to_string(),
        "column 9: expected an axis that has not been named yet (error 22)"
    );
}

#[test]
fn frozen_axes() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("MOV Z 0 U 0 V 0"), "0");
    assert_eq!(bench.error_after("MVR V 0"), "0");
    assert_eq!(bench.error_after("MOV X 1 Z 0.1"), "7");
    assert_eq!(bench.error_after("MVR U 1e-9"), "7");
    assert_eq!(bench.error_after("SVO Z 1 U 0"), "0");
    assert_eq!(bench.say("MOV? X Z\nSVO? U\n"), "X=0 \nZ=0\nU=1\n");
    assert!(bench.tick.log.is_empty(), "{:?}", bench.tick.log);
}

#[test]
fn errors_are_per_connection() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("NIX?\n");
    assert_eq!(bench.say_to(other, "ERR?\n"), "0\n");
    assert_eq!(bench.say("ERR?\n"), "2\n");
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

#[test]
fn a_fault_is_told_once_on_every_connection() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.tick.fail(FaultKind::FollowingError, Some(1));
    let tick = bench.tick.now.tick;
    assert_eq!(bench.say("\x05"), "0\n");
    assert_eq!(bench.say("ERR?\nERR?\n"), "504\n0\n");
    assert_eq!(bench.say_to(other, "ERR?\nERR?\n"), "504\n0\n");
    assert_eq!(
        bench.say("FLT?\n"),
        format!("following error too large, pivot 2: 3e-3 rad, limit 2e-3 rad, at tick {tick}\n")
    );
    for line in ["SVO X 1", "FRF", "MOV X 1", "MVR W 1", "MOV X 1000"] {
        assert_eq!(bench.error_after(line), "1024", "{line}");
    }
    assert_eq!(bench.error_after("SVO X 0"), "0");
    assert_eq!(bench.error_after("STP"), "10");
    assert_eq!(bench.error_after("HLT"), "10");
    assert_eq!(bench.error_after("\x18"), "10");
    assert_eq!(bench.error_after("FLC"), "0");
    assert_eq!(bench.say("FLT?\nSVO? X\n"), "0 no fault\nX=0\n");
    assert_eq!(bench.error_after("MOV X 1"), "5");
    assert_eq!(bench.error_after("SVO X 1"), "0");
    assert_eq!(bench.error_after("MOV X 1"), "0");
    assert_eq!(bench.tick.log, ["acknowledge", "on", "move"]);
    // A connection that comes later learns of a fault that is still there, and of none that is gone.
    let late = bench.connect();
    assert_eq!(bench.say_to(late, "ERR?\n"), "0\n");
    bench.tick.fail(FaultKind::EmergencyStop, None);
    bench.run(1);
    let later = bench.connect();
    assert_eq!(bench.say_to(later, "ERR?\n"), "1024\n");
}

#[test]
fn silent_encoders() {
    let mut bench = Bench::new();
    bench.tick.now.encoder_faults = [
        None,
        Some(FaultKind::EncoderSilent),
        Some(FaultKind::EncoderCrc),
    ];
    bench.run(2);
    assert_eq!(
        bench.say("FLT?\n"),
        "encoder does not answer, pivot 2 \nencoder frames fail the CRC, pivot 3\n"
    );
    assert_eq!(bench.say("FRF\nERR?\n\x07"), "\u{B0}\n");
    bench.run(50);
    assert_eq!(bench.answers_of(0), b"45\n");
    assert_eq!(bench.say("FRF? X\n\x04\x05\x07"), "X=0\n0\n0\n\u{B1}\n");
    assert!(bench.tick.log.is_empty());
    // Encoders that begin to answer in time are waited for.
    bench.say("FRF\n");
    bench.tick.now.encoder_faults = [None; 3];
    bench.run(3);
    assert_eq!(bench.say("ERR?\nFRF? X\n"), "0\nX=1\n");
}

#[test]
fn before_the_reference() {
    let mut bench = Bench::new();
    assert_eq!(bench.say("POS?\n"), ZEROS);
    assert_eq!(bench.say("\x03"), ZEROS);
    assert_eq!(
        bench.say("FRF? X\nSVO? X\nONT? X\n\x05\x04"),
        "X=0\nX=0\nX=0\n0\n0\n"
    );
    assert_eq!(bench.error_after("MOV X 1"), "5");
    // Accepted, since clients send it first; it comes about with FRF.
    assert_eq!(bench.error_after("SVO X 1"), "0");
    assert_eq!(bench.say("SVO? X\n"), "X=0\n");
    assert!(bench.tick.log.is_empty());
}

#[test]
fn referencing_leaves_servo_on_and_is_harmless_when_repeated() {
    let mut bench = Bench::new();
    bench.tick.place(12.5, -7.25, 33.0);
    let other = bench.connect();
    bench.offer(0, b"FRF X\n");
    bench.service(0);
    // Sent, and not taken yet.
    bench.offer(other, b"\x05\x07");
    assert_eq!(bench.answers_of(other), b"23\n\xB0\n");
    bench.run(3);
    assert_eq!(bench.say("FRF?\n"), "X=1 \nY=1 \nZ=1 \nU=1 \nV=1 \nW=1\n");
    assert_eq!(bench.say("SVO? X W\n\x05"), "X=1 \nW=1\n23\n");
    bench.run_to_rest();
    for query in ["POS?", "MOV?"] {
        for (axis, place) in [("X", 12.5), ("Y", -7.25), ("W", 33.0)] {
            // A pivot's angle is known to 0.8 nrad.
            let value = bench.value(&format!("{query} {axis}"));
            assert!((value - place).abs() < 3e-7, "{query} {axis}: {value}");
        }
    }
    let position = bench.say("POS? X\n");
    assert_eq!(position.len(), "X=12.500000000\n".len(), "{position}");
    assert_eq!(bench.error_after("FRF"), "0");
    assert_eq!(bench.tick.log, ["reference"]);
    bench.say("SVO X 0\n");
    assert_eq!(bench.error_after("FRF"), "0");
    assert_eq!(bench.say("SVO? X\n"), "X=1\n");
    assert_eq!(bench.tick.log, ["reference", "off", "on"]);
}
