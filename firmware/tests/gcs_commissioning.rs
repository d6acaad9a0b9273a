//! A controller whose machine nobody has set up yet: it says so, and nothing drives.

mod flash_bench;

use firmware::gcs::{Identity, Interpreter};
use firmware::parameters::Parameters;
use firmware::settings_store::SettingsStore;
use flash_bench::gcs_bench::Bench;
use flash_bench::{Flash, KeptBench, restore};

/// As on the chip.
const SECTOR: usize = 16 << 10;
const ZERO: &str = "0x54500600";
const COMMISSIONED: &str = "0x54500C00";

/// A board as it comes, with this flash.
fn board(flash: Flash<SECTOR>) -> KeptBench<SECTOR> {
    let identity = Identity {
        serial: "4711",
        version: "0.1.0",
    };
    let mut panel = Interpreter::new(&Parameters::REFERENCE.uncommissioned(), identity);
    let mut keeper = SettingsStore::new(flash);
    assert_eq!(restore(&mut keeper, &mut panel), None);
    let mut bench = Bench::with(panel);
    bench.run(2);
    KeptBench { bench, keeper }
}

fn restarted(mut bench: KeptBench<SECTOR>) -> KeptBench<SECTOR> {
    board(bench.keeper.flash().powered())
}

#[test]
fn an_empty_store_refuses_whatever_drives_and_says_why() {
    let mut bench = board(Flash::new());
    for line in [
        "FRF", "SVO X 1", "MOV X 1", "MVR X 1", "JOG X 1", "STE X 1", "RCV 1",
    ] {
        assert_eq!(bench.error_after(line), "4005", "{line}");
    }
    bench.bench.run(200);
    assert!(
        bench.bench.tick.log.is_empty(),
        "{:?}",
        bench.bench.tick.log
    );
    assert!(bench.say("CMS?\n").starts_with("0 not commissioned"));
    let fault = bench.say("FLT?\n");
    assert!(
        fault.starts_with("0 no fault \nnot commissioned"),
        "{fault}"
    );
    // What drives nothing is no matter.
    assert_eq!(bench.error_after("SVO X 0\nSTP\nVLS 20"), "0");
}

#[test]
fn a_machine_is_commissioned_by_hand_and_stays_so() {
    let mut bench = board(Flash::new());
    assert_eq!(bench.error_after("CMS 1"), "60");
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nCMS 2"), "17");
    assert_eq!(bench.error_after(&format!("SPA 1 {ZERO} 77")), "0");
    assert_eq!(bench.error_after("FRF"), "4005");
    assert_eq!(bench.error_after("CMS 1"), "0");
    assert_eq!(bench.say("CMS?\n"), "1 commissioned\n");
    assert!(bench.say("EVT?\n").contains("0x54500C00"));
    assert_eq!(bench.error_after("WPA 100"), "0");
    let mut bench = restarted(bench);
    assert_eq!(bench.say("CMS?\n"), "1 commissioned\n");
    assert_eq!(bench.bench.value(&format!("SPA? 1 {ZERO}")), 77.0);
    bench.bench.reference();
    // Not while the servo is on.
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nCMS 0"), "89");
    assert_eq!(bench.error_after("SVO X 0\nCMS 0\nSVO X 1"), "4005");
    assert_eq!(bench.error_after("MOV X 1"), "4005");
    assert_eq!(bench.say("SVO? X\n"), "X=0\n");
}

#[test]
fn without_wpa_it_is_forgotten() {
    let mut bench = board(Flash::new());
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nCMS 1"), "0");
    let mut bench = restarted(bench);
    assert_eq!(bench.error_after("FRF"), "4005");
}

#[test]
fn it_is_a_parameter_like_others() {
    let mut bench = board(Flash::new());
    let id = format!("SPA? 1 {COMMISSIONED}");
    assert_eq!(bench.bench.value(&id), 0.0);
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nCMS 1"), "0");
    assert_eq!(bench.bench.value(&id), 1.0);
}
