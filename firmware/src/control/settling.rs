//! Whether the stage has settled, and how far its pivots have been off.

use crate::control::config::{SupervisionConfig, UNITS_PER_RAD};

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

    /// Takes the largest following error of a tick, 2^-32 turns.
    #[inline]
    pub fn look(&mut self, limits: &SupervisionConfig, worst: u32, moving: bool) {
        self.peak = self.peak.max(worst);
        if moving || worst > limits.window.unsigned_abs() {
            self.inside = 0;
        } else if self.inside < limits.dwell {
            self.inside += 1;
        }
        self.settled = self.inside >= limits.dwell;
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
