//! The servos' gains and filters, between the controller's parameters and the mathematics of their loops.

use super::bench::Bench;
use super::id::{self, AXES};
use crate::record::RecordError;
use commissioning::tuning::{Gains, PivotGains};
use firmware::parameters::{self, FeedbackFilters, Lead, Notch};

/// Parameters of pivot 1: gains, and filters; those of the next pivots follow.
const GAINS: u32 = 0x5450_0310;
const FILTERS: u32 = 0x5450_0350;

/// What is in force.
pub fn read(bench: &mut Bench<'_>) -> Result<Gains, RecordError> {
    let mut pivots = [PivotGains {
        gains: parameters::Gains {
            position_1_s: 0.0,
            velocity_v_s_rad: 0.0,
            integral_v_rad: 0.0,
        },
        filters: FeedbackFilters::NONE,
    }; AXES];
    for (pivot, gains) in pivots.iter_mut().enumerate() {
        let mut value = |first: u32, at: u32| bench.parameter(id::of(first, pivot) + at);
        gains.gains = parameters::Gains {
            position_1_s: value(GAINS, 0)?,
            velocity_v_s_rad: value(GAINS, 1)?,
            integral_v_rad: value(GAINS, 2)?,
        };
        for (first, notch) in [0, 3].into_iter().zip(&mut gains.filters.notches) {
            *notch = Notch {
                frequency_hz: value(FILTERS, first)?,
                width_hz: value(FILTERS, first + 1)?,
                gain: value(FILTERS, first + 2)?,
            };
        }
        gains.filters.lead = Lead {
            from_hz: value(FILTERS, 6)?,
            to_hz: value(FILTERS, 7)?,
        };
    }
    Ok(Gains {
        pivots,
        scheduled_inertia_kg_m2: bench.parameter(id::SCHEDULED_INERTIA)?,
    })
}

/// Puts them in force.
pub fn write(bench: &mut Bench<'_>, gains: &Gains) -> Result<(), RecordError> {
    bench.set(&[(id::SCHEDULED_INERTIA, gains.scheduled_inertia_kg_m2)])?;
    for (pivot, one) in gains.pivots.iter().enumerate() {
        let [first, second] = one.filters.notches;
        let values = [
            (GAINS, one.gains.position_1_s),
            (GAINS + 1, one.gains.velocity_v_s_rad),
            (GAINS + 2, one.gains.integral_v_rad),
            (FILTERS, first.frequency_hz),
            (FILTERS + 1, first.width_hz),
            (FILTERS + 2, first.gain),
            (FILTERS + 3, second.frequency_hz),
            (FILTERS + 4, second.width_hz),
            (FILTERS + 5, second.gain),
            (FILTERS + 6, one.filters.lead.from_hz),
            (FILTERS + 7, one.filters.lead.to_hz),
        ];
        bench.set(&values.map(|(first, value)| (id::of(first, pivot), value)))?;
    }
    Ok(())
}
