//! What a fit leaves of the measured values, by visit, and by pivot and harmonic of its ring: what shows there is in no number of the model.

use kinematics::COEFFICIENTS;

use crate::error::FitError;
use crate::fit::Fit;
use crate::kit::Instrument;
use crate::position::OutOfReach;
use crate::visit::{Rows, Visit};

/// Harmonics that are looked at: those of the model end at 12.
pub const HARMONICS: usize = 20;

/// One harmonic of a pivot's ring.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Harmonic {
    /// How large it is, rad at the ring.
    pub size_rad: f64,
    /// What noise alone makes of it, rms.
    pub noise_rad: f64,
}

/// What is left of one visit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Miss {
    /// Seen less said: x, y (track radii) and theta (rad), 0 where it was not seen.
    pub off: [f64; 3],
    /// Which of the three were seen.
    pub seen: &'static [usize],
    /// Standard deviations of what was seen.
    pub noise: [f64; 3],
}

/// What a fit leaves.
#[derive(Clone, PartialEq, Debug)]
pub struct Left {
    /// Of each visit.
    pub visits: Vec<Miss>,
    /// Of each pivot, from the first harmonic on: as large as if it were the only one.
    pub harmonics: [[Harmonic; HARMONICS]; 3],
}

/// A sine and a cosine fitted to what is left.
#[derive(Clone, Copy, Default)]
struct Wave {
    square: [f64; 3],
    right: [f64; 2],
}

impl Wave {
    fn add(&mut self, by: f64, angle_rad: f64, miss: f64) {
        let (sin, cos) = angle_rad.sin_cos();
        let (c, s) = (by * cos, by * sin);
        self.square = [
            self.square[0] + c * c,
            self.square[1] + c * s,
            self.square[2] + s * s,
        ];
        self.right = [self.right[0] + c * miss, self.right[1] + s * miss];
    }

    fn solved(&self) -> Harmonic {
        let ([cc, cs, ss], [c, s]) = (self.square, self.right);
        let determinant = cc * ss - cs * cs;
        if determinant <= 0.0 {
            return Harmonic::default();
        }
        Harmonic {
            size_rad: (ss * c - cs * s).hypot(cc * s - cs * c) / determinant,
            noise_rad: ((cc + ss) / determinant).sqrt(),
        }
    }
}

/// What a fit leaves of its visits; outliers are in the list, and in no harmonic.
///
/// # Errors
/// [`FitError::Visit`]: a visit has no pose.
pub fn left(instrument: &Instrument, fit: &Fit, visits: &[Visit]) -> Result<Left, FitError> {
    let mut instrument = instrument.clone();
    instrument.noise = fit.noise(instrument.noise);
    let sizes = vec![1.0; instrument.unknowns()];
    let mut waves = [[Wave::default(); HARMONICS]; 3];
    let mut misses = Vec::new();
    for (visit, measured) in visits.iter().enumerate() {
        let rows = Rows::new(&instrument, &fit.machine, &fit.unknowns, measured);
        let rows = rows.map_err(|OutOfReach| FitError::Visit {
            visit,
            reason: "no pose has these encoder angles",
        })?;
        let mut off = [0.0; 3];
        for &row in rows.seen {
            off[row] = rows.misses[row] * rows.noise[row];
        }
        misses.push(Miss {
            off,
            seen: rows.seen,
            noise: rows.noise.into(),
        });
        if fit.outliers.contains(&visit) {
            continue;
        }
        rows.for_columns(&sizes, |column, by| {
            let pivot = column / COEFFICIENTS;
            if column % COEFFICIENTS != 0 || pivot >= waves.len() {
                return;
            }
            let ring_rad = measured.readings_rad[pivot] - fit.machine[pivot].encoder_zero_rad;
            for (wave, times) in waves[pivot].iter_mut().zip(1..) {
                for &row in rows.seen {
                    wave.add(by[row], f64::from(times) * ring_rad, rows.misses[row]);
                }
            }
        });
    }
    Ok(Left {
        visits: misses,
        harmonics: waves.map(|waves| waves.map(|wave| wave.solved())),
    })
}
