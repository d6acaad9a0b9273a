//! Random arguments: SplitMix64 (Steele, Lea and Flood, 2014).

/// The generator of one call.
pub struct Random(u64);

impl Random {
    /// For call `call` of a run.
    pub fn new(seed: u32, call: u32) -> Self {
        let mut random = Self(u64::from(seed) << 32 | u64::from(call));
        // One step mixes neighbouring calls apart.
        random.0 = random.bits();
        random
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From `low` up to `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// From 1 to `most`.
    pub fn up_to(&mut self, most: u64) -> u64 {
        1 + self.bits() % most.max(1)
    }

    /// One in so many.
    pub fn once_in(&mut self, n: u64) -> bool {
        self.bits().is_multiple_of(n)
    }
}
