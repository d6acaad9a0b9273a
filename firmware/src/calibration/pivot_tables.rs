//! The curves of a pivot as tables.

use super::table::Table;
use crate::number::Fixed;
use core::f64::consts::TAU;
use kinematics::{Angle, CurvePoint, Curves, PivotCoefficients, RingErrors, Series};

/// Steps in a turn of the ring, as a power of two.
const RING_STEP_BITS: u32 = 10;
const RING_STEPS: usize = 1 << RING_STEP_BITS;
/// Bits of a turn's fraction within a step, and that step's length.
const REST_BITS: u32 = u32::BITS - RING_STEP_BITS;
const REST_MASK: u32 = (1 << REST_BITS) - 1;
const PER_REST: f32 = 1.0 / (1_u32 << REST_BITS) as f32;

/// The part of the guide that has a table, track radii: some beyond both its mechanical ends. It goes on
/// straight further out.
const GUIDE_FROM: f32 = 0.15;
const GUIDE_TO: f32 = 1.85;
/// Steps on it. Polynomials of order 9 bend most at the ends: 256 are off by 3e-8 there.
const GUIDE_STEPS: usize = 512;
const GUIDE_STEPS_PER_RADIUS: f32 = GUIDE_STEPS as f32 / (GUIDE_TO - GUIDE_FROM);
const LAST_GUIDE_STEP: u32 = GUIDE_STEPS as u32 - 1;

/// Encoder, runout and straightness of one pivot.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct PivotTables {
    /// Encoder (rad) and runout (track radii) over the ring's turn, whose end is its start.
    ring: Table<2, { RING_STEPS + 1 }>,
    /// Straightness, track radii.
    guide: Table<1, { GUIDE_STEPS + 1 }>,
}

impl PivotTables {
    /// No errors.
    pub const ZERO: Self = Self {
        ring: Table::ZERO,
        guide: Table::ZERO,
    };

    /// The tables of a pivot.
    pub fn new(coefficients: &PivotCoefficients) -> Self {
        let mut tables = Self::ZERO;
        tables.fill(coefficients);
        tables
    }

    /// The same in place.
    pub fn fill(&mut self, coefficients: &PivotCoefficients) {
        let series = Series::<f64>::new(coefficients);
        let step_rad = TAU / RING_STEPS as f64;
        self.ring.fill(1.0 / step_rad, |step| {
            let errors = Curves::<f64>::ring_errors(&series, step * step_rad);
            [errors.encoder.value, errors.runout.value]
        });
        let per_radius = f64::from(GUIDE_STEPS_PER_RADIUS);
        self.guide.fill(per_radius, |step| {
            let rho = f64::from(GUIDE_FROM) + step / per_radius;
            [Curves::<f64>::straightness(&series, rho).value]
        });
    }
}

impl Curves<Fixed> for PivotTables {
    fn are_zero(&self) -> bool {
        self.ring.is_zero() && self.guide.is_zero()
    }

    #[inline]
    fn ring_errors(&self, ring: Angle) -> RingErrors<f32> {
        let fraction = ring.fraction();
        let index = (fraction >> REST_BITS) as usize;
        let rest = (fraction & REST_MASK) as f32 * PER_REST;
        let [encoder, runout] = self.ring.at(index, rest);
        RingErrors { encoder, runout }
    }

    #[inline]
    fn straightness(&self, rho: f32) -> CurvePoint<f32> {
        let place = (rho - GUIDE_FROM) * GUIDE_STEPS_PER_RADIUS;
        // Straight on beyond the ends.
        let index = (place as u32).min(LAST_GUIDE_STEP);
        let [straightness] = self.guide.at(index as usize, place - index as f32);
        straightness
    }
}
