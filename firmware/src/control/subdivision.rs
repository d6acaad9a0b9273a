//! The error that an encoder makes within each period of its scale (sub-divisional or interpolation error), taken from its readings.
//!
//! Reading `r` of a scale of `p` periods a turn is too high by `sum A_k sin(k p r + a_k)`. It repeats with every period, so that a
//! table over one period has it all: 32 entries, and a straight line between two of them. The phase comes from the reading as the
//! encoder sends it, so neither its zero nor its direction changes the table.

use crate::control::units::UNITS_PER_RAD;
use crate::number::Fixed;
use crate::parameters::{Subdivision, SubdivisionHarmonic};
use kinematics::{Angle, Scalar};

/// Binary places of an entry's number.
const ENTRY_BITS: u32 = 5;
const ENTRIES: usize = 1 << ENTRY_BITS;
/// Binary places of the way from one entry to the next.
const WAY_BITS: u32 = 15;
/// All ones: the entry behind the last is the first.
const LAST_ENTRY: usize = ENTRIES - 1;

/// What an encoder's readings are too high by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SubdivisionTable {
    /// Of the scale in a turn; 0: nothing is taken away.
    periods: u32,
    /// 2^-32 turns.
    entries: [i16; ENTRIES],
}

impl SubdivisionTable {
    /// Derives the table; none where no amplitude is set.
    pub fn new(subdivision: &Subdivision) -> Self {
        let mut table = Self::default();
        let none = |harmonic: &SubdivisionHarmonic| harmonic.amplitude_nrad == 0;
        if subdivision.periods == 0 || subdivision.harmonics.iter().all(none) {
            return table;
        }
        table.periods = subdivision.periods;
        for (entry, place) in table.entries.iter_mut().zip(0_u32..) {
            let mut units = 0.0;
            for (k, harmonic) in (1_u32..).zip(&subdivision.harmonics) {
                let start =
                    libm::rint(f64::from(harmonic.phase_tenths_deg) / 3_600.0 * 4_294_967_296.0)
                        as i64;
                let turned = (k * place) << (u32::BITS - ENTRY_BITS);
                let (sin, _) = Fixed::sin_cos(Angle::from_units(start + i64::from(turned)));
                let amplitude = f64::from(harmonic.amplitude_nrad) * 1e-9 * UNITS_PER_RAD;
                units += amplitude * f64::from(sin.to_f32());
            }
            *entry = libm::rint(units) as i16;
        }
        table
    }

    /// Whether anything is taken away.
    pub fn takes(&self) -> bool {
        self.periods != 0
    }

    /// A reading without the error; readings are 2^-32 turns.
    #[inline]
    pub fn corrected(&self, reading: u32) -> u32 {
        let phase = reading.wrapping_mul(self.periods);
        let place = (phase >> (u32::BITS - ENTRY_BITS)) as usize;
        let way = (phase << ENTRY_BITS) >> (u32::BITS - WAY_BITS);
        let before = i32::from(self.entries[place]);
        let after = i32::from(self.entries[(place + 1) & LAST_ENTRY]);
        // To the nearest unit.
        let rise = ((after - before) * way as i32 + (1 << (WAY_BITS - 1))) >> WAY_BITS;
        reading.wrapping_sub((before + rise) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    const UNIT_RAD: f64 = TAU / 4_294_967_296.0;

    /// As the error is defined, in floats and over all turns of the phase.
    fn error_rad(subdivision: &Subdivision, reading: u32) -> f64 {
        let periods = f64::from(subdivision.periods) * f64::from(reading) / 4_294_967_296.0;
        (1_i32..)
            .zip(&subdivision.harmonics)
            .map(|(k, harmonic)| {
                let turns = f64::from(k) * periods + f64::from(harmonic.phase_tenths_deg) / 3_600.0;
                f64::from(harmonic.amplitude_nrad) * 1e-9 * (TAU * turns.fract()).sin()
            })
            .sum()
    }

    fn harmonics(rad_deg: [[f64; 2]; 3]) -> [SubdivisionHarmonic; 3] {
        rad_deg.map(|[amplitude_rad, phase_deg]| SubdivisionHarmonic {
            amplitude_nrad: (amplitude_rad * 1e9).round() as u16,
            phase_tenths_deg: (phase_deg * 10.0) as i16,
        })
    }

    /// What the straight lines leave of harmonic k is at most `(pi k / 32)^2 / 2` of its amplitude; a unit is for rounding.
    #[test]
    fn what_is_taken_away_is_the_error_but_for_the_straight_lines() {
        let cases = [
            (15_708, [[0.8e-6, 0.0], [0.0; 2], [0.0; 2]]),
            (9_001, [[1e-6, -90.0], [0.3e-6, 210.0], [0.2e-6, 10.0]]),
            (100_000, [[1e-5, 30.0], [1e-5, 90.0], [1e-5, 270.0]]),
            (1, [[0.0; 2], [0.0; 2], [1e-6, 45.0]]),
        ];
        for (periods, rad_deg) in cases {
            let subdivision = Subdivision {
                periods,
                harmonics: harmonics(rad_deg),
            };
            let table = SubdivisionTable::new(&subdivision);
            let left: f64 = (1_i32..)
                .zip(&subdivision.harmonics)
                .map(|(k, one)| {
                    f64::from(one.amplitude_nrad) * 1e-9 * (TAU / 64.0 * f64::from(k)).powi(2) / 2.0
                })
                .sum();
            let mut worst_rad = 0.0_f64;
            for i in 0..200_000_u32 {
                let reading = i.wrapping_mul(2_654_435_769);
                let taken = reading.wrapping_sub(table.corrected(reading)) as i32;
                let off_rad = f64::from(taken) * UNIT_RAD - error_rad(&subdivision, reading);
                worst_rad = worst_rad.max(off_rad.abs());
            }
            assert!(
                worst_rad < left + 1.1 * UNIT_RAD && worst_rad > 0.5 * left,
                "{periods}: {worst_rad:e} of {left:e}"
            );
        }
    }

    #[test]
    fn without_periods_or_amplitudes_readings_stay_as_they_are() {
        let without_periods = Subdivision {
            periods: 0,
            harmonics: harmonics([[1e-6, 30.0]; 3]),
        };
        let without_amplitudes = Subdivision {
            periods: 15_708,
            harmonics: harmonics([[0.0, 30.0]; 3]),
        };
        for subdivision in [without_periods, without_amplitudes, Subdivision::NONE] {
            let table = SubdivisionTable::new(&subdivision);
            for i in 0..1_000_u32 {
                let reading = i.wrapping_mul(2_654_435_769);
                assert_eq!(table.corrected(reading), reading);
            }
        }
    }
}
