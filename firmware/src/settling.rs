//! Whether the stage has settled, and how far its pivots have been off.

use crate::config::{SupervisionConfig, UNITS_PER_RAD};

/// Settled means at rest, and every pivot inside the window for the dwell time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settling {
    inside: u32,
    settled: bool,
    peak: u32,
}

impl Settling {
    /// A motion starts, or what was settled is no longer.
    pub fn start(&mut self) {
        *self = Self::default();
    }

    /// Takes the following errors of a tick, 2^-32 turns; gives the largest.
    #[inline]
    pub fn look(&mut self, limits: &SupervisionConfig, errors: &[i32; 3], moving: bool) -> u32 {
        let mut worst = 0;
        for error in errors {
            worst = worst.max(error.unsigned_abs());
        }
        self.peak = self.peak.max(worst);
        if moving || worst > limits.window.unsigned_abs() {
            self.inside = 0;
        } else if self.inside < limits.dwell {
            self.inside += 1;
        }
        self.settled = self.inside >= limits.dwell;
        worst
    }

    /// Settled at the last tick.
    pub fn settled(&self) -> bool {
        self.settled
    }

    /// Largest following error of a pivot since [`start`](Self::start), rad.
    pub fn peak_rad(&self) -> f32 {
        self.peak as f32 * (1.0 / UNITS_PER_RAD) as f32
    }
}
