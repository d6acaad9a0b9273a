//! Numbers for tests: the same in every run (Knuth's linear congruential generator, of MMIX).

/// The generator.
pub struct Random(u64);

impl Random {
    /// The same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0
    }

    /// A number of so many bits, the sign among them.
    pub fn bits(&mut self, bits: u32) -> i64 {
        (self.next() as i64) >> (64 - bits)
    }

    /// From -1 to below 1.
    pub fn within_one(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
