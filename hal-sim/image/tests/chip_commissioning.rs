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

#[test]
fn the_settings_of_the_machine_in_bank_2_make_it_ready() {
    let (answers, awake) = asked(&Parameters::REFERENCE, b"CMS?\nFRF\nERR?\n");
    assert_eq!(answers, "1 commissioned\n0\n");
    assert!(awake, "no bridge was awake");
}
