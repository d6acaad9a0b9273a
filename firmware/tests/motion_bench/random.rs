//! Numbers that are the same everywhere.

use super::UNIT;
use firmware::motion::{Constraints, Position};
use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea and Flood, 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A position of the moved point that puts the platform centre anywhere in the disk, at any orientation.
    pub fn place(&mut self, constraints: &Constraints) -> Position {
        let r = constraints.geometry.usable_radius() * self.unit().sqrt();
        let (direction, theta) = (TAU * self.unit(), TAU * self.unit());
        let [p, q] = constraints.rotation_centre;
        let (sin, cos) = theta.sin_cos();
        let x = r * direction.cos() + cos * p - sin * q;
        let y = r * direction.sin() + sin * p + cos * q;
        [x, y, theta / TAU].map(|value| (value * UNIT) as i64)
    }
}
