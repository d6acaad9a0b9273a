//! `WPA`, `RPA` and macros over a restart: what is kept, when, and what is said when it cannot be.

mod flash_bench;

use firmware::calibration::MachineCalibration;
use firmware::control::ServoReport;
use firmware::control::config::Config;
use firmware::control::servo::Learnt;
use firmware::fault::FaultKind;
use firmware::gcs::STORED_BYTES;
use flash_bench::gcs_bench::Bench;
use flash_bench::{Flash, KeptBench};

/// As on the chip.
const SECTOR: usize = 16 << 10;
/// Whatever is stored, there is room for all of it.
const _: () = assert!(STORED_BYTES <= SECTOR);
const SPEED: &str = "0x54500100";
const WINDOW: &str = "0x54500400";

fn start() -> KeptBench<SECTOR> {
    KeptBench::start(Flash::new())
}

fn value(bench: &mut KeptBench<SECTOR>, id: &str) -> f64 {
    bench.bench.value(&format!("SPA? 1 {id}"))
}

#[test]
fn what_is_kept_is_there_after_a_restart_and_the_rest_is_not() {
    let mut bench = start();
    assert_eq!(
        bench.error_after(&format!(
            "SPA 1 {SPEED} 120 1 {WINDOW} 3\nWPA 100\nSPA 1 {SPEED} 90"
        )),
        "0"
    );
    assert_eq!(value(&mut bench, SPEED), 90.0);
    let mut bench = bench.restart();
    assert_eq!(value(&mut bench, SPEED), 120.0);
    assert_eq!(value(&mut bench, WINDOW), 3.0);
    // What the tick and the plans compute with is the same.
    assert_eq!(bench.say("VLS?\n"), "120\n");
    assert_eq!(bench.error_after("VLS 130"), "8");
}

#[test]
fn single_parameters_are_kept_by_name() {
    let mut bench = start();
    let lines = format!("SPA 1 {SPEED} 120 1 {WINDOW} 3\nWPA 100 1 {WINDOW}");
    assert_eq!(bench.error_after(&lines), "0");
    let mut bench = bench.restart();
    assert_eq!(value(&mut bench, SPEED), 200.0);
    assert_eq!(value(&mut bench, WINDOW), 3.0);
}

#[test]
fn what_was_kept_comes_back_by_rpa() {
    let mut bench = start();
    let lines = format!("SPA 1 {SPEED} 120 1 {WINDOW} 3\nWPA 100");
    assert_eq!(bench.error_after(&lines), "0");
    let lines = format!("SPA 1 {SPEED} 90 1 {WINDOW} 5\nRPA 1 {SPEED}");
    assert_eq!(bench.error_after(&lines), "0");
    assert_eq!(value(&mut bench, SPEED), 120.0);
    assert_eq!(value(&mut bench, WINDOW), 5.0);
    assert_eq!(bench.error_after("RPA"), "0");
    assert_eq!(value(&mut bench, WINDOW), 3.0);
    assert!(bench.say("EVT?\n").contains("parameters as they are kept"));
}

/// One identifier for all pivots, one for each: a pivot whose value is the controller's own keeps it beside others that are not.
#[test]
fn what_each_pivot_has_of_its_own_is_kept_apart() {
    const ALL: &str = "0x54500800";
    const EACH: [&str; 3] = ["0x54500810", "0x54500820", "0x54500830"];
    let mut bench = start();
    let lines = format!(
        "CCL 1 ADVANCED\nSPA 1 0x54500106 8 1 {ALL} 0.065\nSPA 1 {} 0.06 1 {} 0.07",
        EACH[1], EACH[2]
    );
    assert_eq!(bench.error_after(&lines), "0");
    let told = [0.065, 0.06, 0.07];
    assert_eq!(EACH.map(|id| value(&mut bench, id)), told);
    // As the first pivot's.
    assert_eq!(value(&mut bench, ALL), 0.065);
    assert_eq!(bench.error_after("WPA 100"), "0");
    let mut bench = bench.restart();
    assert_eq!(EACH.map(|id| value(&mut bench, id)), told);
    // All of them come back by the one name.
    let lines = format!("CCL 1 ADVANCED\nSPA 1 {ALL} 0.062\nRPA 1 {ALL}");
    assert_eq!(bench.error_after(&lines), "0");
    assert_eq!(EACH.map(|id| value(&mut bench, id)), told);
}

#[test]
fn macros_are_kept_as_they_are_recorded_and_deleted() {
    let mut bench = start();
    assert_eq!(
        bench.error_after("MAC BEG one\nMOV X 5\nDEL 10\nMAC END"),
        "0"
    );
    assert_eq!(bench.error_after("MAC BEG two\nMOV Y $1\nMAC END"), "0");
    let mut bench = bench.restart();
    assert_eq!(bench.say("MAC?\n"), "one \ntwo\n");
    assert_eq!(bench.say("MAC? one\n"), "MOV X 5 \nDEL 10\n");
    assert_eq!(bench.error_after("MAC START two 4"), "0");
    bench.bench.run_to_rest();
    assert_eq!(bench.say("MOV? Y\n"), "Y=4\n");
    assert_eq!(bench.error_after("MAC DEL one"), "0");
    let mut bench = bench.restart();
    assert_eq!(bench.say("MAC?\n"), "two\n");
    // Parameters that nobody asked to keep are not kept by the way.
    let lines = format!("SPA 1 {SPEED} 120\nMAC BEG three\nDEL 1\nMAC END");
    assert_eq!(bench.error_after(&lines), "0");
    let mut bench = bench.restart();
    assert_eq!(bench.say("MAC?\n"), "two \nthree\n");
    assert_eq!(value(&mut bench, SPEED), 200.0);
}

#[test]
fn a_flash_full_of_macros_is_kept() {
    let mut bench = start();
    for number in 0..16 {
        let line = format!("VAR A {:028}\n", number);
        let lines = line.repeat(12);
        assert_eq!(
            bench.error_after(&format!("MAC BEG macro_number_{number:02}\n{lines}MAC END")),
            "0"
        );
    }
    let (before, free) = (
        bench.say("MAC? macro_number_07\n"),
        bench.say("MAC FREE?\n"),
    );
    let mut bench = bench.restart();
    assert_eq!(bench.say("MAC? macro_number_07\n"), before);
    assert_eq!(bench.say("MAC FREE?\n"), free);
}

/// A calibration is stored however full the memory of macros is.
#[test]
fn macros_leave_room_for_a_calibration() {
    let mut bench = start();
    for number in 0..16 {
        let line = format!("VAR A {number:028}\n");
        let name = format!("macro_number_{number:02}");
        assert_eq!(
            bench.error_after(&format!("MAC BEG {name}\n{}MAC END", line.repeat(12))),
            "0"
        );
    }
    assert_eq!(bench.say("MAC DEL macro_number_00\n"), "");
    let free: usize = bench.say("MAC FREE?\n").trim().parse().expect("a number");
    let lines = "VAR A 1\n".repeat(free / "VAR A 1\n".len());
    assert_eq!(
        bench.error_after(&format!("MAC BEG more\n{lines}MAC END")),
        "0"
    );
    let free = bench.say("MAC FREE?\n");
    assert!(
        free.trim().parse::<usize>().is_ok_and(|free| free < 8),
        "{free}"
    );
    let serial = bench.say("SSN?\n").trim().to_owned();
    let calibration = MachineCalibration {
        serial: serial.as_str().try_into().expect("a short text"),
        date: "2026-11-25".try_into().expect("a short text"),
        temperature_c: Some(20.0),
        numbers: [[1e-6; 48]; 3],
        is_on: true,
    };
    let mut lines = format!("CCL 1 ADVANCED\nCAL BEG {serial} 2026-11-25 20\n");
    for (pivot, first) in (1..=3).flat_map(|pivot| (0..6).map(move |part| (pivot, 8 * part + 1))) {
        lines += &format!("CAL SET {pivot} {first}{}\n", " 1e-6".repeat(8));
    }
    assert_eq!(bench.error_after(lines.trim_end()), "0");
    assert_eq!(bench.error_after("SVO X 0"), "0");
    bench.bench.run(4_000);
    let end = format!("CAL END {}", calibration.checksum());
    assert_eq!(bench.error_after(&end), "0");
    let told = bench.say("CAL?\n");
    assert!(told.starts_with("STATE=ON"), "{told}");
    let mut bench = bench.restart();
    assert_eq!(bench.say("CAL?\n"), told);
    assert_eq!(bench.say("MAC FREE?\n"), free);
}

#[test]
fn refusals_have_their_numbers_and_keep_nothing() {
    let mut bench = start();
    let steps = bench.keeper.flash().steps;
    let refusals = [
        ("WPA", "24"),
        ("WPA 101", "56"),
        ("WPA PASSWORD", "56"),
        ("WPA 100 1", "24"),
        ("WPA 100 1 12345", "54"),
        ("WPA 100 Q 12345", "15"),
        ("WPA 100 1 0xE000200", "64"),
        ("RPA 1 12345", "54"),
        ("RPA 1 0xE000200", "64"),
    ];
    for (line, error) in refusals {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.keeper.flash().steps, steps);
}

#[test]
fn in_motion_nothing_is_written() {
    let mut bench = start();
    assert_eq!(bench.error_after("VLS 1\nMOV X 5"), "0");
    let steps = bench.keeper.flash().steps;
    assert_eq!(bench.error_after("WPA 100"), "53");
    assert_eq!(bench.error_after("RPA"), "53");
    assert_eq!(bench.error_after("MAC BEG later\nDEL 1\nMAC END"), "0");
    assert_eq!(bench.keeper.flash().steps, steps);
    // The macro is kept once the stage is at rest.
    assert_eq!(bench.error_after("HLT"), "10");
    bench.bench.run_to_rest();
    bench.say("");
    assert!(bench.keeper.flash().steps > steps);
    assert_eq!(bench.restart().say("MAC?\n"), "later\n");
}

#[test]
fn what_needs_the_servo_off_does_not_come_back_with_it_on() {
    const ZERO: &str = "0x54500600";
    let mut bench = start();
    let lines =
        format!("CCL 1 ADVANCED\nSVO X 0\nSPA 1 {ZERO} 77\nWPA 100\nSPA 1 {ZERO} 0\nSVO X 1");
    assert_eq!(bench.error_after(&lines), "0");
    assert_eq!(bench.error_after("RPA"), "89");
    // At level 0 too: it is what was set up.
    assert_eq!(bench.error_after("SVO X 0\nCCL 0\nRPA"), "0");
    assert_eq!(value(&mut bench, ZERO), 77.0);
}

#[test]
fn a_flash_that_takes_nothing_is_told() {
    let mut bench = start();
    bench.keeper.flash().cut_in(0, 1);
    assert_eq!(bench.error_after("WPA 100"), "4001");
    assert!(
        bench
            .say("EVT?\n")
            .contains("settings could not be kept, error 4001")
    );
    assert_eq!(bench.error_after("MAC BEG A\nDEL 1\nMAC END"), "0");
    assert_eq!(bench.error_after(""), "4001");
    // In force it is all the same.
    assert_eq!(bench.say("MAC?\n"), "A\n");
}

/// A move from rest whose table has so many trials behind it: none.
fn with_a_table(bench: &mut KeptBench<SECTOR>) {
    assert_eq!(bench.error_after("ILC LEARN OUT"), "0");
    bench.say("MOV X 1\n");
    bench.bench.run(4_000);
    assert!(bench.say("ILC?\n").starts_with("OUT=learning "));
}

#[test]
fn a_table_is_told_as_kept_only_when_it_is() {
    let mut bench = start();
    with_a_table(&mut bench);
    let good = bench.keeper.flash().powered();
    // A flash that takes nothing, and then one that takes everything.
    bench.keeper.flash().cut_in(0, 1);
    assert_eq!(bench.error_after("ILC KEEP OUT"), "4001");
    assert!(bench.say("ILC?\n").contains("KEPT=0"));
    *bench.keeper.flash() = good;
    assert_eq!(bench.error_after("ILC KEEP OUT"), "0");
    assert!(bench.say("ILC?\n").contains("KEPT=1"));
    // What is stored of it stays when it can not be stored again, and is told so.
    let good = bench.keeper.flash().powered();
    bench.keeper.flash().cut_in(0, 2);
    assert_eq!(bench.error_after("ILC KEEP OUT"), "4001");
    assert!(bench.say("ILC?\n").contains("KEPT=1"));
    // Forgetting that can not be stored is told to all; the next store does it.
    assert_eq!(bench.error_after("ILC FORGET OUT"), "0");
    assert_eq!(bench.error_after(""), "4001");
    *bench.keeper.flash() = good;
    let mut bench = {
        assert_eq!(bench.error_after("WPA 100"), "0");
        bench.restart()
    };
    assert_eq!(bench.say("ILC?\n"), "\n");
}

#[test]
fn a_table_is_kept_at_rest_and_over_nothing_that_is_damaged() {
    let mut bench = start();
    with_a_table(&mut bench);
    bench.say("MOV X 20\n");
    assert_eq!(bench.error_after("ILC KEEP OUT"), "53");
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("ILC LEARN OUT\nMOV X 1"), "0");
    bench.run(4_000);
    // Nobody keeps settings.
    assert_eq!(bench.error_after("ILC KEEP OUT"), "34");
    assert!(bench.say("ILC?\n").contains("KEPT=0"));
}

#[test]
fn without_a_keeper_it_is_refused() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("WPA 100"), "34");
    assert_eq!(bench.error_after("RPA"), "34");
}

#[test]
fn damage_is_overwritten_by_wpa_alone() {
    let mut bench = start();
    assert_eq!(
        bench.error_after(&format!("SPA 1 {SPEED} 120\nWPA 100")),
        "0"
    );
    let mut flash = bench.keeper.flash().powered();
    // In the image of the only record.
    flash.bytes[38] ^= 4;
    let damaged = flash.clone();
    let mut panel = flash_bench::fresh();
    let mut keeper = firmware::settings_store::SettingsStore::new(flash);
    let problem = flash_bench::restore(&mut keeper, &mut panel);
    assert_eq!(problem, Some(FaultKind::SettingsDamaged));
    let mut bench = KeptBench {
        bench: Bench::with(panel),
        keeper,
    };
    bench.bench.tick.fail(FaultKind::SettingsDamaged, None);
    bench.say("");
    assert_eq!(value(&mut bench, SPEED), 200.0);
    assert!(bench.say("FLT?\n").starts_with("kept settings are damaged"));
    assert_eq!(bench.error_after("FRF"), "1024");
    assert_eq!(bench.error_after("SVO X 1"), "1024");
    assert_eq!(bench.error_after("FLC"), "0");
    assert_eq!(bench.error_after("FRF"), "0");
    assert_eq!(bench.error_after("MAC BEG A\nDEL 1\nMAC END"), "0");
    assert!(
        bench.keeper.flash().bytes == damaged.bytes,
        "written by the way"
    );
    assert_eq!(bench.error_after("WPA 100"), "0");
    let mut bench = bench.restart();
    assert_eq!(bench.say("MAC?\n"), "A\n");
}

/// The tick tells of one servo at a time.
fn tell_of_servos(bench: &mut KeptBench<SECTOR>, weight: f32) {
    for pivot in 0..3 {
        bench.bench.tick.now.servo = ServoReport {
            pivot,
            learnt: Learnt {
                weights: [weight, 0.25, pivot as f32],
                motor_constant_excess: -0.5,
            },
            integral_v: 1.5,
            current_knees: 100.0,
        };
        bench.bench.run(2);
    }
}

#[test]
fn what_was_learnt_is_told_kept_and_what_the_tick_starts_with() {
    let mut bench = start();
    tell_of_servos(&mut bench, 0.125);
    let told = bench.say("LST?\n");
    // 100 knees of 0.043 A.
    for line in [
        "LEARNT3=0.12500 0.25000 2.00000 -0.50000 ",
        "INTEGRAL3=1.5000 ",
        "CURRENT3=4.3000 ",
    ] {
        assert!(told.lines().any(|one| one == line), "{line} in {told}");
    }
    assert_eq!(bench.error_after("WPA 100"), "0");
    let before = bench.bench.tick.config.clone();
    let mut bench = bench.restart();
    let ids = ["0x54500B10", "0x54500B21", "0x54500B32", "0x54500B33"];
    let kept = ids.map(|id| value(&mut bench, id));
    assert_eq!(kept, [0.125, 0.25, 2.0, -0.5]);
    // To the bit what it had.
    assert_eq!(Config::new(bench.bench.panel().parameters()), before);
}

/// The tick tells of the servos one after the other: what was told of one before counts no more.
#[test]
fn what_is_set_of_it_is_kept_as_it_was_set() {
    let mut bench = start();
    tell_of_servos(&mut bench, 0.125);
    bench.bench.tick.now.servo.pivot = 0;
    bench.bench.run(2);
    assert_eq!(bench.error_after("SVO X 0"), "0");
    let lines = "CCL 1 ADVANCED\nSPA 1 0x54500B33 -0.25\nWPA 100";
    assert_eq!(bench.error_after(lines), "0");
    let mut bench = bench.restart();
    assert_eq!(value(&mut bench, "0x54500B33"), -0.25);
}

/// Parameter 0x5450030B: the servo going off is enough, where it has changed by more than nothing much.
#[test]
fn what_was_learnt_is_kept_by_itself_where_that_is_asked_for() {
    for (asked, weight, kept) in [(1, 0.125, 0.125), (0, 0.125, 0.0), (1, 0.005, 0.0)] {
        let mut bench = start();
        let lines = format!("CCL 1 ADVANCED\nSPA 1 0x5450030B {asked}\nWPA 100");
        assert_eq!(bench.error_after(&lines), "0");
        // Friction is what it was.
        for pivot in 0..3 {
            bench.bench.tick.now.servo = ServoReport {
                pivot,
                learnt: Learnt {
                    weights: [weight, 0.0, 0.0],
                    motor_constant_excess: 0.0,
                },
                ..ServoReport::default()
            };
            bench.bench.run(2);
        }
        assert_eq!(bench.error_after("SVO X 0"), "0");
        bench.say("\n");
        let mut bench = bench.restart();
        assert_eq!(value(&mut bench, "0x54500B10"), kept, "{asked} {weight}");
    }
}
