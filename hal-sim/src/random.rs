//! Random numbers of the simulation and of its tests: the same seed gives the same ones on every host.

/// A seeded generator: SplitMix64 (Steele, Lea and Flood, 2014), 64 bits of state, every seed is a good one.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator whose sequence depends on the seed alone.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number from `low` up to `high`.
    pub const fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * share
    }

    /// A whole number below `end`, which is not 0: the upper bits, scaled.
    pub fn below(&mut self, end: u32) -> u32 {
        // Of no consequence here: some numbers come more often than others by a part in 2^32.
        ((u128::from(self.bits()) * u128::from(end)) >> 64) as u32
    }

    /// A place among `count`, which is not 0: a remainder.
    pub const fn index(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// One of them.
    pub const fn pick<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.index(of.len())]
    }

    /// True once in `count`.
    pub const fn once_in(&mut self, count: usize) -> bool {
        self.index(count) == 0
    }

    /// One of two signs.
    pub const fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// A bell-shaped number of mean 0 and standard deviation 1: the sum of four uniform ones, so it never leaves
    /// +-3.5 and needs no elementary function.
    pub fn normal(&mut self) -> f64 {
        let bits = self.bits();
        let sum: u64 = (0..4)
            .map(|quarter| (bits >> (16 * quarter)) & 0xffff)
            .sum();
        // Four uniform numbers over 2^16 counts have the standard deviation 2^16 sqrt(4/12) together.
        (sum as f64 - 2.0 * 65_535.0) * (1.732_050_807_568_877_2 / 65_536.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_is_that_of_the_paper() {
        // From Vigna's C code, seed 1234567.
        let mut random = Random::new(1_234_567);
        let first = [0, 1, 2].map(|_| random.bits());
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(first, expected);
    }

    #[test]
    fn noise_has_mean_zero_and_deviation_one() {
        let mut random = Random::new(1);
        let samples: Vec<f64> = (0..100_000).map(|_| random.normal()).collect();
        let mean = samples.iter().sum::<f64>() / 1e5;
        let variance = samples.iter().map(|x| x * x).sum::<f64>() / 1e5;
        assert!(mean.abs() < 0.01, "{mean}");
        assert!((variance - 1.0).abs() < 0.02, "{variance}");
    }
}
