//! What the unmodified image makes of a flash that keeps nothing, and of one that keeps the machine's settings. Needs `cargo stage`
//! first, then `cargo chip-test`.

use firmware::parameters::Parameters;
use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Bench, elf_file};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// What the image answers to these lines on a board of this machine, and whether a bridge was ever awake.
fn asked(parameters: &Parameters, lines: &'static [u8]) -> (String, bool) {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let (send, receive) = mpsc::channel();
    let (mut answers, mut awake) = (Vec::new(), false);
    let outcome = bench
        .commissioned_as(parameters)
        .run(move |period| {
            answers.extend(period.received());
            awake |= period.pins.iter().any(|pins| pins.awake);
            match period.tick {
                20 => period.send(lines),
                600 => {
                    let text = String::from_utf8_lossy(&answers).into_owned();
                    send.send((text, awake)).expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    receive.recv().expect("the last period")
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
    let margin = readings
        .lines()
        .find(|line| line.starts_with("FRAME_MARGIN="));
    assert!(
        margin.is_some_and(|line| line.trim_end().ends_with("ok")),
        "{readings}"
    );
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
