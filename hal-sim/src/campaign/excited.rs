//! How far and how fast an excitation, or whoever pushes meanwhile, has taken the pivots.

use core::f64::consts::TAU;

use firmware::parameters::Parameters;

use super::motion::{EXCITED_AT, EXCITED_TICKS};
use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::plant::AXES;

/// Way and rate, over what they may be, that are too much for certain, and perhaps: noise.
const WAY: [f64; 2] = [1.003, 0.997];
const RATE: [f64; 2] = [1.05, 0.95];

/// When it ends that begins as it is asked for.
const END: u64 = EXCITED_AT + EXCITED_TICKS as u64;
/// Ticks after it was asked for that an excitation may begin later, and so end: bridges wake up, and leads are tested, before.
const LATER_TICKS: u64 = 64;

/// Where the pivots were when an excitation was asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Excited {
    ticks: u64,
    from: [u32; AXES],
    now: [u32; AXES],
    /// What they have gone in the last tick, counts.
    steps: [u32; AXES],
}

impl Excited {
    pub const NONE: Self = Self {
        ticks: 0,
        from: [0; AXES],
        now: [0; AXES],
        steps: [0; AXES],
    };

    /// Takes a tick's position of an encoder, of the first one first.
    pub fn look(&mut self, encoder: usize, counts: u32) {
        if encoder == 0 {
            self.ticks += 1;
        }
        // Once it is over nobody looks any more.
        if self.ticks > END + LATER_TICKS {
            self.steps[encoder] = 0;
            return;
        }
        self.steps[encoder] = way_counts(counts, self.now[encoder]);
        self.now[encoder] = counts;
        if self.ticks <= EXCITED_AT {
            self.from[encoder] = counts;
        }
    }

    /// Whether it may be over, so that nobody has to look; what may be too much the controller may still find.
    const fn is_over(&self, may_be: bool) -> bool {
        !may_be && self.ticks > END
    }

    /// Whether one is too far from where it was; `may_be`: or nearly.
    pub fn is_too_far(&self, parameters: &Parameters, may_be: bool) -> bool {
        if self.is_over(may_be) {
            return false;
        }
        let most = WAY[usize::from(may_be)] * counts(parameters.excitation.way_rad);
        (self.now.iter().zip(self.from)).any(|(now, from)| f64::from(way_counts(*now, from)) > most)
    }

    /// Whether one is too fast; `may_be`: or nearly.
    pub fn is_too_fast(&self, parameters: &Parameters, may_be: bool) -> bool {
        if self.is_over(may_be) {
            return false;
        }
        let rad = parameters.excitation.rate_rad_s / parameters.limits.rate_hz;
        let most = RATE[usize::from(may_be)] * counts(rad);
        self.steps.iter().any(|step| f64::from(*step) > most)
    }
}

fn counts(rad: f64) -> f64 {
    rad / TAU * f64::from(COUNTS_PER_TURN)
}

/// From one position of an encoder to another, either way.
pub(super) const fn way_counts(one: u32, other: u32) -> u32 {
    let half = COUNTS_PER_TURN / 2;
    let way = one.wrapping_sub(other).wrapping_add(half);
    (way % COUNTS_PER_TURN).abs_diff(half)
}
