//! Gains by hand, on the loops as they were measured: what other ones would make of them, before they are in force.

use super::bench::Bench;
use super::found::{CommissionError, Plot};
use super::known::Known;
use super::measured_loop::{MeasuredLoop, plot_predicted};
use super::servo_gains::{self, Numbers};
use super::steps::rest_for;
use super::{Machine, id};
use crate::record::RecordError;
use commissioning::drive_model::DriveModel;
use commissioning::record::Timing;
use commissioning::tuning::{Gains, MOST_MS, PLACES, Plant, margins};
use serde::Serialize;

/// Loops as they were measured, with all that is needed to say what other gains make of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tunable {
    model: DriveModel,
    loops: Vec<MeasuredLoop>,
    radius_m: f64,
    in_force: Gains,
}

/// What a loop is worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worth {
    /// Where, in words.
    pub place: String,
    /// Largest sensitivity.
    pub ms: f64,
    /// Sensitivity at 30 Hz.
    pub rejection: f64,
    /// Where the gain of the slowest pivot's loop is 1.
    pub crossover_hz: f64,
}

/// What gains would make of the loops.
#[derive(Clone, Debug, PartialEq)]
pub struct Predicted {
    /// Whether the model of this machine is stable with them everywhere; the measured lines alone do not tell.
    pub is_stable: bool,
    /// At each place that was measured.
    pub loops: Vec<Worth>,
    /// A picture each.
    pub plots: Vec<Plot>,
}

/// Why gains are not tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GainsError {
    /// A number that none can be.
    #[error("a gain is no number, or below 0")]
    NoGain,
    /// They would oscillate.
    #[error("the model of this machine is unstable with these gains: they are not put in force")]
    Unstable,
}

/// Largest sensitivity of a loop that keeps its margins.
pub const MOST_SENSITIVITY: f64 = MOST_MS;

impl Tunable {
    /// What the steps have measured last; none where they measured no loop.
    pub(super) fn of(known: Known, bench: &mut Bench<'_>) -> Result<Option<Self>, RecordError> {
        let (Some(model), false) = (known.model, known.loops.is_empty()) else {
            return Ok(None);
        };
        Ok(Some(Self {
            model,
            loops: known.loops,
            radius_m: 1e-3 * bench.parameter(id::TRACK_RADIUS)?,
            in_force: servo_gains::read(bench)?,
        }))
    }

    /// The gains with which they were measured.
    #[must_use]
    pub fn numbers(&self) -> Numbers {
        servo_gains::numbers(&self.in_force)
    }

    /// The loops with them.
    #[must_use]
    pub fn measured(&self) -> Vec<Worth> {
        self.loops.iter().map(worth).collect()
    }

    /// What other gains would make of them.
    ///
    /// # Errors
    /// [`GainsError::NoGain`].
    pub fn predict(&self, numbers: &Numbers) -> Result<Predicted, GainsError> {
        let gains = self.gains(numbers)?;
        let chain = &self.model.mechanical.chain;
        let pairs: Vec<_> = (self.loops.iter())
            .filter_map(|measured| Some((measured.with(&gains, chain, self.radius_m)?, measured)))
            .collect();
        Ok(Predicted {
            is_stable: self.is_stable(&gains),
            loops: pairs
                .iter()
                .map(|(predicted, _)| worth(predicted))
                .collect(),
            plots: (pairs.iter())
                .map(|(predicted, measured)| plot_predicted(predicted, measured))
                .collect(),
        })
    }

    /// Puts other gains in force. They are not kept, and the loops that were measured are no longer those of the machine.
    ///
    /// # Errors
    /// [`GainsError`], and what the controller refuses.
    pub fn put_in_force(
        &self,
        machine: &mut dyn Machine,
        numbers: &Numbers,
    ) -> Result<(), PutError> {
        let gains = self.gains(numbers)?;
        if !self.is_stable(&gains) {
            return Err(GainsError::Unstable.into());
        }
        let mut put = || -> Result<(), CommissionError> {
            let mut bench = Bench::new(machine)?;
            bench.ask("CCL 1 ADVANCED")?;
            servo_gains::write(&mut bench, &gains)?;
            rest_for(&mut bench, &gains)
        };
        Ok(put()?)
    }

    fn gains(&self, numbers: &Numbers) -> Result<Gains, GainsError> {
        let sound = |number: &f64| number.is_finite() && *number >= 0.0;
        if !numbers.iter().flatten().all(sound) {
            return Err(GainsError::NoGain);
        }
        let scheduled = self.in_force.scheduled_inertia_kg_m2;
        Ok(servo_gains::from_numbers(numbers, scheduled))
    }

    /// On the model, at all places, with carriages that slide.
    fn is_stable(&self, gains: &Gains) -> bool {
        let chain = self.model.mechanical.chain.sliding();
        Plant::at_places(&self.model.electrical, &chain, &PLACES, &Timing::STAGE)
            .iter()
            .all(|plant| margins(plant, gains).is_stable)
    }
}

/// Why gains are not in force.
#[derive(Debug, thiserror::Error)]
pub enum PutError {
    /// They are none for this machine.
    #[error(transparent)]
    Gains(#[from] GainsError),
    /// The controller.
    #[error(transparent)]
    Controller(#[from] CommissionError),
}

fn worth(measured: &MeasuredLoop) -> Worth {
    Worth {
        place: measured.spot.words(),
        ms: measured.ms(),
        rejection: measured.rejection(),
        crossover_hz: measured.crossover_hz(),
    }
}
