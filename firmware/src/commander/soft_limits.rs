//! Soft limits of the axes: travel as the user narrows it.
//!
//! They hold for the commanded point as
//! [`ActiveFrames::travel_coordinates`](super::frames::ActiveFrames::travel_coordinates) counts it: in the base frame's
//! axes, whatever work frame is enabled. One that has not been set is where the travel ends.

use super::axis::{Axis, AxisValues, Coordinates, Travel};
use super::error::CommandError;

/// A change of the soft limits: axes without a value keep what they have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SoftLimitChange {
    /// Lowest coordinates, mm and deg.
    Lowest(AxisValues),
    /// Highest coordinates, mm and deg.
    Highest(AxisValues),
    /// Whether the limits count.
    Active([Option<bool>; 6]),
}

/// Lowest and highest targets, mm and deg, and whether they count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SoftLimits {
    lowest: AxisValues,
    highest: AxisValues,
    pub active: [bool; 6],
}

impl SoftLimits {
    /// All of the travel.
    pub const fn new() -> Self {
        Self {
            lowest: [None; 6],
            highest: [None; 6],
            active: [true; 6],
        }
    }

    /// The same with another travel, which narrows them. `None` when it leaves nothing between them.
    pub fn narrowed_to(&self, travel: &Travel) -> Option<Self> {
        let mut narrowed_to = *self;
        for (i, [least, most]) in travel.iter().enumerate() {
            let outside = self.lowest[i].is_some_and(|lowest| lowest > *most)
                || self.highest[i].is_some_and(|highest| highest < *least);
            if outside {
                return None;
            }
            narrowed_to.lowest[i] = self.lowest[i].map(|lowest| lowest.max(*least));
            narrowed_to.highest[i] = self.highest[i].map(|highest| highest.min(*most));
        }
        Some(narrowed_to)
    }

    /// Lowest and highest target of an axis.
    pub fn range(&self, axis: Axis, travel: &Travel) -> [f64; 2] {
        let (i, [lowest, highest]) = (axis.index(), travel[axis.index()]);
        [
            self.lowest[i].unwrap_or(lowest),
            self.highest[i].unwrap_or(highest),
        ]
    }

    /// What has been set for an axis and counts.
    pub const fn active_range(&self, axis: Axis) -> [Option<f64>; 2] {
        let i = axis.index();
        if self.active[i] {
            [self.lowest[i], self.highest[i]]
        } else {
            [None; 2]
        }
    }

    /// Whether every axis of `target` is inside.
    pub fn contain(&self, target: &Coordinates) -> bool {
        Axis::ALL.into_iter().all(|axis| {
            let [lowest, highest] = self.active_range(axis);
            let value = target[axis.index()];
            lowest.is_none_or(|lowest| lowest <= value)
                && highest.is_none_or(|highest| value <= highest)
        })
    }

    /// Carries out a change, with the target that must stay inside, as [`ActiveFrames::travel_coordinates`] counts it.
    ///
    /// [`ActiveFrames::travel_coordinates`]: super::frames::ActiveFrames::travel_coordinates
    pub(super) fn apply(
        &mut self,
        change: &SoftLimitChange,
        target: &Coordinates,
        travel: &Travel,
    ) -> Result<(), CommandError> {
        let mut wanted = *self;
        match change {
            SoftLimitChange::Lowest(values) => wanted.lowest = replaced(&wanted.lowest, values),
            SoftLimitChange::Highest(values) => wanted.highest = replaced(&wanted.highest, values),
            SoftLimitChange::Active(values) => {
                for (active, value) in wanted.active.iter_mut().zip(values) {
                    *active = value.unwrap_or(*active);
                }
            }
        }
        self.change(wanted, target, travel)
    }

    /// Limits beyond the travel, that cross, or that leave out where the stage is, are refused as a whole.
    fn change(
        &mut self,
        wanted: Self,
        target: &Coordinates,
        travel: &Travel,
    ) -> Result<(), CommandError> {
        let good = Axis::ALL.into_iter().all(|axis| {
            let [least, most] = travel[axis.index()];
            let [lowest, highest] = wanted.range(axis, travel);
            least <= lowest && lowest <= highest && highest <= most
        });
        if !good || !wanted.contain(target) {
            return Err(CommandError::SoftLimitsInvalid);
        }
        *self = wanted;
        Ok(())
    }
}

fn replaced(limits: &AxisValues, values: &AxisValues) -> AxisValues {
    core::array::from_fn(|i| values[i].or(limits[i]))
}
