//! The fit: Gauss-Newton, robust, with some visits held out to see whether it holds where it was not made.
//!
//! First plain steps, since at the start every miss is large and says nothing; then steps in which a visit that misses by much counts
//! less (soft L1), and those beyond four standard deviations are left out, the worst first. What was held out is judged by that fit
//! and joins the last steps.

use kinematics::COEFFICIENTS;
use nalgebra::{DMatrix, DVector};

use crate::kit::Instrument;
use crate::least_squares::{Factor, Problem};
use crate::numbers;
use crate::position::OutOfReach;
use crate::visit::{Rows, Seen, Visit};
use crate::{DRAWN, MACHINE_NUMBERS, Machine};

/// Steps at most; five are usual.
const MAX_STEPS: usize = 12;
/// A step so small, over the uncertainty that stays, changes nothing.
const SMALL_STEP: f64 = 0.02;
/// Steps with soft L1.
const SOFT_STEPS: usize = 2;
/// From so many standard deviations on, a miss counts less.
const SOFT_FROM: f64 = 2.0;
/// A miss beyond so many standard deviations is an outlier.
const CUT: f64 = 4.0;
/// While there are larger ones, only misses over this share of the largest are cut.
const CUT_SHARE: f64 = 0.3;
/// Share of visits that may be outliers.
const MOST_OUTLIERS: f64 = 0.03;
/// Visits of twenty that are held out: spread, since a plan has the most telling ones first.
const HELD_OUT: [usize; 3] = [6, 13, 19];

/// A fitted machine.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The machine.
    pub machine: Machine,
    /// The instrument's unknowns, in the order of [`Instrument::guess`].
    pub unknowns: Vec<f64>,
    /// The factor of the last step.
    pub factor: Factor,
    /// Square misses over what is expected of them, a row: 1 where noise and model are right.
    pub chi2: f64,
    /// The same of the visits that were held out.
    pub chi2_held_out: f64,
    /// Visits that were left out, by their places in the list.
    pub outliers: Vec<usize>,
    /// Steps that were made.
    pub steps: usize,
}

/// Why there is no fit.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum FitError {
    /// There is nothing to fit to.
    #[error("{visits} visits: a fit needs {least} or more")]
    TooFew {
        /// How many there are.
        visits: usize,
        /// How many it takes.
        least: usize,
    },
    /// A visit is no visit of this instrument.
    #[error("visit {}: {reason}", .visit + 1)]
    Visit {
        /// Which, from 0.
        visit: usize,
        /// Why.
        reason: &'static str,
    },
    /// It does not come to rest: the readings belong to another machine, or the instrument is not where it was said to be.
    #[error("no fit after {steps} steps: {chi2:.3e} times the noise's square is left; are axes, signs and places those of this stage?")]
    NoEnd {
        /// Steps that were made.
        steps: usize,
        /// Mean square miss over the noise.
        chi2: f64,
    },
    /// Too many visits miss by much: the noise is larger than was said, or the machine is not of this model.
    #[error("{outliers} of {visits} visits miss by more than 4 standard deviations (chi^2 {chi2:.2}): is the noise larger than was said?")]
    TooManyOutliers {
        /// How many.
        outliers: usize,
        /// Of how many.
        visits: usize,
        /// Mean square miss over the noise.
        chi2: f64,
    },
    /// A number is not finite.
    #[error("a measured value is not finite, or far too large")]
    NotFinite,
}

/// Whether a visit is held out, by its place in the list.
fn is_held_out(visit: usize) -> bool {
    HELD_OUT.contains(&(visit % 20))
}

/// Where Gauss-Newton stands: all unknowns, in their sizes.
struct State<'a> {
    instrument: &'a Instrument,
    sizes: Vec<f64>,
    guess: Vec<f64>,
    now: DVector<f64>,
}

/// Fits a machine, and what is unknown about the instrument, to visits.
///
/// # Errors
/// [`FitError`].
pub fn fit(instrument: &Instrument, visits: &[Visit]) -> Result<Fit, FitError> {
    check(instrument, visits)?;
    let mut state = State::new(instrument);
    let mut weights: Vec<f64> = (0..visits.len())
        .map(|visit| f64::from(u8::from(!is_held_out(visit))))
        .collect();
    let mut steps = state.descend(visits, &weights)?;
    steps += state.cut(visits, &mut weights)?;
    let (factor, more) = state.settle(visits, &weights)?;
    steps += more;
    // A visit may come back, or go, now that outliers no longer pull.
    let outliers = state.outliers(visits, &weights, &factor)?;
    let held_out: Vec<usize> = (0..visits.len())
        .filter(|visit| is_held_out(*visit) && !outliers.contains(visit))
        .collect();
    let chi2_held_out = state.chi2_of_new(visits, &held_out, &factor)?;
    let weights: Vec<f64> = (0..visits.len())
        .map(|visit| f64::from(u8::from(!outliers.contains(&visit))))
        .collect();
    let (factor, more) = state.settle(visits, &weights)?;
    steps += more;
    let chi2 = state.chi2(visits, &weights, &factor)?;
    few(outliers.len(), visits.len(), chi2)?;
    let (machine, unknowns) = state.values();
    Ok(Fit {
        machine,
        unknowns,
        factor,
        chi2,
        chi2_held_out,
        outliers,
        steps,
    })
}

/// Refuses too many outliers.
fn few(outliers: usize, visits: usize, chi2: f64) -> Result<(), FitError> {
    if outliers as f64 > MOST_OUTLIERS * visits as f64 {
        return Err(FitError::TooManyOutliers {
            outliers,
            visits,
            chi2,
        });
    }
    Ok(())
}

/// Every visit is one that the instrument can make.
fn check(instrument: &Instrument, visits: &[Visit]) -> Result<(), FitError> {
    const LEAST: usize = 12;
    if visits.len() < LEAST {
        return Err(FitError::TooFew {
            visits: visits.len(),
            least: LEAST,
        });
    }
    for (visit, Visit { readings_rad, seen }) in visits.iter().enumerate() {
        if !readings_rad.iter().chain(seen.values()).all(|value| value.is_finite()) {
            let reason = "a value is not finite";
            return Err(FitError::Visit { visit, reason });
        }
        if let Seen::Mark { mark, camera, .. } = *seen {
            if mark >= instrument.marks.len() {
                let reason = "the plate has no such mark";
                return Err(FitError::Visit { visit, reason });
            }
            if camera >= instrument.cameras.len() {
                let reason = "the camera has no such place";
                return Err(FitError::Visit { visit, reason });
            }
        } else if !instrument.cameras.is_empty() {
            let reason = "a camera sees marks";
            return Err(FitError::Visit { visit, reason });
        }
    }
    Ok(())
}

impl<'a> State<'a> {
    fn new(instrument: &'a Instrument) -> Self {
        Self {
            instrument,
            sizes: instrument.sizes(),
            guess: instrument.guess(),
            now: DVector::zeros(instrument.unknowns()),
        }
    }

    /// The machine and the instrument's unknowns.
    fn values(&self) -> (Machine, Vec<f64>) {
        let mut machine = DRAWN;
        let off: Vec<f64> = (self.now.iter().zip(&self.sizes))
            .map(|(now, size)| now * size)
            .collect();
        for (pivot, numbers) in machine.iter_mut().zip(off.as_chunks::<COEFFICIENTS>().0) {
            *pivot = numbers::from_list(numbers);
        }
        let unknowns = (self.guess.iter().zip(off.iter().skip(MACHINE_NUMBERS)))
            .map(|(guess, off)| guess + off)
            .collect();
        (machine, unknowns)
    }

    /// Plain steps until they are small.
    fn descend(&mut self, visits: &[Visit], weights: &[f64]) -> Result<usize, FitError> {
        for step in 1..=MAX_STEPS {
            let (_, size) = self.step(visits, weights)?;
            if size < SMALL_STEP {
                return Ok(step);
            }
        }
        let misses = self.misses(visits)?;
        let square: f64 = misses.iter().map(|miss| miss * miss).sum();
        Err(FitError::NoEnd {
            steps: MAX_STEPS,
            chi2: square / misses.len() as f64,
        })
    }

    /// Takes the weight of outliers away, the worst first: while one of 100 standard deviations pulls, others of 10 cannot be told from
    /// good visits.
    fn cut(&mut self, visits: &[Visit], weights: &mut [f64]) -> Result<usize, FitError> {
        let mut steps = 0;
        loop {
            for _ in 0..SOFT_STEPS {
                let misses = self.misses(visits)?;
                let soft: Vec<f64> = (weights.iter().zip(&misses))
                    .map(|(weight, miss)| weight / (1.0 + (miss / SOFT_FROM).powi(2)).sqrt().sqrt())
                    .collect();
                self.step(visits, &soft)?;
                steps += 1;
            }
            let misses = self.misses(visits)?;
            let kept = || (weights.iter().zip(&misses)).filter(|(weight, _)| **weight > 0.0);
            let largest = kept().map(|(_, miss)| *miss).fold(0.0, f64::max);
            if largest <= CUT {
                return Ok(steps);
            }
            let square: f64 = kept().map(|(_, miss)| miss * miss).sum();
            let chi2 = square / kept().count() as f64;
            let limit = CUT.max(CUT_SHARE * largest);
            let out = misses.iter().map(|&miss| !(miss <= limit));
            let out = out.enumerate().filter(|&(visit, is_out)| is_out && !is_held_out(visit));
            let out: Vec<usize> = out.map(|(visit, _)| visit).collect();
            for &visit in &out {
                weights[visit] = 0.0;
            }
            few(out.len(), visits.len(), chi2)?;
        }
    }

    /// As [`Self::descend`], with the last step's factor.
    fn settle(&mut self, visits: &[Visit], weights: &[f64]) -> Result<(Factor, usize), FitError> {
        let mut steps = 1;
        let (mut factor, mut size) = self.step(visits, weights)?;
        while size >= SMALL_STEP && steps < MAX_STEPS {
            (factor, size) = self.step(visits, weights)?;
            steps += 1;
        }
        Ok((factor, steps))
    }

    /// One step; also how large it was over the uncertainty that stays, in the root mean square of all unknowns.
    fn step(&mut self, visits: &[Visit], weights: &[f64]) -> Result<(Factor, f64), FitError> {
        let factor = self.linearised(visits, weights)?.factor();
        let step = factor.step().ok_or(FitError::NotFinite)?;
        if !step.iter().all(|number| number.is_finite()) {
            return Err(FitError::NotFinite);
        }
        self.now += &step;
        let size = (&factor.root * step).norm() / (self.now.len() as f64).sqrt();
        Ok((factor, size))
    }

    /// The problem at this place: what is known before, and the measured rows.
    fn linearised(&self, visits: &[Visit], weights: &[f64]) -> Result<Problem, FitError> {
        let (machine, unknowns) = self.values();
        let mut problem = Problem::new(&self.now);
        for (visit, measured) in visits.iter().enumerate() {
            let weight = weights[visit];
            if weight == 0.0 {
                continue;
            }
            let rows = self.rows(&machine, &unknowns, visit, measured)?;
            put_rows(&mut problem, &rows, &self.sizes, weight);
        }
        put_scale(&mut problem, self.instrument, &unknowns, &self.sizes);
        Ok(problem)
    }

    fn rows(
        &self,
        machine: &Machine,
        unknowns: &[f64],
        visit: usize,
        measured: &Visit,
    ) -> Result<Rows, FitError> {
        Rows::new(self.instrument, machine, unknowns, measured).map_err(|OutOfReach| {
            FitError::Visit {
                visit,
                reason: "no pose has these encoder angles",
            }
        })
    }

    /// The largest miss of each visit, in standard deviations.
    fn misses(&self, visits: &[Visit]) -> Result<Vec<f64>, FitError> {
        let (machine, unknowns) = self.values();
        (visits.iter().enumerate())
            .map(|(visit, measured)| {
                let rows = self.rows(&machine, &unknowns, visit, measured)?;
                let seen = rows.seen.iter().map(|&row| rows.misses[row].abs());
                Ok(seen.fold(0.0, f64::max))
            })
            .collect()
    }

    fn outliers(
        &self,
        visits: &[Visit],
        weights: &[f64],
        factor: &Factor,
    ) -> Result<Vec<usize>, FitError> {
        let mut outliers = Vec::new();
        for (visit, miss) in self.misses(visits)?.into_iter().enumerate() {
            let is_outlier = if weights[visit] > 0.0 || miss <= CUT {
                !(miss <= CUT)
            } else {
                let squares = self.squares_of_new(visits, visit, factor)?;
                squares.iter().any(|&square| !(square <= CUT * CUT))
            };
            if is_outlier {
                outliers.push(visit);
            }
        }
        Ok(outliers)
    }

    /// Of visits in the fit: each fitted number has taken one row's worth away.
    fn chi2(&self, visits: &[Visit], weights: &[f64], factor: &Factor) -> Result<f64, FitError> {
        let (machine, unknowns) = self.values();
        let (mut square, mut count) = (0.0, 0.0);
        for (visit, measured) in visits.iter().enumerate() {
            if weights[visit] > 0.0 {
                let rows = self.rows(&machine, &unknowns, visit, measured)?;
                for &row in rows.seen {
                    square += rows.misses[row].powi(2);
                    count += 1.0;
                }
            }
        }
        let fitted = factor.fitted().ok_or(FitError::NotFinite)?;
        Ok(square / (count - fitted))
    }

    /// Of visits that are not in the fit.
    fn chi2_of_new(
        &self,
        visits: &[Visit],
        chosen: &[usize],
        factor: &Factor,
    ) -> Result<f64, FitError> {
        let mut squares = Vec::new();
        for &visit in chosen {
            squares.extend(self.squares_of_new(visits, visit, factor)?);
        }
        Ok(squares.iter().sum::<f64>() / squares.len() as f64)
    }

    /// Square misses of a visit that is not in the fit, over what is expected: each has the fit's own uncertainty in it besides the
    /// noise.
    fn squares_of_new(
        &self,
        visits: &[Visit],
        visit: usize,
        factor: &Factor,
    ) -> Result<Vec<f64>, FitError> {
        let (machine, unknowns) = self.values();
        let rows = self.rows(&machine, &unknowns, visit, &visits[visit])?;
        let mut derivatives = DMatrix::zeros(self.now.len(), 3);
        rows.for_columns(&self.sizes, |column, values| {
            derivatives.set_row(column, &values.transpose());
        });
        let spread = factor.spread(&derivatives).ok_or(FitError::NotFinite)?;
        let square = |&row: &usize| {
            rows.misses[row].powi(2) / (1.0 + spread.column(row).norm_squared())
        };
        Ok(rows.seen.iter().map(square).collect())
    }
}

/// Writes a visit's rows.
pub(crate) fn put_rows(problem: &mut Problem, rows: &Rows, sizes: &[f64], weight: f64) {
    for &row in rows.seen {
        rows.for_columns(sizes, |column, values| {
            problem.set(column, weight * values[row]);
        });
        problem.end_row(weight * rows.misses[row]);
    }
}

/// The mean distance of the marks from the plate's middle is known: `sum (q - q0) . q0 / sum q0^2` is 0 to the scale's error.
pub(crate) fn put_scale(
    problem: &mut Problem,
    instrument: &Instrument,
    unknowns: &[f64],
    sizes: &[f64],
) {
    let marks = || instrument.marks.iter().enumerate();
    let square: f64 = marks().flat_map(|(_, mark)| mark).map(|q| q * q).sum();
    if square == 0.0 {
        return;
    }
    let mut off = 0.0;
    for (mark, nominal) in marks() {
        for (axis, q) in nominal.iter().enumerate() {
            let at = instrument.mark_at(mark) + axis;
            let by = q / square / instrument.scale;
            let column = MACHINE_NUMBERS + at;
            problem.set(column, by * sizes[column]);
            off += by * (unknowns[at] - q);
        }
    }
    problem.end_row(-off);
}
