//! Random choices of a run, all of them from its seed.

use crate::machine::devices::Noise;

/// A seeded generator of choices.
pub struct Random(Noise);

impl Random {
    /// The same seed gives the same choices.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(Noise::new(seed))
    }

    /// 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// A whole number below `end`, which is not 0.
    pub fn below(&mut self, end: u32) -> u32 {
        // Of no consequence here: some numbers come more often than others by a part in 2^32.
        ((u128::from(self.bits()) * u128::from(end)) >> 64) as u32
    }

    /// A number from `low` up to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * share
    }

    /// One of two signs.
    pub const fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }
}
