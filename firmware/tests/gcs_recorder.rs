//! The recorder at the command interface, byte for byte.

mod gcs_bench;

use firmware::fault::FaultKind;
use gcs_bench::Bench;

/// Rows of a `DRR?` answer, without its head.
fn rows(answer: &str) -> Vec<Vec<f64>> {
    let (_, rows) = answer.split_once("# END_HEADER \n").expect("a head");
    (rows.lines())
        .map(|row| row.split_whitespace().map(|n| n.parse().unwrap()).collect())
        .collect()
}

/// The whole answer of a line.
fn ask(bench: &mut Bench, line: &str) -> String {
    assert!(bench.offer(0, format!("{line}\n").as_bytes()));
    bench.run(600);
    String::from_utf8(bench.answers_of(0)).unwrap()
}

/// Points that can be read of the first table.
fn recorded(bench: &mut Bench) -> f64 {
    bench.value("DRL? 1")
}

#[test]
fn what_is_recorded() {
    let mut bench = Bench::new();
    let all = "1=X 1 \n2=X 2 \n3=Y 1 \n4=Y 2 \n5=W 1 \n6=W 2 \n7=1 73 \n8=0 202\n";
    assert_eq!(bench.say("DRC?\n"), all);
    assert_eq!(bench.error_after("DRC 2 w 3 3 0 0 8 3 70"), "0");
    // In the order in which they are asked for.
    assert_eq!(bench.say("DRC? 8 2 3\n"), "8=3 70 \n2=W 3 \n3=0 0\n");
    assert_eq!(bench.say("TNR?\nRTR?\n"), "8\n1\n");
    assert_eq!(bench.error_after("RTR 20"), "0");
    assert_eq!(bench.say("RTR?\n"), "20\n");
    assert_eq!(
        bench.say("DRT? 1 2\nDRL? 1 2\n"),
        "1=0 0 \n2=0 0\n1=0 \n2=0\n"
    );
    assert_eq!(bench.say("SPA? 1 0x16000201\n"), "1 0x16000201=2048\n");
}

#[test]
fn help() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.say("HDR?\n"),
        "#RecordOptions \n\
         0=nothing is recorded \n\
         1=commanded position of axis or pivot, mm or deg \n\
         2=real position of axis or pivot, mm or deg \n\
         3=position error of axis or pivot, real minus commanded, mm or deg \n\
         8=time since the trigger, s \n\
         70=commanded velocity of axis or pivot, mm/s or deg/s \n\
         71=commanded acceleration of axis, mm/s^2 or deg/s^2 \n\
         73=motor output of pivot, duty from -1 to 1 \n\
         200=motor current of pivot, A \n\
         201=supply, V \n\
         202=state: 0 off, 1 holding, 2 moving, 3 fault, 4 stopping at a fault, 5 excited \n\
         203=fault: kind of the latched one, 0 for none \n\
         204=cost of the tick before, processor cycles \n\
         205=integral of pivot, what its feedback has collected, V \n\
         206=model current of pivot, its motor's by the model, A \n\
         207=learnt of the rate of pivot, besides the model's, V s/rad \n\
         208=learnt of the torque of pivot, besides the model's, V/(N m) \n\
         209=learnt of friction of pivot, besides the model's, V \n\
         210=real position without the calibration of axis, mm or deg \n\
         #TriggerOptions \n\
         0=none; STE triggers whatever is set here \n\
         1=every command that moves \n\
         2=next command that moves, 0 afterwards \n\
         4=at once \n\
         100=signal of the table rises to <value>; not options 2, 3, 210 of axes \n\
         101=signal of the table falls below <value>; not options 2, 3, 210 of axes \n\
         102=fault \n\
         #Parameters to be set with SPA \n\
         0x16000201=points of a record \n\
         0x54500900=points before the trigger \n\
         #Additional information \n\
         8 record tables \n\
         2048 datapoints per table \n\
         sources: X Y Z U V W axes of the platform in the base frame; 1 2 3 pivots; 0 controller \n\
         end of help\n"
    );
}

#[test]
fn what_is_refused() {
    let mut bench = Bench::ready();
    for (line, error) in [
        ("DRC", "24"),
        ("DRC 1", "24"),
        ("DRC 1 X", "24"),
        ("DRC 0 X 1", "57"),
        ("DRC 9 X 1", "57"),
        ("DRC 1.5 X 1", "25"),
        ("DRC 1 Q 1", "15"),
        ("DRC 1 4 1", "15"),
        ("DRC 1 X 4", "58"),
        ("DRC 1 X 73", "58"),
        ("DRC 1 1 71", "58"),
        ("DRC 1 X 70000", "58"),
        ("DRC 1 X 1 2 Y 99", "58"),
        ("DRC? 9", "57"),
        ("DRL? 0", "57"),
        ("DRT", "24"),
        ("DRT 1", "24"),
        ("DRT 9 1 0", "57"),
        ("DRT 1 3 0", "17"),
        ("DRT 1 1 x", "25"),
        ("DRT 0 1 0 2 1 0", "24"),
        // The real position is worked out after the tick.
        ("DRT 2 100 5", "17"),
        ("RTR", "24"),
        ("RTR 0", "17"),
        ("RTR 1.5", "17"),
        ("RTR 65537", "17"),
        ("HDR? 1", "24"),
        ("TNR? 1", "24"),
        ("DRR?", "77"),
        ("DRR? 1 1", "77"),
        ("DRR? 0 1", "17"),
        ("DRR? 1 0", "17"),
        ("DRR? 1", "24"),
        ("DRR? 1 1 9", "57"),
        ("STE", "24"),
        ("STE X 100", "7"),
        ("STE Q 1", "15"),
        ("SPA 1 0x16000201 0", "17"),
        ("SPA 1 0x16000201 2817", "17"),
        ("SPA 1 0x54500900 2048", "17"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    // Nothing of it was done.
    assert_eq!(bench.say("DRC? 1\nDRT? 1\nRTR?\n"), "1=X 1\n1=0 0\n1\n");
    assert_eq!(recorded(&mut bench), 0.0);
    for table in 1..=8 {
        assert_eq!(bench.error_after(&format!("DRC {table} X 0")), "0");
    }
    assert_eq!(bench.error_after("STE X 1"), "78");
    assert_eq!(bench.error_after("DRT 0 4 0"), "78");
    assert_eq!(bench.error_after("DRT 0 0 0"), "0");
    assert!(bench.tick.log.is_empty(), "nothing moved");
}

#[test]
fn a_step_is_recorded_from_its_start() {
    let mut bench = Bench::ready();
    bench.say("MOV X 10\n");
    bench.run_to_rest();
    assert_eq!(
        bench.error_after("SPA 1 0x16000201 10\nDRC 2 X 3 3 0 0 4 0 0 5 W 1 6 0 8 7 0 204"),
        "0"
    );
    assert_eq!(bench.error_after("STE X 0.5"), "0");
    assert_eq!(bench.say("MOV? X\n"), "X=10.5\n");
    bench.run(20);
    let answer = ask(&mut bench, "DRR?");
    let head = "# DIM = 6 \n# NDATA = 10 \n# SAMPLE_TIME = 0.00005 \n# SEPARATOR = 32 \n# TYPE = 1 \n\
         # NAME0 = commanded position of X, mm \n# NAME1 = position error of X, mm \n\
         # NAME2 = commanded position of W, deg \n# NAME3 = time since the trigger, s \n\
         # NAME4 = cost of the tick before, cycles \n# NAME5 = state \n# END_HEADER \n";
    assert!(answer.starts_with(head), "{answer}");
    for (at, row) in rows(&answer).iter().enumerate() {
        assert_from_start(row[0] - 10.0, at);
        // Recorded pivots are a quarter of an encoder's count fine, 2.3 nm on the track.
        assert!(row[1].abs() < 7.9e-7, "{row:?}");
        assert!((row[3] - at as f64 * 5e-5).abs() < 1e-12, "{row:?}");
        assert_eq!([row[2], row[4], row[5]], [0.0, 3000.0, 2.0], "{at}");
    }
}

/// The way that the tick has made so many rows after the first one, which has moved by itself: a sixth of the jerk, 4e5
/// mm/s^3, times t^3.
fn assert_from_start(way_mm: f64, row: usize) {
    let expected = 4e5 / 6.0 * ((row + 1) as f64 * 5e-5).powi(3);
    assert!(
        (way_mm - expected).abs() < 9.4e-8,
        "row {row}: {way_mm}, not {expected}"
    );
}

#[test]
fn an_answer_to_the_byte() {
    let mut bench = Bench::ready();
    bench.say("MOV X -12.5 W 45\n");
    bench.run_to_rest();
    assert_eq!(
        bench.error_after("SPA 1 0x16000201 2\nDRC 1 X 1 2 W 1 3 1 73 4 0 202 5 Z 2 6 0 0 7 0 0 8 0 0\nRTR 4\nDRT 0 4"),
        "0"
    );
    bench.run(10);
    assert_eq!(
        ask(&mut bench, "DRR?"),
        "# DIM = 5 \n# NDATA = 2 \n# SAMPLE_TIME = 0.0002 \n# SEPARATOR = 32 \n# TYPE = 1 \n\
         # NAME0 = commanded position of X, mm \n# NAME1 = commanded position of W, deg \n\
         # NAME2 = motor output of pivot 1 \n# NAME3 = state \n# NAME4 = real position of Z, mm \n\
         # END_HEADER \n\
         -12.500000000 45.000000000 0.100000000 1 0.000000000 \n\
         -12.500000000 45.000000000 0.100000000 1 0.000000000\n"
    );
    assert_eq!(
        ask(&mut bench, "DRR? 2 1 4 1"),
        "# DIM = 2 \n# NDATA = 1 \n# SAMPLE_TIME = 0.0002 \n# SEPARATOR = 32 \n# TYPE = 1 \n\
         # NAME0 = state \n# NAME1 = commanded position of X, mm \n# END_HEADER \n1 -12.500000000\n"
    );
    assert_eq!(bench.error_after("DRR? 2 2"), "77");
    assert_eq!(bench.error_after("DRR? 1 1 6"), "78");
}

#[test]
fn moves_trigger() {
    let mut bench = Bench::ready();
    bench.say("SPA 1 0x16000201 10\nDRC 2 0 202\n");
    // The next one only.
    assert_eq!(bench.error_after("DRT 0 2 0"), "0");
    bench.run(50);
    assert_eq!(bench.say("DRT? 1\nDRL? 1\n"), "1=2 0\n1=0\n");
    // One that is refused is none.
    assert_eq!(bench.error_after("MOV X 100"), "7");
    bench.run(50);
    assert_eq!(recorded(&mut bench), 0.0);
    bench.say("MOV X 10\n");
    bench.run(20);
    assert_eq!(bench.say("DRT? 1\nDRL? 1\n"), "1=0 0\n1=10\n");
    let first = rows(&ask(&mut bench, "DRR? 1 10 1 2"));
    for (at, row) in first.iter().enumerate() {
        assert_from_start(row[0], at);
        assert_eq!(row[1], 2.0);
    }
    bench.say("MOV X 20\n");
    bench.run(20);
    assert_eq!(rows(&ask(&mut bench, "DRR? 1 10 1 2")), first);
    bench.run_to_rest();
    // Every one, as soon as the last record is complete.
    assert_eq!(bench.error_after("DRT 0 1 0"), "0");
    for target in [30, 25] {
        bench.say(&format!("MOV X {target}\n"));
        bench.run(20);
        assert_eq!(bench.say("DRT? 1\nDRL? 1\n"), "1=1 0\n1=10\n");
        bench.run_to_rest();
    }
    let last = rows(&ask(&mut bench, "DRR? 1 10 1 2"));
    assert!((last[0][0] - 30.0).abs() < 8.3e-8, "{last:?}");
    // A refused one does not cost the record.
    assert_eq!(bench.error_after("MOV X 100"), "7");
    bench.run(20);
    assert_eq!(rows(&ask(&mut bench, "DRR? 1 10 1 2")), last);
    // One that has nowhere to go is one too.
    assert_eq!(bench.error_after("DRT 0 2\nMOV X 25"), "0");
    bench.run(20);
    assert_eq!(bench.say("DRT? 1\nDRL? 1\n"), "1=0 0\n1=10\n");
}

#[test]
fn a_record_around_a_crossing() {
    let mut bench = Bench::ready();
    bench.say("SPA 1 0x16000201 100 1 0x54500900 40\nDRC 2 0 8\n");
    assert_eq!(bench.error_after("DRT 1 100 5"), "0");
    assert_eq!(bench.say("DRT? 1 2\n"), "1=100 5 \n2=0 0\n");
    bench.say("MOV X 4.9\n");
    bench.run_to_rest();
    assert_eq!(recorded(&mut bench), 0.0);
    bench.say("MOV X 10\n");
    bench.run_to_rest();
    let record = rows(&ask(&mut bench, "DRR?"));
    assert_eq!(record.len(), 100);
    assert!(record[39][0] < 5.0 && record[40][0] >= 5.0, "{record:?}");
    assert_eq!(record[40][1], 0.0);
    assert!((record[0][1] + 40.0 * 5e-5).abs() < 1e-9);
    // Another signal in the table takes the trigger with it.
    assert_eq!(bench.error_after("DRC 1 Y 1"), "0");
    assert_eq!(bench.say("DRT? 1\n"), "1=0 0\n");
}

#[test]
fn a_fault_triggers_and_disarming_does_not() {
    for armed in [true, false] {
        let mut bench = Bench::ready();
        bench.say("SPA 1 0x16000201 20 1 0x54500900 5\nDRC 1 0 202 2 0 203\nDRT 0 102 0\n");
        if !armed {
            assert_eq!(bench.error_after("DRT 0 0 0"), "0");
        }
        bench.run(30);
        bench.tick.fail(FaultKind::EncoderCrc, Some(1));
        bench.run(30);
        if !armed {
            assert_eq!(recorded(&mut bench), 0.0);
            continue;
        }
        let record = rows(&ask(&mut bench, "DRR? 1 20 1 2"));
        assert_eq!(record[4], [1.0, 0.0]);
        assert_eq!(record[5], [3.0, 2.0]);
    }
}

#[test]
fn changes_count_for_a_record_that_waits() {
    let mut bench = Bench::ready();
    bench.say("SPA 1 0x16000201 5\nDRT 0 2 0\n");
    assert_eq!(bench.error_after("DRC 1 W 1\nRTR 7"), "0");
    bench.say("MOV W 10\n");
    bench.run(60);
    let answer = ask(&mut bench, "DRR? 1 5 1");
    assert!(answer.contains("commanded position of W, deg"), "{answer}");
    assert!(
        answer.contains("# SAMPLE_TIME = 0.00035 \n") || answer.contains("0.00035"),
        "{answer}"
    );
}

#[test]
fn fewer_tables_leave_room_for_more_points() {
    let mut bench = Bench::ready();
    for table in 2..=8 {
        bench.say(&format!("DRC {table} 0 0\n"));
    }
    assert_eq!(bench.error_after("SPA 1 0x16000201 18433"), "17");
    assert_eq!(bench.error_after("SPA 1 0x16000201 17408"), "0");
    // More tables leave fewer again.
    assert_eq!(bench.error_after("DRC 2 Y 1"), "0");
    assert_eq!(bench.say("SPA? 1 0x16000201\n"), "1 0x16000201=8704\n");
    assert_eq!(bench.error_after("DRC 3 W 1 4 X 70"), "0");
    assert_eq!(bench.error_after("SPA 1 0x16000201 4096"), "0");
    // The three errors of the pose, and five signals more, are the widest.
    assert_eq!(bench.error_after("DRC 1 X 3 2 Y 3 3 W 3"), "0");
    assert_eq!(
        bench.error_after("DRC 4 1 73 5 2 73 6 3 73 7 0 201 8 0 204"),
        "0"
    );
    assert_eq!(bench.say("SPA? 1 0x16000201\n"), "1 0x16000201=1582\n");
}

/// A connection that takes little at a time gets the same answer, and single bytes and others are served meanwhile.
#[test]
fn a_long_answer_holds_nobody_up() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("DRT 0 4 0"), "0");
    bench.run(2100);
    let whole = ask(&mut bench, "DRR?");
    assert!(whole.len() > 100_000, "{}", whole.len());
    assert_eq!(rows(&whole).len(), 2048);

    let other = bench.connect();
    bench.offer(0, b"DRR?\nCSV?\n");
    let mut slow = bench.answers_of(0);
    let mut services = 0;
    while !slow.ends_with(b"\n2.0\n") {
        services += 1;
        assert!(services < 100_000);
        // No room in three of four services.
        bench
            .session(0)
            .set_room(if services % 4 == 0 { 500 } else { 0 });
        if services == 100 {
            bench.offer(0, b"\x05");
        }
        let before = slow.len();
        bench.run(1);
        slow.extend(bench.answers_of(0));
        let written = slow.len() - before;
        assert!(written <= 500 || services == 100, "{written}");
        if services % 100 == 0 {
            bench.offer(other, b"POS? X\n");
            bench.run(1);
            assert_eq!(bench.answers_of(other), b"X=0.000000000\n");
        }
    }
    // Single bytes are answered between two lines.
    let slow = String::from_utf8(slow).unwrap();
    assert_eq!(slow.replacen(" \n0\n", " \n", 1), whole + "2.0\n");
    assert_eq!(slow.matches(" \n0\n").count(), 1);
}

#[test]
fn a_record_that_is_replaced_while_it_is_read() {
    let mut bench = Bench::ready();
    bench.say("SPA 1 0x16000201 500\nDRT 0 4 0\n");
    bench.run(600);
    let other = bench.connect();
    bench.session(0).set_room(1 << 14);
    bench.offer(0, b"DRR?\n");
    bench.run(100);
    assert_eq!(bench.say_to(other, "DRT 0 4 0\nERR?\n"), "0\n");
    bench.session(0).set_room(1 << 20);
    bench.run(600);
    let answer = String::from_utf8(bench.answers_of(0)).unwrap();
    let rows = rows(&answer);
    assert_eq!(rows.len(), 500, "as many as the head says");
    assert!(rows[0][0] == 0.0 && rows[499][0].is_nan());
    assert_eq!(bench.say("ERR?\n"), "77\n");
}
