//! Whether the stage has settled, and how far its pivots have been off.

use crate::control::config::SupervisionConfig;
use crate::control::units::UNITS_PER_RAD;

/// Settled means at rest, and every pivot inside the window for the dwell time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settling {
    ticks_inside: u32,
    settled: bool,
    peak_error: u32,
}

impl Settling {
    /// A motion starts, or what was settled is no longer.
    pub fn start(&mut self) {
        *self = Self::default();
    }

    /// Takes the largest following error of a tick, 2^-32 turns.
    #[inline]
    pub fn update(&mut self, limits: &SupervisionConfig, worst: u32, moving: bool) {
        self.peak_error = self.peak_error.max(worst);
        if moving || worst > limits.settling_window.unsigned_abs() {
            self.ticks_inside = 0;
        } else if self.ticks_inside < limits.settling_ticks {
            self.ticks_inside += 1;
        }
        self.settled = self.ticks_inside >= limits.settling_ticks;
    }

    /// Settled at the last tick.
    pub fn settled(&self) -> bool {
        self.settled
    }

    /// Largest following error of a pivot since [`start`](Self::start), rad.
    pub fn peak_error_rad(&self) -> f32 {
        self.peak_error as f32 * (1.0 / UNITS_PER_RAD) as f32
    }
}
