//! The serial line of the image on the emulated chip, flooded: what is lost is lost by whole lines. Needs `cargo stage` first.
//!
//! The emulator has no noise on its lines: that damaged bytes take their line with them is for a real one to show.

use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Bench, elf_file};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// No line of these is a command, but the beginning of any with the end of any other is one that moves the stage.
const FLOOD: &[u8] = b"MOV X 5               BAD               \n";
/// Answered by 20 KB: 0.2 s in which the command side waits for the line and takes nothing.
const LONG: &[u8] = b"HPA?\n";
const QUESTIONS: &[u8] = b"\nERR?\nMOV? X\n";

/// Ticks of the flood: it ends while a long answer is under way, so that its last line is lost.
const FLOODED: std::ops::Range<u64> = 1_000..5_000;
/// Ticks from one to the next.
const LONG_EVERY: u64 = 3_000;
/// By then the last long answer is through.
const ASK: u64 = 11_000;
const END: u64 = 12_000;

#[test]
fn pieces_of_lines_never_make_up_one() {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let bench = Bench::load(&path, Stage::new(&StageParameters::REFERENCE)).expect("an image");
    let (tell, told) = mpsc::channel();
    let mut answers = Vec::new();
    let run = bench.run(move |period| {
        match period.tick {
            20 => period.send(b"FRF X\n"),
            tick if FLOODED.contains(&tick) => {
                if tick.is_multiple_of(LONG_EVERY) {
                    period.send(LONG);
                }
                while period.unsent() < 64 {
                    period.send(FLOOD);
                }
            }
            ASK => {
                period.received();
                period.send(QUESTIONS);
            }
            tick if tick > ASK => answers.extend(period.received()),
            _ => drop(period.received()),
        }
        if period.tick < END {
            return Continue(());
        }
        tell.send(String::from_utf8_lossy(&answers).into_owned())
            .expect("the test waits");
        Break(())
    });
    assert_eq!(run.expect("a run").gaps, Vec::<String>::new());
    let answers = told.recv().expect("the last period");
    // It stands where it was found.
    let place_mm = answers
        .strip_prefix("304\nX=")
        .and_then(|x| x.trim_end().parse::<f64>().ok());
    assert!(place_mm.is_some_and(|x| x.abs() < 1e-4), "{answers}");
}
