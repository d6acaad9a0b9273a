//! Whether the stage has settled, and how far its pivots have been off.

use crate::control::config::{MAX_MEAN_TICKS, SupervisionConfig};
use crate::control::units::UNITS_PER_RAD;

/// Errors count as no more than this, 2^-32 turns (0.05 rad), so that the sums fit.
const MOST: i32 = 1 << 25;

/// Settled means at rest, and every pivot inside the window for the dwell time. What has settled is so until a pivot is out of twice
/// the window: noise near its edge does not take it away.
///
/// What is held against the window is the mean error of the last ticks, so that the window may be smaller than the
/// encoders' noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settling {
    /// Following errors of the last ticks, 2^-32 turns, and their sums, pivot by pivot.
    errors: [[i32; 3]; MAX_MEAN_TICKS],
    sums: [i32; 3],
    place: usize,
    ticks_inside: u32,
    settled: bool,
    peak_error: u32,
}

impl Settling {
    /// A motion starts, or what was settled is no longer.
    pub fn start(&mut self) {
        self.ticks_inside = 0;
        self.settled = false;
        self.peak_error = 0;
    }

    /// The servo goes on: what was before says nothing of what is now.
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    /// Takes the following errors of a tick and the largest of them, 2^-32 turns.
    #[inline]
    pub fn update(
        &mut self,
        limits: &SupervisionConfig,
        errors: &[i32; 3],
        worst: u32,
        moving: bool,
    ) {
        let place = self.place;
        self.place = if place + 1 < limits.mean_ticks {
            place + 1
        } else {
            0
        };
        let mut largest = 0;
        if let Some(oldest) = self.errors.get_mut(place) {
            for i in 0..3 {
                let error = errors[i].clamp(-MOST, MOST);
                self.sums[i] += error - oldest[i];
                oldest[i] = error;
                largest = self.sums[i].unsigned_abs().max(largest);
            }
        }
        self.peak_error = self.peak_error.max(worst);
        let window = limits.settling_window << u32::from(self.settled);
        if moving || largest > window {
            self.ticks_inside = 0;
        } else if self.ticks_inside < limits.settling_ticks {
            self.ticks_inside += 1;
        }
        self.settled = self.ticks_inside >= limits.settling_ticks;
    }

    /// Sums of the following errors over the ticks of the mean, pivot by pivot, 2^-32 turns.
    #[inline]
    pub fn error_sums(&self) -> &[i32; 3] {
        &self.sums
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::config::Config;
    use crate::control::rest_mode::UNITS_PER_COUNT;
    use crate::parameters::Parameters;

    #[test]
    fn what_has_settled_is_so_until_a_pivot_is_out_of_twice_the_window() {
        let parameters = Parameters::REFERENCE;
        let limits = Config::new(&parameters).limits;
        let mut settling = Settling::default();
        let mut settled_with = |windows: f64| {
            let counts = windows * (parameters.window.counts + 0.5);
            let error = (counts * UNITS_PER_COUNT) as i32;
            for _ in 0..2 * limits.settling_ticks + 64 {
                settling.update(&limits, &[0, error, -error], error.unsigned_abs(), false);
            }
            settling.settled()
        };
        let seen = [1.1, 0.9, 1.1, 1.9, 2.1, 1.9, 0.9].map(&mut settled_with);
        assert_eq!(seen, [false, true, true, true, false, false, true]);
    }
}
