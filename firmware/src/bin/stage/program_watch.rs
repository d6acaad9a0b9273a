//! Whether the program is still what it was at the start: the idle task looks at a little of it each time it comes round, for as long
//! as the chip runs.
//!
//! | what | has to be | all of it is looked at in, on the emulated chip with an idle command side; longer with a busy one |
//! |---|---|---|
//! | code and tables of the control loop, in RAM | what they were copied from | 0.15 s |
//! | the image in flash | of the checksum that it was given, if it has one | 1.1 s |
//!
//! A difference is told to the tick, which takes it for a fault and lets the motors coast, until a restart: that copies the loop anew,
//! and looks at the image before anything drives.

use crate::{loop_memory::SRAM1_BASE, self_check};
use core::ptr::addr_of;
use core::sync::atomic::{AtomicBool, Ordering};
use firmware::image_checksum::ImageDigest;

static IS_DAMAGED: AtomicBool = AtomicBool::new(false);

/// What is looked at each time: the idle task comes round at every interrupt that wakes it, two or three in a period.
const LOOP_WORDS: usize = 2;
const IMAGE_BYTES: usize = 16;

unsafe extern "C" {
    /// Begin and end of the loop at address 0, and what it was copied from.
    static __sloop: u32;
    static __eloop: u32;
    static __siloop: u32;
}

/// Whether a difference has been found.
#[inline(always)]
pub fn is_damaged() -> bool {
    IS_DAMAGED.load(Ordering::Relaxed)
}

/// See the module.
pub struct ProgramWatch {
    next_word: usize,
    next_byte: usize,
    digest: ImageDigest,
}

impl ProgramWatch {
    /// Nothing has been looked at yet.
    pub fn new() -> Self {
        Self {
            next_word: 0,
            next_byte: 0,
            digest: ImageDigest::new(),
        }
    }

    /// Looks at the next little.
    pub fn step(&mut self) {
        if self.finds_other_loop() || self.finds_other_image() {
            IS_DAMAGED.store(true, Ordering::Relaxed);
        }
    }

    fn finds_other_loop(&mut self) -> bool {
        let begin = addr_of!(__sloop) as usize;
        let words = (addr_of!(__eloop) as usize - begin) / size_of::<u32>();
        let copy = (SRAM1_BASE as usize + begin) as *const u32;
        let from = self.next_word.min(words);
        let to = (from + LOOP_WORDS).min(words);
        self.next_word = if to == words { 0 } else { to };
        (from..to).any(|at| {
            // SAFETY: both are words of the linker's, which nobody writes after the start. Volatile, since the compiler does not know
            // that they might change.
            unsafe { copy.add(at).read_volatile() != addr_of!(__siloop).add(at).read_volatile() }
        })
    }

    fn finds_other_image(&mut self) -> bool {
        let (image, checksum_at, checksum) = self_check::image();
        let Some(checksum) = checksum else {
            return false;
        };
        let end = (self.next_byte + IMAGE_BYTES).min(image.len());
        // The checksum itself is no part of it.
        for part in [
            self.next_byte..end.min(checksum_at),
            self.next_byte.max(checksum_at + size_of::<u32>())..end,
        ] {
            self.digest.update(image.get(part).unwrap_or_default());
        }
        self.next_byte = end;
        if end < image.len() {
            return false;
        }
        self.next_byte = 0;
        core::mem::replace(&mut self.digest, ImageDigest::new()).finish() != checksum
    }
}
