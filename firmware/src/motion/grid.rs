//! The pivots' demands along a line, at places evenly spaced on it, and what a motion makes of them.

use super::float::Order;
use super::limits::PathLimits;
use super::path::{Demand, Path};
use crate::number::sqrt_f32;

/// Most stretches between places.
const MOST: usize = 64;

/// What the pivots are not granted of their limits in planning: demands are looked up between places, where they are curved.
/// A part for everything, and one for the square of what a stretch turns and moves (rad and track radii).
const KEPT: f32 = 0.002;
const KEPT_OF_SQUARE: f32 = 0.1;

/// With less than this of it on the whole line, half a turn, half of the places do.
const FEW: f32 = 10.0;

/// The demands along a line, and the limits.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    bits: u32,
    demands: [Demand; MOST + 1],
    /// Limits on s, per second.
    pub limits: PathLimits,
    /// Rate of a pivot.
    pub pivot_rate: f32,
    /// Acceleration of a pivot.
    pub pivot_acceleration: f32,
}

/// Speed, acceleration and place of a motion along a line, per second.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moment {
    pub s: f32,
    pub rate: f32,
    pub acceleration: f32,
}

impl Grid {
    pub fn new(path: &Path, limits: PathLimits, pivot_rate: f32, pivot_acceleration: f32) -> Self {
        let square = path.turn * path.turn + path.length * path.length;
        let bits = if path.is_wound() || square < FEW {
            5
        } else {
            6
        };
        let spacing = 1.0 / (1u32 << bits) as f32;
        let kept = KEPT + KEPT_OF_SQUARE * square * (spacing * spacing);
        let granted = if path.is_wound() {
            1.0 - KEPT
        } else {
            1.0 - kept
        };
        let mut demands = [Demand::default(); MOST + 1];
        for (k, demand) in demands.iter_mut().enumerate().take((1 << bits) + 1) {
            *demand = path.demand(k, bits);
        }
        Self {
            bits,
            demands,
            limits,
            pivot_rate: pivot_rate * granted,
            pivot_acceleration: pivot_acceleration * granted,
        }
    }

    /// Number of stretches.
    pub fn stretches(&self) -> usize {
        1 << self.bits
    }

    /// The demand at a place.
    pub fn at(&self, place: usize) -> &Demand {
        &self.demands[place.min(MOST)]
    }

    /// The demand at s, between places a straight line.
    fn between(&self, s: f32) -> Demand {
        let places = s.clamp(0.0, 1.0) * (1u32 << self.bits) as f32;
        let before = (places as usize).min(self.stretches() - 1);
        let part = places - before as f32;
        let (a, b) = (self.at(before), self.at(before + 1));
        let mixed = |a: &[f32; 3], b: &[f32; 3]| [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part);
        Demand {
            first: mixed(&a.first, &b.first),
            second: mixed(&a.second, &b.second),
        }
    }

    /// The factor by which a motion would have to take longer for this moment of it to keep every limit; 1 and less when it does.
    pub fn excess(&self, moment: &Moment) -> f32 {
        let demand = self.between(moment.s);
        let square = moment.rate * moment.rate;
        let mut rate = 0.0_f32;
        let mut acceleration = 0.0_f32;
        for (first, second) in demand.first.iter().zip(&demand.second) {
            rate = rate.larger(first.abs());
            acceleration =
                acceleration.larger((first * moment.acceleration + second * square).abs());
        }
        let rate = moment.rate.abs() * (rate / self.pivot_rate).larger(1.0 / self.limits.rate);
        let force = (acceleration / self.pivot_acceleration)
            .larger(moment.acceleration.abs() / self.limits.acceleration);
        if force > rate * rate {
            sqrt_f32(force)
        } else {
            rate
        }
    }
}
