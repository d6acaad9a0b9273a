//! How the unmodified image ends when its program goes wrong, and what it tells afterwards. The program is made to go wrong by a
//! few bytes put into a function of the image. Needs `cargo stage` first, then `cargo chip-test`.

mod asked;

use asked::{address, answers, of, offset, path, whole, write};
use image::chip::{Bench, Outcome, ResetCause};
use image::proof::Code;
use image::seal::seal;
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// `WCL 1` comes by here.
const ON_COMMAND: &str = "firmware::gcs::wave::parse::clear";
/// Every tick with the servo on does.
const IN_TICK: &str =
    "firmware::control::tick::<impl firmware::control::state::State>::step_servos";

/// `udf #0`: no instruction.
const UNDEFINED: &[u8] = &[0x00, 0xDE];
/// `movs r0, #0; mov sp, r0; udf #0`: the same without a stack.
const WITHOUT_STACK: &[u8] = &[0x00, 0x20, 0x85, 0x46, 0x00, 0xDE];
/// `b .`: an endless loop.
const HANGS: &[u8] = &[0xFE, 0xE7];

const WINDOW_WATCHDOG: u16 = 0;

/// The image with these bytes at the beginning of a function, and where that is.
fn broken(function: &str, bytes: &[u8]) -> (Vec<u8>, u64) {
    let at = address(function);
    (with_bytes_at(at, bytes), at)
}

fn with_bytes_at(at: u64, bytes: &[u8]) -> Vec<u8> {
    let mut image = whole();
    write(&mut image, at, bytes);
    image
}

/// What the chip answers to `EVT?` and `FLT?` after its first reset, and the run.
fn after_reset(
    image: Vec<u8>,
    trigger: &'static [u8],
    interrupts: Option<u16>,
) -> (String, Outcome) {
    let (send, receive) = mpsc::channel();
    let outcome = of(image)
        .run(move |period| {
            match (period.resets.len(), period.tick) {
                (0, 20) => period.send(trigger),
                (0, 200) => {
                    if let Some(number) = interrupts {
                        period.interrupt(number);
                    }
                }
                (0, 2_000) => return Break(()),
                (1.., 50) => {
                    drop(period.received());
                    period.send(b"EVT?\nFLT?\n");
                }
                (1.., 400) => {
                    let told = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send(told).expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        })
        .expect("a run");
    (
        receive.try_recv().expect("a reset, and an answer after it"),
        outcome,
    )
}

#[test]
fn a_processor_fault_is_told_with_its_place() {
    let (image, at) = broken(ON_COMMAND, UNDEFINED);
    let (told, outcome) = after_reset(image, b"WCL 1\n", None);
    println!("{told}");
    assert_eq!(outcome.resets.len(), 1);
    let place = format!("before the start: processor fault at {at:#010x}, called from 0x080");
    assert!(told.contains(&place), "{told}");
    // An undefined instruction, in CFSR.
    assert!(told.contains("status 0x00010000"), "{told}");
    // Where the stack stood, in the core-coupled memory, and that the fault was raised to a hard one (HFSR.FORCED).
    let state = told.find("before the start: stack at 0x1000");
    let state = state.map(|at| told[at..].lines().next().unwrap_or_default());
    assert!(
        state.is_some_and(|it| it.contains("hard fault status 0x40000000")),
        "{told}"
    );
    assert!(
        told.contains("start by a panic or a processor fault"),
        "{told}"
    );
}

#[test]
fn a_processor_fault_without_a_stack_ends_in_a_reset_too() {
    let (image, _) = broken(ON_COMMAND, WITHOUT_STACK);
    let (told, outcome) = after_reset(image, b"WCL 1\n", None);
    println!("{told}");
    assert_eq!(outcome.resets.len(), 1);
    assert!(
        told.contains("before the start: processor fault, its stack lost"),
        "{told}"
    );
}

/// Bytes that panic: `core`'s check of an index is called, told a place in a source file that stands behind.
fn panics(at: u64, check: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    if !at.is_multiple_of(4) {
        bytes.extend([0x00, 0xBF]); // nop
    }
    let begin = at + bytes.len() as u64;
    bytes.extend([0x01, 0xA2]); // adr r2, begin + 8
    let offset = check.wrapping_sub(begin + 2 + 4) as u32;
    let [sign, i1, i2] = [24, 23, 22].map(|bit| offset >> bit & 1);
    let [j1, j2] = [i1, i2].map(|bit| (bit ^ 1) ^ sign);
    let high = 0xF000 | sign << 10 | offset >> 12 & 0x3FF;
    let low = 0xD000 | j1 << 13 | j2 << 11 | offset >> 1 & 0x7FF;
    bytes.extend((high as u16).to_le_bytes()); // bl check
    bytes.extend((low as u16).to_le_bytes());
    bytes.extend([0x00, 0xBF]);
    let file = b"src/some/place.rs\0";
    // The place: file, its length, line, column.
    for word in [begin as u32 + 24, file.len() as u32 - 1, 4711, 5] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(file);
    bytes
}

#[test]
fn a_panic_is_told_with_its_place_and_lets_the_motors_coast() {
    let code = Code::read(&path()).expect("an image that can be taken apart");
    let at = code.named(ON_COMMAND).expect("the function");
    let check = (code.functions.iter())
        .find(|(_, it)| it.name.ends_with("panicking::panic_bounds_check"))
        .map(|(at, _)| *at)
        .expect("the check");
    let image = with_bytes_at(at, &panics(at, check));
    let (told, outcome) = after_reset(image, b"FRF X\nWCL 1\n", None);
    println!("{told}");
    assert_eq!(outcome.resets.len(), 1);
    let place = "before the start: panic in c/some/place, line 4711";
    assert!(told.contains(place), "{told}");
    assert!(
        told.contains("start by a panic or a processor fault"),
        "{told}"
    );
}

/// The window watchdog does not bite on this bench; its interrupt is raised for it.
#[test]
fn a_tick_that_hangs_is_ended_by_the_window_watchdogs_interrupt_and_told() {
    let (image, at) = broken(IN_TICK, HANGS);
    let (told, outcome) = after_reset(image, b"FRF X\n", Some(WINDOW_WATCHDOG));
    println!("{told}");
    assert_eq!(outcome.resets.len(), 1);
    let place = format!("before the start: the control loop stood still at {at:#010x}");
    assert!(told.contains(&place), "{told}");
    assert!(told.contains("start by the watchdog"), "{told}");
}

/// Ticks go on, and so do the motors: it is the independent watchdog that ends it.
#[test]
fn a_command_side_that_hangs_is_reset_half_a_second_later() {
    let (image, _) = broken(ON_COMMAND, HANGS);
    let (send, receive) = mpsc::channel();
    let mut hung_at_ns = 0;
    let outcome = of(image)
        .run(move |period| {
            match (period.resets.len(), period.tick) {
                (0, 20) => period.send(b"FRF X\n"),
                (0, 400) => {
                    hung_at_ns = period.tick_at_ns();
                    period.send(b"WCL 1\n");
                }
                (1.., 50) => {
                    drop(period.received());
                    period.send(b"FLT?\n");
                }
                (1.., 100) => {
                    let told = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send((hung_at_ns, told)).expect("the test waits");
                    return Break(());
                }
                (0, 20_000) => return Break(()),
                _ => {}
            }
            Continue(())
        })
        .expect("a run");
    let (hung_at_ns, told) = receive.try_recv().expect("a reset, and an answer after it");
    let [reset] = outcome.resets[..] else {
        panic!("{:?}", outcome.resets);
    };
    assert_eq!(reset.cause, ResetCause::Model("IWDG"));
    // Half a second, and five counts of 4 ms.
    let after_ms = (reset.at_ns - hung_at_ns) as f64 * 1e-6;
    println!("{after_ms:.1} ms: {told}");
    assert!((515.0..522.0).contains(&after_ms), "{after_ms} ms");
    let said =
        "0 no fault, started by the watchdog: the control loop or the command side stood still\n";
    assert_eq!(told, said);
}

/// What the chip answers to some lines.
fn said(bench: Bench, lines: &'static [u8]) -> String {
    answers(bench, lines, [20, 600], |_| {})
}

#[test]
fn a_sealed_image_is_whole_and_one_with_a_flipped_bit_never_drives() {
    let sealed = seal(whole()).expect("an image that can be sealed");
    let told = said(of(sealed.clone()), b"EVT?\nFLT?\n");
    assert!(
        !told.contains("has no checksum") && told.contains("0 no fault"),
        "{told}"
    );

    // A function that nothing calls here.
    let place = offset(&sealed, address(ON_COMMAND));
    let mut damaged = sealed;
    damaged[place] ^= 1;
    let told = said(of(damaged), b"FLC\nFRF X\nFLT?\nSVO?\n");
    assert!(told.contains("the program is damaged"), "{told}");
    assert!(told.contains("X=0"), "{told}");
}

#[test]
fn an_image_that_nobody_has_sealed_says_so() {
    let told = said(of(whole()), b"EVT?\n");
    assert!(told.contains("the image has no checksum"), "{told}");
}

#[test]
fn without_a_crystal_the_chip_answers_and_never_drives() {
    let told = said(of(whole()).without_crystal(), b"FLC\nFRF X\nFLT?\nSVO?\n");
    println!("{told}");
    assert!(told.contains("crystal does not start"), "{told}");
    assert!(told.contains("X=0"), "{told}");
}

#[test]
fn a_chip_with_half_the_flash_starts_and_keeps_nothing() {
    let told = said(
        of(whole()).with_flash_kib(1024),
        b"EVT?\nFLC\nWPA 100\nERR?\n",
    );
    println!("{told}");
    assert!(told.contains("less than 2 MB of flash"), "{told}");
    let error = told.lines().last().map(str::trim);
    assert!(error.is_some_and(|error| error != "0"), "{told}");
}
