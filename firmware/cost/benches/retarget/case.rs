//! A motion that is left for a new target.

use crate::motion_bench::reference::{Reference, per_axis};
use crate::planner::{Motion, Way, retargeted};
use firmware::motion::{AxisState, Constraints, Position, Refusal};
use std::f64::consts::FRAC_1_SQRT_2;

pub struct Case {
    /// What is under way.
    pub of: Motion,
    /// Its tick at which it is left.
    pub at: u64,
    /// The new target.
    pub to: Position,
    pub constraints: Constraints,
}

impl Case {
    /// The axes where the motion is left.
    pub fn state(&self) -> [AxisState; 3] {
        self.of.state_after(self.at)
    }

    /// The way of the planner under test.
    pub fn retargeted(&self) -> Result<Way, Refusal> {
        retargeted(&self.of, self.at, self.to, &self.constraints)
    }

    /// rsruckig's duration within the square; none where it finds nothing.
    pub fn reference_ticks(&self) -> Option<f64> {
        let square = per_axis(&self.constraints.limits, FRAC_1_SQRT_2);
        let reference = Reference::new(&self.state(), &self.to, &square)?;
        Some(reference.ticks()).filter(|&ticks| ticks > 0.0)
    }
}
