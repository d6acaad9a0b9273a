//! The retained memory on the simulated machine: what has happened, and the ticks around a fault, after a reset too.

use firmware::fault::FaultKind;
use firmware::fault_record::{FAULT_RECORD_ROWS, ROWS_AFTER_FAULT};
use firmware::gcs::START_CAUSES;
use firmware::mode::Mode;
use tests::Bench;

/// A row of `FLR?`: tick, mode, fault, then pivots, errors, duties, currents, supply, cost.
fn record(bench: &mut Bench) -> Vec<Vec<f64>> {
    let answer = bench.say("FLR?\n");
    let (head, rows) = answer.split_once("# END_HEADER \n").expect("a head");
    let rows: Vec<Vec<f64>> = rows
        .lines()
        .map(|line| {
            let numbers = line.split_whitespace().map(str::parse);
            numbers.collect::<Result<_, _>>().expect("numbers")
        })
        .collect();
    assert!(
        head.contains(&format!("# NDATA = {} \n", rows.len())),
        "{head}"
    );
    rows
}

fn faulted() -> Bench {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("FLR?"), "77", "nothing has happened yet");
    bench.send("MOV X 40 W 100\n");
    bench.run(2_000);
    bench.rig.front.emergency_stop = true;
    bench.run(500);
    assert_eq!(bench.mode(), Mode::Fault);
    bench.rig.front.emergency_stop = false;
    assert_eq!(bench.error_after(""), "1024");
    bench
}

#[test]
fn the_ticks_around_a_fault_can_be_read_until_the_servo_is_on() {
    let mut bench = faulted();
    let tick = bench.fault().expect("a fault").tick as f64;
    let rows = record(&mut bench);
    assert_eq!(rows.len(), FAULT_RECORD_ROWS);
    for (number, row) in rows.iter().enumerate() {
        let at = tick + f64::from(ROWS_AFTER_FAULT) - FAULT_RECORD_ROWS as f64 + number as f64;
        assert_eq!(row[0], at, "every tick, in order");
        // Mode and fault: moving before, then latched as the seventh kind.
        let expected = if at < tick { [2.0, 0.0] } else { [3.0, 7.0] };
        assert_eq!(row[1..3], expected, "tick {at}");
        let driven = row[9..12].iter().any(|duty| *duty != 0.0);
        assert_eq!(driven, at < tick, "tick {at}");
        assert!((row[15] - 48.0).abs() < 0.1, "supply {}", row[15]);
    }
    bench.run(5_000);
    assert_eq!(bench.error_after("FLC"), "0");
    assert_eq!(record(&mut bench), rows, "acknowledged, and still there");
    assert_eq!(bench.error_after("FRF"), "0");
    assert_eq!(bench.error_after("FLR?"), "77");
}

/// A controlled stop is longer than the record: it is the fault that counts, not the end of the stop.
#[test]
fn the_record_of_a_controlled_stop_is_that_of_its_beginning() {
    let mut bench = Bench::ready();
    bench.send("MOV X 40 W 100\n");
    bench.run(2_000);
    bench.rig.front.late = true;
    bench.run_until("found", |bench| bench.mode() == Mode::Stopping);
    bench.rig.front.late = false;
    let tick = bench.fault().expect("a fault").tick as f64;
    bench.run_until("stopped", |bench| bench.mode() == Mode::Fault);
    let rows = record(&mut bench);
    let last = rows.last().map(|row| row[0]);
    assert_eq!(last, Some(tick + f64::from(ROWS_AFTER_FAULT) - 1.0));
}

#[test]
fn a_record_of_the_users_own_changes_nothing() {
    let mut bench = Bench::ready();
    bench.say("DRC 1 X 1\nDRT 1 1 0\n");
    bench.send("STE X 1\nMOV X 40\n");
    bench.run(2_000);
    bench.rig.front.emergency_stop = true;
    bench.run(100);
    assert_eq!(record(&mut bench).len(), FAULT_RECORD_ROWS);
}

#[test]
fn events_and_record_survive_a_reset() {
    let mut bench = faulted();
    let rows = record(&mut bench);
    let before = bench.say("EVT?\n");
    bench.reset(START_CAUSES[0]);
    bench.run(10);
    let after = bench.say("EVT?\n");
    let kept = after
        .strip_prefix(before.trim_end())
        .expect("what was there");
    assert!(kept.contains("start by the watchdog"), "{kept}");
    let numbers: Vec<u32> = (after.lines())
        .map(|line| {
            line.split(' ')
                .next()
                .and_then(|number| number.parse().ok())
        })
        .map(|number| number.expect("a number"))
        .collect();
    let expected: Vec<u32> = (1..=numbers.len() as u32).collect();
    assert_eq!(numbers, expected, "they go on");
    assert_eq!(record(&mut bench), rows);
}

/// The loop stands still in the middle of a motion, and no fault is latched before the reset.
#[test]
fn a_reset_in_motion_leaves_the_last_ticks_before_it() {
    let mut bench = Bench::ready();
    bench.send("MOV X 40 W 100\n");
    bench.run(1_500);
    let last = bench.sample().tick as f64;
    bench.reset(START_CAUSES[0]);
    bench.run(100);
    let rows = record(&mut bench);
    assert_eq!(rows.len(), FAULT_RECORD_ROWS);
    assert_eq!(rows.last().map(|row| (row[0], row[1])), Some((last, 2.0)));
}

#[test]
fn more_events_than_there_is_room_for_keep_their_numbers_over_resets() {
    let mut bench = Bench::ready();
    for _ in 0..40 {
        bench.say("SVO X 0\nSVO X 1\n");
    }
    let before = bench.say("EVT?\n");
    assert_eq!(before.lines().count(), 64);
    bench.reset(START_CAUSES[1]);
    bench.run(10);
    let after = bench.say("EVT?\n");
    assert_eq!(after.lines().count(), 64);
    let number = |line: Option<&str>| -> u32 {
        let number = line.and_then(|line| line.split(' ').next());
        number
            .and_then(|number| number.parse().ok())
            .expect("a number")
    };
    assert_eq!(
        number(after.lines().last()),
        number(before.lines().last()) + 1
    );
    assert_eq!(
        number(after.lines().next()),
        number(before.lines().next()) + 1
    );
}

#[test]
fn a_hot_motor_is_hot_after_a_restart_and_a_reset() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.error_after("CCL 1 ADVANCED\nSPA 1 0x54500509 0.1\nWPA 100"),
        "0"
    );
    bench.send("MOV X 60 W 3600\n");
    bench.run_until("a hot motor", |bench| bench.fault_kind().is_some());
    assert_eq!(bench.fault_kind(), Some(FaultKind::MotorHot));
    bench.run(20_000);
    for restart in ["RBT", "reset"] {
        bench.say("FLC\n");
        if restart == "RBT" {
            bench.send("RBT\n");
            bench.run(10);
            assert!(bench.rig.restart_if_wanted());
        } else {
            bench.reset(START_CAUSES[0]);
        }
        bench.run(100);
        assert_eq!(bench.fault_kind(), None, "{restart}");
        bench.send("FRF\n");
        bench.run(60);
        assert_eq!(bench.fault_kind(), Some(FaultKind::MotorHot), "{restart}");
    }
}
