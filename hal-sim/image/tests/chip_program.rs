//! The unmodified image, sealed, whose program changes while it runs. Needs `cargo stage` first, then `cargo chip-test`.

mod asked;

use asked::{address, of, path, whole, write};
use image::chip::elf_file;
use image::seal::seal;
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// Of the control loop, in RAM; nothing of it runs while all encoders answer.
const IN_LOOP: &str = "stage::encoders::Port::abandon";
/// What looks at the image at the start.
const AT_START: &str = "firmware::image_checksum::image_checksum";
/// SRAM where the processor writes it; the loop is linked to its other address, 0.
const SRAM: u64 = 0x2000_0000;

/// When a bit flips, and when what is wrong is found at the latest: once around, 3,030 and 22,800 ticks, and a tenth more.
const FLIPPED: u64 = 1_000;
const LOOP_FOUND: u64 = FLIPPED + 3_330;
const IMAGE_FOUND: u64 = 25_080;

/// When there was a fault, in ticks, after the bit was flipped at an address; and what was told then, and after it was acknowledged.
fn fault_of(image: Vec<u8>, at: Option<u64>, last: u64) -> (Option<u64>, String) {
    let (send, receive) = mpsc::channel();
    let mut found = None;
    let outcome = of(image)
        .run(move |period| {
            let tick = period.tick;
            match tick {
                20 => period.send(b"FRF X\n"),
                FLIPPED => {
                    if let Some(at) = at {
                        let word = period.word(at).expect("a word");
                        assert!(period.set_word(at, word ^ 1 << 9), "{at:#x}");
                        assert_eq!(period.word(at), Some(word ^ 1 << 9), "{at:#x}");
                    }
                }
                _ => {}
            }
            // The bridges sleep: nothing else lets them here.
            let is_off = period.pins.iter().all(|bridge| !bridge.awake);
            if found.is_none() && tick > FLIPPED && (is_off || tick == last) {
                found = Some(tick);
                drop(period.received());
                period.send(b"FLT?\nFLC\nFRF X\nERR?\nSVO? X\n");
            }
            if found.is_none_or(|found| tick < found + 400) {
                return Continue(());
            }
            let told = String::from_utf8_lossy(&period.received()).into_owned();
            send.send((found.filter(|found| *found < last), told))
                .expect("the test waits");
            Break(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    assert!(outcome.resets.is_empty(), "{:?}", outcome.resets);
    receive.recv().expect("the last period")
}

fn sealed() -> Vec<u8> {
    seal(whole()).expect("an image that can be sealed")
}

/// `movw r0, #low` or, with the bit, `movt r0, #high`.
fn move_half(half: u16, top: bool) -> [u8; 4] {
    let half = u32::from(half);
    let first = 0xF240 | u32::from(top) << 7 | (half >> 11 & 1) << 10 | half >> 12;
    let second = (half >> 8 & 0b111) << 12 | half & 0xFF;
    let [a, b] = (first as u16).to_le_bytes();
    let [c, d] = (second as u16).to_le_bytes();
    [a, b, c, d]
}

fn assert_found(image: Vec<u8>, at: Option<u64>, last: u64) {
    let (found, told) = fault_of(image, at, last);
    println!("found at {found:?}, {told}");
    assert!(found.is_some(), "{told}");
    assert!(told.starts_with("the program is damaged"), "{told}");
    // No acknowledgement takes it away.
    assert!(told.contains("1024") && told.contains("X=0"), "{told}");
}

#[test]
fn a_bit_of_the_control_loop_that_flips_in_ram_lets_the_motors_go() {
    assert_found(sealed(), Some(SRAM + (address(IN_LOOP) & !3)), LOOP_FOUND);
}

/// The emulated flash can not be changed: here the look at the start says that all is well, and the one from then on that it is not.
#[test]
fn an_image_that_is_no_longer_of_its_checksum_does_too() {
    const CLAIMED: u32 = 0x1234_5678;
    let mut image = sealed();
    let place = elf_file::symbol(&path(), "IMAGE_CHECKSUM").expect("its place");
    write(&mut image, place, &CLAIMED.to_le_bytes());
    let says = [
        &move_half(CLAIMED as u16, false)[..],
        &move_half((CLAIMED >> 16) as u16, true)[..],
        &[0x70, 0x47], // bx lr
    ];
    write(&mut image, address(AT_START), &says.concat());
    assert_found(image, None, IMAGE_FOUND);
}

#[test]
fn a_whole_program_drives_on() {
    let (found, told) = fault_of(sealed(), None, IMAGE_FOUND);
    assert_eq!(found, None);
    assert!(
        told.starts_with("0 no fault") && told.contains("X=1"),
        "{told}"
    );
}
