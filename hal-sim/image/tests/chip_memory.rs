//! What the unmodified image still knows after a reset. Needs `cargo stage` first, then `cargo chip-test`.

use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Action, Bench, elf_file};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// The loop is halted in motion, the watchdog resets the chip: events and the last ticks before it can be read afterwards.
#[test]
fn events_and_the_last_ticks_survive_the_watchdogs_reset() {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let (send, receive) = mpsc::channel();
    let mut answers = Vec::new();
    let outcome = bench
        .run(move |period| {
            answers.extend(period.received());
            match (period.resets.len(), period.tick) {
                (0, 20) => period.send(b"FRF X\n"),
                (0, 100) => period.send(b"MOV X 20 W 30\n"),
                (0, 500) => {
                    let at = period.tick_at_ns();
                    period.at(at, Action::HaltLoop);
                }
                (1, 100) => period.send(b"EVT?\nFLR?\n"),
                // 256 rows of some 150 bytes at 92,160 bytes a second.
                (1, 16_000) => {
                    let text = String::from_utf8_lossy(&answers).into_owned();
                    send.send(text).expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    let text = receive.recv().expect("the last period");
    let (events, record) = text
        .split_once("# DIM")
        .expect("a record behind the events");
    for told in [
        "1 0 start",
        "referenced",
        "servo on",
        "start by the watchdog",
    ] {
        assert!(events.contains(told), "{told}: {events}");
    }
    let (_, rows) = record.split_once("# END_HEADER \n").expect("a head");
    let ticks: Vec<u32> = rows
        .lines()
        .map(|row| row.split(' ').next().and_then(|tick| tick.parse().ok()))
        .map(|tick| tick.expect("a tick"))
        .collect();
    assert!(ticks.len() >= 255, "{} rows", ticks.len());
    assert!(
        ticks.windows(2).all(|pair| pair[0] + 1 == pair[1]),
        "{ticks:?}"
    );
    let last = *ticks.last().expect("rows");
    assert!(
        (498..=502).contains(&last),
        "the last before the halt: {last}"
    );
}
