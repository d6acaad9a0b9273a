//! What the tests of the chip share: the image, changed or not, and what it answers to some lines.
#![allow(dead_code, reason = "every test file uses its own part")]

use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Bench, Period, elf_file};
use image::proof::Code;
use image::seal::unseal;
use object::{Object, ObjectSegment};
use std::ops::ControlFlow::{Break, Continue};
use std::path::PathBuf;
use std::sync::mpsc;

pub fn path() -> PathBuf {
    elf_file::find().expect("the image: build it with `cargo stage`")
}

/// The image as it was linked: `cargo seal` may have been there before.
pub fn whole() -> Vec<u8> {
    unseal(std::fs::read(path()).expect("the image"))
        .expect("an image with a place for its checksum")
}

/// Where a function begins.
pub fn address(function: &str) -> u64 {
    let code = Code::read(&path()).expect("an image that can be taken apart");
    code.named(function).expect("the function")
}

/// Where in the file an address lies.
pub fn offset(image: &[u8], at: u64) -> usize {
    let file = object::File::parse(image).expect("an image");
    let segment = file
        .segments()
        .find(|segment| (segment.address()..segment.address() + segment.size()).contains(&at));
    let segment = segment.expect("it is loaded");
    (segment.file_range().0 + at - segment.address()) as usize
}

pub fn write(image: &mut [u8], at: u64, bytes: &[u8]) {
    let place = offset(image, at);
    image[place..place + bytes.len()].copy_from_slice(bytes);
}

pub fn bench() -> Bench {
    of(whole())
}

pub fn of(image: Vec<u8>) -> Bench {
    let stage = Stage::new(&StageParameters::REFERENCE);
    Bench::from_elf(image, stage).expect("an image with its symbols")
}

/// What is answered to lines that are sent at one tick, until another, with a look before each.
pub fn answers(
    bench: Bench,
    lines: &'static [u8],
    [sent, taken]: [u64; 2],
    mut before_tick: impl FnMut(&mut Period<'_>) + Send + 'static,
) -> String {
    let (send, receive) = mpsc::channel();
    let outcome = bench
        .run(move |period| {
            before_tick(period);
            if period.tick == sent {
                drop(period.received());
                period.send(lines);
            }
            if period.tick < taken {
                return Continue(());
            }
            let told = String::from_utf8_lossy(&period.received()).into_owned();
            send.send(told).expect("the test waits");
            Break(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    receive.recv().expect("the last period")
}
