//! Soft limits of the axes: travel as the user narrows it.

use super::axis::{Axis, AxisValues};
use super::error::ErrorCode;
use super::target::{Coordinates, replaced, travel};
use kinematics::Geometry;

/// Lowest and highest targets, mm and deg, and whether they count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SoftLimits {
    pub lowest: Coordinates,
    pub highest: Coordinates,
    pub active: [bool; 6],
}

impl SoftLimits {
    /// All of the travel.
    pub fn new(geometry: &Geometry) -> Self {
        let highest = Axis::ALL.map(|axis| travel(axis, geometry));
        Self {
            // Adding 0 turns -0 into 0.
            lowest: highest.map(|travel| -travel + 0.0),
            highest,
            active: [true; 6],
        }
    }

    /// Whether every axis of `target` is inside.
    pub fn allow(&self, target: &Coordinates) -> bool {
        (0..6).all(|i| !self.active[i] || (self.lowest[i]..=self.highest[i]).contains(&target[i]))
    }

    /// `NLM`, with the target that must stay inside.
    pub fn set_lowest(
        &mut self,
        values: &AxisValues,
        target: &Coordinates,
        geometry: &Geometry,
    ) -> Result<(), ErrorCode> {
        let mut wanted = *self;
        wanted.lowest = replaced(&wanted.lowest, values);
        self.change(wanted, target, geometry)
    }

    /// `PLM`.
    pub fn set_highest(
        &mut self,
        values: &AxisValues,
        target: &Coordinates,
        geometry: &Geometry,
    ) -> Result<(), ErrorCode> {
        let mut wanted = *self;
        wanted.highest = replaced(&wanted.highest, values);
        self.change(wanted, target, geometry)
    }

    /// `SSL`: 0 or 1.
    pub fn activate(
        &mut self,
        values: &AxisValues,
        target: &Coordinates,
        geometry: &Geometry,
    ) -> Result<(), ErrorCode> {
        let mut wanted = *self;
        for (active, value) in wanted.active.iter_mut().zip(values) {
            *active = match *value {
                None => *active,
                Some(0.0) => false,
                Some(1.0) => true,
                Some(_) => return Err(ErrorCode::OutOfRange),
            };
        }
        self.change(wanted, target, geometry)
    }

    /// Limits beyond the travel, that cross, or that leave out where the stage is, are refused as a whole.
    fn change(
        &mut self,
        wanted: Self,
        target: &Coordinates,
        geometry: &Geometry,
    ) -> Result<(), ErrorCode> {
        let good = Axis::ALL.into_iter().all(|axis| {
            let travel = travel(axis, geometry);
            let (lowest, highest) = (wanted.lowest[axis.index()], wanted.highest[axis.index()]);
            -travel <= lowest && lowest <= highest && highest <= travel
        });
        if !good || !wanted.allow(target) {
            return Err(ErrorCode::SoftLimit);
        }
        *self = wanted;
        Ok(())
    }
}
