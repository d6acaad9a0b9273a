//! Byte-exact transcripts: what is sent, what comes back, rule by rule.

mod gcs_bench;

use firmware::drivers::bridge::Duty;
use firmware::fault::FaultKind;
use firmware::parameters::Parameters;
use gcs_bench::Bench;

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
        "#3 #4 #5 #6 #7 #8 #9 #24 *IDN? ADD APP APP? CAL CAL CAL CAL CAL CAL CAL CAL? CCL CCL? CMS CMS? CST? CSV? DEL DRC DRC? DRL? DRR? DRT DRT? ERR? EVT? EXC EXC EXC EXC EXC? FLC FLR? FLT? FRF FRF? HDR? HBT HBT? HIN? HLT HLP? HPA? \
         ILC ILC ILC ILC ILC? JOG JOG? JON? JRC JTM JTM? KEN KEN? KET? KLN KLN? KLS? KLT? KRM KSD KSF KST KSW LIM? LST LST? \
         MAC MAC MAC MAC MAC MAC MAC MAC MAC? MEX MON? MOV MOV? MRT MRW MVR NLM NLM? ONT? OWN OWN? \
         PLM PLM? POS? PUN? RBT RCV RCV? RMC? RPA RTR RTR? SAI? SCT SCT? SPA SPA? SPI SPI? SSL SSL? SSN? STE STP SVO SVO? \
         TMN? TMP TMP? TMX? TNR? TPC? TRA? TRS? TST? TWG? VAR VAR? VEL VEL? VER? VLS VLS? VMO? WAC \
         WAV WAV? WCL WGC WGC? WGO WGO? WPA WSL WSL? WTR WTR?"
    );
    for name in names.iter().filter(|name| !name.starts_with('#')) {
        // With no parameters each is either understood or short of them, never unknown.
        if let Err(error) = firmware::gcs::parse(name.as_bytes()) {
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
    assert_eq!(bench.say("\x09"), "0\n");
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
        ("NLM X", "24"),
        ("SSL X 2", "17"),
        ("VMO?", "24"),
        ("TRA? X", "24"),
        ("TRA? X 0 W 0", "17"),
        ("SPA? X", "24"),
        ("SPA? Q 0x0E000200", "15"),
        ("SPA? 2 0x0E000200", "15"),
        ("SPA? 1 0x07000601", "15"),
        ("SPA? X 0x0E000201", "54"),
        ("SPA? X speed", "25"),
        ("SPA? X 0x", "25"),
        ("SPA? X 0x100000000", "25"),
        ("SPA", "24"),
        ("SPA 1 0x54500100", "24"),
        ("SPA 1 0x54500100 fast", "25"),
        ("SPA 1 0x12345678 1", "54"),
        ("SPA X 0x07000601 mm", "64"),
        ("SPA 1 0x0E000200 1", "64"),
        ("SPA 1 0x54500100 200.1", "17"),
        ("SPA 1 0x54500100 0", "17"),
        ("SPA 1 0x54500100 -1", "17"),
        ("SPA 1 0x54500300 250", "60"),
        ("CCL", "24"),
        ("CCL x", "25"),
        ("CCL 1", "56"),
        ("CCL 1 advance", "56"),
        ("CCL 2 ADVANCED", "17"),
        ("CCL 0.5 ADVANCED", "17"),
        ("CCL 1 ADVANCED now", "24"),
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
        let error = firmware::gcs::parse(line.as_bytes()).unwrap_err();
        assert_eq!((error.column, error.expected), (column, expected), "{line}");
    }
    let error = firmware::gcs::parse(b"MOV X 1 X 2").unwrap_err();
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
    for stop in ["STP", "HLT", "\x18"] {
        assert_eq!(bench.error_after(stop), "0");
    }
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
            assert!((value - place).abs() < 6.5e-8, "{query} {axis}: {value}");
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

#[test]
fn what_clients_ask_of_a_stage() {
    let mut bench = Bench::new();
    assert_eq!(bench.say("CST? X W\n"), "X=XYT-1 \nW=XYT-1\n");
    assert_eq!(
        bench.say("PUN?\n"),
        "X=mm \nY=mm \nZ=mm \nU=deg \nV=deg \nW=deg\n"
    );
    assert_eq!(bench.say("LIM? X\nTRS? X\nCCL?\n"), "X=0\nX=0\n0\n");
}

#[test]
fn parameters_in_either_notation() {
    let mut bench = Bench::new();
    let all = "X 0x7000601=mm \n1 0xE000200=0.00005 \nW 0x7000601=deg\n";
    assert_eq!(
        bench.say("SPA? X 0x07000601 1 234881536 w 0x7000601\n"),
        all
    );
    assert_eq!(
        bench.say("SPA? X 0xe000200 1 0x16000201 Y 0X19001900\n"),
        "X 0xE000200=0.00005 \n1 0x16000201=2048 \nY 0x19001900=0\n"
    );
    let nine = " 1 0xE000200".repeat(9);
    assert_eq!(bench.error_after(&format!("SPA?{nine}")), "24");
}

#[test]
fn every_parameter_is_listed_once_and_answered() {
    let mut bench = Bench::new();
    let help = bench.say("HPA?\n");
    let lines: Vec<_> = help.split(" \n").collect();
    assert_eq!(*lines.last().unwrap(), "end of help\n");
    let mut ids = Vec::new();
    for line in &lines[1..lines.len() - 1] {
        let (id, rest) = line.split_once('=').unwrap();
        let columns: Vec<_> = rest.split('\t').collect();
        let ["", "0" | "1", items, kind, _, text] = columns[..] else {
            panic!("{line:?}");
        };
        assert!(!text.contains('=') && !id.contains(' '), "{line:?}");
        let item = if items == "6" { "Y" } else { "1" };
        let answer = bench.say(&format!("SPA? {item} {id}\n"));
        let value = answer.strip_prefix(&format!("{item} {id}=")).unwrap();
        let is_number = value.trim_end().parse::<f64>().is_ok();
        assert_eq!(is_number, kind != "CHAR", "{line:?}: {value}");
        let is_whole = value.trim_end().parse::<i64>().is_ok();
        assert!(is_whole || kind != "INT", "{line:?}: {value}");
        ids.push(id.to_owned());
    }
    let count = ids.len();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), count);
    // Without parameters all are answered: those of axes six times.
    assert_eq!(bench.say("SPA?\n").matches('=').count(), count + 5);
}

#[test]
fn limits_of_motion_are_lowered_and_raised_again() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("VLS 150"), "0");
    assert_eq!(
        bench.error_after("SPA 1 0x54500100 120 1 0x54500103 90"),
        "0"
    );
    assert_eq!(
        bench.say("SPA? 1 0x54500100 1 0x54500103\nVLS?\n"),
        "1 0x54500100=120 \n1 0x54500103=90\n120\n"
    );
    assert_eq!(bench.error_after("VLS 121"), "8");
    // One out of range: nothing changes.
    assert_eq!(
        bench.error_after("SPA 1 0x54500100 50 1 0x54500101 4001"),
        "17"
    );
    assert_eq!(bench.say("SPA? 1 0x54500100\n"), "1 0x54500100=120\n");
    assert_eq!(bench.say("MOV W 20\n"), "");
    assert_eq!(bench.error_after("SPA 1 0x54500100 200"), "53");
    bench.run_to_rest();
    assert_eq!(bench.error_after("SPA 1 0x54500100 200"), "0");
    assert_eq!(bench.say("VLS?\n"), "120\n");
    assert_eq!(bench.error_after("VLS 200"), "0");
}

#[test]
fn lower_limits_make_slower_moves() {
    let ticks = |limit: &str| {
        let mut bench = Bench::ready();
        assert_eq!(bench.error_after(limit), "0");
        bench.say("MOV X 20\n");
        let start = bench.tick.now.tick;
        bench.run_to_rest();
        bench.tick.now.tick - start
    };
    let full = ticks("");
    for lower in [
        "SPA 1 0x54500100 20",
        "SPA 1 0x54500101 400",
        "SPA 1 0x54500102 4000",
    ] {
        assert!(ticks(lower) > full + full / 2, "{lower}");
    }
}

#[test]
fn soft_limits() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.say("NLM? X Z\nPLM? W\nSSL? X\n"),
        "X=-80 \nZ=0\nW=3600000\nX=1\n"
    );
    assert_eq!(bench.error_after("NLM X -5 W -90"), "0");
    assert_eq!(bench.error_after("PLM X 6"), "0");
    assert_eq!(bench.say("NLM? X W\nPLM? X\n"), "X=-5 \nW=-90\nX=6\n");
    for (line, error) in [
        ("MOV X -5.1", "7"),
        ("MOV X 6.1", "7"),
        ("MVR W -90.1", "7"),
        ("NLM X -80.1", "27"),
        ("PLM X 81", "27"),
        ("NLM X 7", "27"),
        // The target would be out of them.
        ("NLM X 1", "27"),
        ("NLM Z -1", "27"),
        ("MOV X 6", "0"),
        ("SSL X 0", "0"),
        ("MOV X 10", "0"),
        ("SSL X 1", "27"),
        ("MOV X 0", "0"),
        ("SSL X 1", "0"),
        ("MOV X 6.1", "7"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("TMN? X\nMOV? X\n"), "X=-80\nX=0\n");
}

#[test]
fn vmo_and_tra_answer_what_a_move_meets() {
    let mut bench = Bench::ready();
    for (line, answer) in [
        ("VMO? X 60 Y 50", "1"),
        ("VMO? X 60 Y 60", "0"),
        ("VMO? X 80", "1"),
        ("VMO? Z 0.1", "0"),
        ("VMO? W 3600000.1", "0"),
        ("TRA? X 1", "X=80"),
        ("TRA? X -0.5", "X=-80"),
        ("TRA? Z 1", "Z=0"),
        ("TRA? W -3", "W=-3600000"),
        ("TRA? X 3 Y 4 W 0", "X=48 \nY=64 \nW=0"),
    ] {
        assert_eq!(
            bench.say(&format!("{line}\n")),
            format!("{answer}\n"),
            "{line}"
        );
    }
    // From where it stands, and as far as soft limits go.
    bench.say("MOV X 48\n");
    bench.run_to_rest();
    assert_eq!(bench.say("TRA? Y -2\n"), "Y=-64\n");
    assert_eq!(bench.say("VMO? Y 64.1\nVMO? Y -64\n"), "0\n1\n");
    assert_eq!(bench.error_after("NLM Y -10"), "0");
    assert_eq!(
        bench.say("TRA? Y -2\nVMO? Y -11\nVMO? Y -10\n"),
        "Y=-10\n0\n1\n"
    );
    // On the line, not in its own way to the limit.
    assert_eq!(bench.say("TRA? X -3 Y -4\n"), "X=40.5 \nY=-10\n");
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

/// The answer of `TRA?` is taken by `MOV`, and a hair more is not, in any direction and from anywhere.
#[test]
fn tra_is_exact() {
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngSeed, TestRunner};
    let mut runner = TestRunner::new(Config {
        cases: 300,
        rng_seed: RngSeed::Fixed(20_261_121),
        failure_persistence: None,
        ..Config::default()
    });
    let disk = (0.0..79.9_f64, 0.0..6.3_f64);
    runner
        .run(&(disk, 0.0..6.3_f64), |((radius, at), towards)| {
            let mut bench = Bench::ready();
            let [x, y] = [radius * at.cos(), radius * at.sin()];
            let [dx, dy] = [towards.cos(), towards.sin()];
            bench.say(&format!("MOV X {x} Y {y}\n"));
            let answer = bench.say(&format!("TRA? X {dx} Y {dy}\n"));
            let end: Vec<f64> = (answer.lines())
                .map(|line| line.trim_end().split_once('=').unwrap().1.parse().unwrap())
                .collect();
            // Where the line meets the rim at its flattest, a twentieth of this hair points outwards: five times the
            // slack that a target on the rim itself has.
            let more = [end[0] + dx * 1e-5, end[1] + dy * 1e-5];
            let ask =
                |bench: &mut Bench, [x, y]: [f64; 2]| bench.say(&format!("VMO? X {x} Y {y}\n"));
            prop_assert_eq!(ask(&mut bench, [end[0], end[1]]), "1\n");
            prop_assert_eq!(ask(&mut bench, more), "0\n");
            let turned = (end[0] - x) * dy - (end[1] - y) * dx;
            prop_assert!(turned.abs() < 1e-9, "off the line by {turned} mm");
            Ok(())
        })
        .unwrap();
}

/// The two numbers of a field of `MON?`.
fn range(reply: &str, field: &str) -> [f64; 2] {
    let line = reply.lines().find_map(|line| line.strip_prefix(field));
    let numbers: Vec<f64> = (line.expect(field).split_whitespace())
        .map(|number| number.parse().unwrap())
        .collect();
    numbers.try_into().unwrap()
}

#[test]
fn mon_tells_the_lowest_and_the_highest_since_it_was_last_asked_on_this_connection() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.tick.place(30.0, 0.0, 45.0);
    bench.run(2);
    bench.say("MON?\n");
    bench.say_to(other, "MON?\n");
    // One tick each: a spike up and one down.
    for (error, duty) in [(0, 0), (4_000, 50), (-1_000, -100), (0, 0)] {
        bench.tick.now.pivot_errors = [0, error, 0];
        bench.tick.now.duty = [0, 0, duty].map(Duty);
        bench.run(1);
    }
    let reply = bench.say("MON?\n");
    let urad = |units: f64| units * std::f64::consts::TAU / 4_294_967_296.0 * 1e6;
    let [low, high] = range(&reply, "ERROR2=");
    assert!(
        (low - urad(-1_000.0)).abs() < 1e-3 && (high - urad(4_000.0)).abs() < 1e-3,
        "{reply}"
    );
    assert_eq!(range(&reply, "ERROR1="), [0.0; 2]);
    let counts = f64::from(Parameters::REFERENCE.power.pwm_counts);
    let [low, high] = range(&reply, "DUTY3=");
    assert!(
        (low + 100.0 / counts).abs() < 1e-5 && (high - 50.0 / counts).abs() < 1e-5,
        "{reply}"
    );
    let pose = " \nMODE=holding \nX=30.000000 \nY=0.000000 \nW=45.000000 \nPIVOT1=";
    assert!(
        reply.starts_with("TICK=") && reply.contains(pose),
        "{reply}"
    );
    // It has been told; the other connection has not.
    bench.run(1);
    assert_eq!(range(&bench.say("MON?\n"), "ERROR2="), [0.0; 2]);
    let reply = bench.say_to(other, "MON?\n");
    assert!(
        (range(&reply, "ERROR2=")[1] - urad(4_000.0)).abs() < 1e-3,
        "{reply}"
    );
}
