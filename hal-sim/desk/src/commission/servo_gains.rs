//! The servos' gains and filters, between the controller's parameters and the mathematics of their loops.

use super::bench::Bench;
use super::id::{self, AXES};
use crate::record::RecordError;
use commissioning::tuning::{Gains, PivotGains};
use firmware::parameters::{self, FeedbackFilters, Lead, Notch};

/// Parameters of pivot 1: gains, and filters; those of the next pivots follow.
const GAINS: u32 = 0x5450_0310;
const FILTERS: u32 = 0x5450_0350;

/// Numbers of a pivot: position gain (1/s), velocity gain (V s/rad), integral gain (V/rad); frequency (Hz), width (Hz) and gain of two notches; the
/// lead's two corners (Hz).
pub const NUMBERS: usize = 11;
/// Those of all pivots.
pub type Numbers = [[f64; NUMBERS]; AXES];

/// The parameter of each number of pivot 1.
const IDS: [u32; NUMBERS] = [
    GAINS,
    GAINS + 1,
    GAINS + 2,
    FILTERS,
    FILTERS + 1,
    FILTERS + 2,
    FILTERS + 3,
    FILTERS + 4,
    FILTERS + 5,
    FILTERS + 6,
    FILTERS + 7,
];

/// As the mathematics has them.
pub fn from_numbers(numbers: &Numbers, scheduled_inertia_kg_m2: f64) -> Gains {
    let notch = |of: &[f64]| Notch {
        frequency_hz: of[0],
        width_hz: of[1],
        gain: of[2],
    };
    Gains {
        pivots: numbers.map(|all| PivotGains {
            gains: parameters::Gains {
                position_1_s: all[0],
                velocity_v_s_rad: all[1],
                integral_v_rad: all[2],
            },
            filters: FeedbackFilters {
                notches: [notch(&all[3..6]), notch(&all[6..9])],
                lead: Lead {
                    from_hz: all[9],
                    to_hz: all[10],
                },
            },
        }),
        scheduled_inertia_kg_m2,
    }
}

/// As the parameters have them.
pub fn numbers(gains: &Gains) -> Numbers {
    gains.pivots.map(|pivot| {
        let PivotGains { gains, filters } = pivot;
        let [first, second] = filters.notches;
        [
            gains.position_1_s,
            gains.velocity_v_s_rad,
            gains.integral_v_rad,
            first.frequency_hz,
            first.width_hz,
            first.gain,
            second.frequency_hz,
            second.width_hz,
            second.gain,
            filters.lead.from_hz,
            filters.lead.to_hz,
        ]
    })
}

/// What is in force.
pub fn read(bench: &mut Bench<'_>) -> Result<Gains, RecordError> {
    let mut numbers = Numbers::default();
    for (pivot, numbers) in numbers.iter_mut().enumerate() {
        for (number, first) in numbers.iter_mut().zip(IDS) {
            *number = bench.parameter(id::of(first, pivot))?;
        }
    }
    let scheduled_inertia_kg_m2 = bench.parameter(id::SCHEDULED_INERTIA)?;
    Ok(from_numbers(&numbers, scheduled_inertia_kg_m2))
}

/// Puts them in force.
pub fn write(bench: &mut Bench<'_>, gains: &Gains) -> Result<(), RecordError> {
    bench.set(&[(id::SCHEDULED_INERTIA, gains.scheduled_inertia_kg_m2)])?;
    for (pivot, numbers) in numbers(gains).iter().enumerate() {
        let mut values = [(0, 0.0); NUMBERS];
        for (value, (first, number)) in values.iter_mut().zip(IDS.iter().zip(numbers)) {
            *value = (id::of(*first, pivot), *number);
        }
        bench.set(&values)?;
    }
    Ok(())
}
