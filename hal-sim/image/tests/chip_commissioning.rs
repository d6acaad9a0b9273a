//! What the unmodified image makes of a flash that keeps nothing, and of one that keeps the machine's settings. Needs `cargo stage`
//! first, then `cargo chip-test`.

mod asked;

use asked::{answers, bench};
use firmware::parameters::Parameters;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What the image answers to these lines on a board of this machine, and whether a bridge was ever awake.
fn asked(parameters: &Parameters, lines: &'static [u8]) -> (String, bool) {
    let awake = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&awake);
    let bench = bench().commissioned_as(parameters);
    let text = answers(bench, lines, [20, 600], move |period| {
        if period.pins.iter().any(|pins| pins.awake) {
            seen.store(true, Ordering::Relaxed);
        }
    });
    (text, awake.load(Ordering::Relaxed))
}

#[test]
fn an_erased_bank_drives_nothing_and_says_why() {
    let parameters = Parameters::REFERENCE.uncommissioned();
    let (answers, awake) = asked(&parameters, b"FRF\nERR?\nMOV X 1\nERR?\nCMS?\n");
    assert!(
        answers.starts_with("4005\n4005\n0 not commissioned"),
        "{answers}"
    );
    assert!(!awake, "a bridge was awake");
}

/// What the chip reads about itself; its flash size word and option bytes are as the emulator has them.
#[test]
fn the_board_tests_itself_and_has_the_number_of_its_chip() {
    let (answers, _) = asked(&Parameters::REFERENCE, b"SSN?\nTST?\n");
    let (number, readings) = answers.split_once('\n').expect("two answers");
    let wanted: String = b"emulated F42"
        .iter()
        .map(|byte| format!("{byte:02X}"))
        .collect();
    assert_eq!(number, wanted);
    for good in [
        "BOARD=reference board, STM32F427",
        "DEVICE=1049, 1049 to 1049, ok",
        "CORE=168000000 Hz, 168000000 to 168000000, ok",
        "CRYSTAL=1, 1 to 1, ok",
        "WAIT_STATES=5, 5 to 5, ok",
        "CACHES=1, 1 to 1, ok",
        "EMERGENCY_STOP=0, 0 to 0, ok",
        "BRIDGES_AWAKE=0, 0 to 0, ok",
        "ENCODER3=1, 1 to 1, ok",
        "LATE=0 ticks, 0 to 0, ok",
    ] {
        assert!(readings.contains(good), "{good}: {readings}");
    }
    let supply = readings.lines().find(|line| line.starts_with("SUPPLY="));
    assert!(
        supply.is_some_and(|line| line.trim_end().ends_with("ok")),
        "{readings}"
    );
}

#[test]
fn the_settings_of_the_machine_in_bank_2_make_it_ready() {
    let (answers, awake) = asked(&Parameters::REFERENCE, b"CMS?\nFRF\nERR?\n");
    assert_eq!(answers, "1 commissioned\n0\n");
    assert!(awake, "no bridge was awake");
}
