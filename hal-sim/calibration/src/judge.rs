//! Whether a machine of given numbers is the one that was measured: what is unknown about the instrument is fitted alone, and all that is
//! left then is the machine's.
//!
//! The commanded poses of a controller with a calibration in force are judged as those of a machine as drawn ([`Visit::commanded`]); a
//! calibration that is not in force is judged by the encoders' readings. No visit is left out: an error that shows now and then is one.

use nalgebra::DMatrix;

use crate::Machine;
use crate::alignment::aligned;
use crate::descent::State;
use crate::error::FitError;
use crate::fit::check;
use crate::kit::Instrument;
use crate::least_squares::Factor;
use crate::left::Miss;
use crate::visit::{Rows, Seen, Visit};

/// What is said of the poses' errors before they are measured, rms over the disk and all orientations.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Predicted {
    /// Of x and y together, track radii.
    pub place: f64,
    /// Of theta, rad.
    pub turn_rad: f64,
}

/// Errors in x and y, or in theta: track radii, or rad.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Errors {
    /// Root mean square, the instrument's noise in it; of x and y the error's length. Numbers of the instrument that were fitted are
    /// paid for.
    pub seen: f64,
    /// What noise alone would be.
    pub noise: f64,
    /// What noise and the predicted errors would be together.
    pub predicted: f64,
    /// The largest.
    pub largest: f64,
    /// The visit where that is, from 0.
    pub at: usize,
}

impl Errors {
    /// What is left without the noise: the stage's own.
    #[must_use]
    pub fn of_stage(&self) -> f64 {
        (self.seen.powi(2) - self.noise.powi(2)).max(0.0).sqrt()
    }

    /// What is predicted of the stage's own.
    #[must_use]
    pub fn predicted_of_stage(&self) -> f64 {
        (self.predicted.powi(2) - self.noise.powi(2))
            .max(0.0)
            .sqrt()
    }

    /// What was seen over what was to be seen.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.seen / self.predicted
    }
}

/// What has come of it.
#[derive(Clone, PartialEq, Debug)]
pub struct Judged {
    /// Square misses over what noise alone makes of them, a row.
    pub chi2: f64,
    /// In x and y, where the instrument sees them: of its target, or of its marks.
    pub places: Option<Errors>,
    /// In theta, where the instrument sees it.
    pub turns: Option<Errors>,
    /// What each visit was off.
    pub visits: Vec<Miss>,
}

/// Sums over rows of one kind.
#[derive(Clone, Copy, Default)]
struct Sum {
    rows: f64,
    chi2: f64,
    square: f64,
    noise: f64,
    predicted: f64,
    largest: f64,
    at: usize,
}

impl Sum {
    /// One row: its square miss in standard deviations, the share of it that the instrument's numbers have left, and squares of noise and
    /// prediction.
    fn add(&mut self, square: f64, left: f64, noise: f64, predicted: f64) {
        self.rows += left;
        self.chi2 += square;
        self.square += square * noise;
        self.noise += left * noise;
        self.predicted += left * (noise + predicted);
    }

    fn largest(&mut self, size: f64, visit: usize) {
        if size > self.largest {
            (self.largest, self.at) = (size, visit);
        }
    }

    /// With as many rows in a visit.
    fn errors(&self, rows: f64) -> Option<Errors> {
        let rms = |sum: f64| (rows * sum / self.rows).sqrt();
        (self.rows > 0.0).then(|| Errors {
            seen: rms(self.square),
            noise: rms(self.noise),
            predicted: rms(self.predicted),
            largest: self.largest,
            at: self.at,
        })
    }
}

/// Judges a machine by visits.
///
/// # Errors
/// [`FitError`].
pub fn judge(
    instrument: &Instrument,
    machine: &Machine,
    visits: &[Visit],
    predicted: &Predicted,
) -> Result<Judged, FitError> {
    check(instrument, visits)?;
    let mut state = State::new(aligned(instrument, visits)).of_machine(machine);
    let (factor, _) = state.settle(visits, &vec![1.0; visits.len()])?;
    let (machine, unknowns) = state.values();
    let (mut places, mut turns) = (Sum::default(), Sum::default());
    let mut errors = Vec::new();
    for (visit, measured) in visits.iter().enumerate() {
        let rows = state.rows(&machine, &unknowns, visit, measured)?;
        let left = shares_left(&rows, &state.sizes, &factor)?;
        let mut error = [0.0; 3];
        for &row in rows.seen {
            error[row] = rows.misses[row] * rows.noise[row];
        }
        let arm = arm(instrument, &unknowns, &measured.seen);
        let place = predicted
            .place
            .powi(2)
            .midpoint((arm * predicted.turn_rad).powi(2));
        for &row in rows.seen {
            let square = rows.misses[row].powi(2);
            let (sum, predicted) = match row {
                2 => (&mut turns, predicted.turn_rad.powi(2)),
                _ => (&mut places, place),
            };
            sum.add(square, left[row], rows.noise[row].powi(2), predicted);
        }
        places.largest(error[0].hypot(error[1]), visit);
        turns.largest(error[2].abs(), visit);
        errors.push(Miss {
            off: error,
            seen: rows.seen,
            noise: rows.noise.into(),
        });
    }
    let axes = if instrument.ends.is_empty() { 2.0 } else { 1.0 };
    Ok(Judged {
        chi2: (places.chi2 + turns.chi2) / (places.rows + turns.rows),
        places: places.errors(axes),
        turns: turns.errors(1.0),
        visits: errors,
    })
}

/// How much of each row's square the fitted numbers leave.
fn shares_left(rows: &Rows, sizes: &[f64], factor: &Factor) -> Result<[f64; 3], FitError> {
    let mut derivatives = DMatrix::zeros(sizes.len(), 3);
    rows.for_columns(sizes, |column, values| {
        derivatives.set_row(column, &values.transpose());
    });
    let spread = factor.spread(&derivatives).ok_or(FitError::NotFinite)?;
    Ok([0, 1, 2].map(|row| 1.0 - spread.column(row).norm_squared()))
}

/// How far from the platform's middle is what the instrument looks at: there errors of theta are errors of place.
fn arm(instrument: &Instrument, unknowns: &[f64], seen: &Seen) -> f64 {
    let at = match *seen {
        Seen::Pose(_) | Seen::Place(_) => 3,
        Seen::Mark { mark, .. } => instrument.mark_at(mark),
        Seen::Turn(_) | Seen::End { .. } => return 0.0,
    };
    match unknowns.get(at..at + 2) {
        Some(&[x, y]) => x.hypot(y),
        _ => 0.0,
    }
}
