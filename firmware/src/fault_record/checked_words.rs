//! Entries of some words, the last of which is a check over the others.

use core::array::from_fn;
use core::sync::atomic::{AtomicU32, Ordering};

/// Words of an event, with its check.
pub(crate) const EVENT_WORDS: usize = 8;
/// Starts the check: all words zero are no entry.
const SEED: u32 = 0xB0C5_1AC7;

/// So many entries of so many words, the check included.
pub(crate) struct CheckedEntries<const COUNT: usize, const WORDS: usize>(
    [[AtomicU32; WORDS]; COUNT],
);

impl<const COUNT: usize, const WORDS: usize> CheckedEntries<COUNT, WORDS> {
    pub const fn new() -> Self {
        Self([const { [const { AtomicU32::new(0) }; WORDS] }; COUNT])
    }

    /// Writes the entry of a number at its place. The last word of `words` is ignored: the check stands there.
    #[inline]
    pub fn write(&self, number: u32, words: &[u32; WORDS]) {
        let Some(cells) = self.0.get(number as usize % COUNT) else {
            return;
        };
        let mut check = SEED;
        let last = WORDS - 1;
        for (cell, word) in cells.iter().zip(words).take(last) {
            cell.store(*word, Ordering::Relaxed);
            check = check_step(check, *word);
        }
        if let Some(cell) = cells.last() {
            cell.store(check, Ordering::Relaxed);
        }
    }

    /// The entry at the place of a number, if it is whole.
    pub fn read(&self, number: u32) -> Option<[u32; WORDS]> {
        let cells = self.0.get(number as usize % COUNT)?;
        let words: [u32; WORDS] = from_fn(|i| cells[i].load(Ordering::Relaxed));
        let (check, covered) = words.split_last()?;
        let sum = (covered.iter()).fold(SEED, |sum, word| check_step(sum, *word));
        (sum == *check).then_some(words)
    }

    #[cfg(test)]
    pub fn flip(&self, number: usize, word: usize, bit: u32) {
        self.0[number][word].fetch_xor(1 << bit, Ordering::Relaxed);
    }

    pub fn clear(&self) {
        for cell in self.0.iter().flatten() {
            cell.store(0, Ordering::Relaxed);
        }
    }
}

/// One word more in the check. Rotated, so that words that have changed places give another check.
#[inline]
const fn check_step(check: u32, word: u32) -> u32 {
    check.rotate_left(5) ^ word
}
