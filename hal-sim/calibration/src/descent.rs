//! Gauss-Newton's steps: the problem at the place where all unknowns stand, its factor, and the step to its solution.

use kinematics::COEFFICIENTS;
use nalgebra::DVector;

use crate::error::FitError;
use crate::kit::Instrument;
use crate::least_squares::{Factor, Problem};
use crate::numbers;
use crate::position::OutOfReach;
use crate::visit::{Rows, Visit};
use crate::{DRAWN, MACHINE_NUMBERS, Machine};

/// Steps at most; five are usual.
const MAX_STEPS: usize = 12;
/// A step so small, over the uncertainty that stays, changes nothing.
const SMALL_STEP: f64 = 0.02;

/// Where Gauss-Newton stands: all unknowns, in their sizes.
pub(crate) struct State {
    pub(crate) instrument: Instrument,
    /// From where the machine's numbers are counted.
    machine: Machine,
    pub(crate) sizes: Vec<f64>,
    guess: Vec<f64>,
    pub(crate) now: DVector<f64>,
}

impl State {
    pub(crate) fn new(instrument: Instrument) -> Self {
        Self {
            machine: DRAWN,
            sizes: instrument.sizes(),
            guess: instrument.guess(),
            now: DVector::zeros(instrument.unknowns()),
            instrument,
        }
    }

    /// With the instrument's numbers alone unknown: the machine is this one, and its numbers have no size.
    pub(crate) fn of_machine(mut self, machine: &Machine) -> Self {
        self.machine = *machine;
        self.sizes[..MACHINE_NUMBERS].fill(0.0);
        self
    }

    /// The machine and the instrument's unknowns.
    pub(crate) fn values(&self) -> (Machine, Vec<f64>) {
        let mut machine = self.machine;
        let off: Vec<f64> = (self.now.iter().zip(&self.sizes))
            .map(|(now, size)| now * size)
            .collect();
        for (pivot, off) in machine.iter_mut().zip(off.as_chunks::<COEFFICIENTS>().0) {
            let from = numbers::to_list(pivot);
            *pivot = numbers::from_list(&core::array::from_fn(|number| from[number] + off[number]));
        }
        let unknowns = (self.guess.iter().zip(off.iter().skip(MACHINE_NUMBERS)))
            .map(|(guess, off)| guess + off)
            .collect();
        (machine, unknowns)
    }

    /// Plain steps until they are small.
    pub(crate) fn descend(&mut self, visits: &[Visit], weights: &[f64]) -> Result<usize, FitError> {
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

    /// As [`Self::descend`], with the last step's factor.
    pub(crate) fn settle(
        &mut self,
        visits: &[Visit],
        weights: &[f64],
    ) -> Result<(Factor, usize), FitError> {
        let mut steps = 1;
        let (mut factor, mut size) = self.step(visits, weights)?;
        while size >= SMALL_STEP && steps < MAX_STEPS {
            (factor, size) = self.step(visits, weights)?;
            steps += 1;
        }
        Ok((factor, steps))
    }

    /// One step; also how large it was over the uncertainty that stays, in the root mean square of all unknowns.
    pub(crate) fn step(
        &mut self,
        visits: &[Visit],
        weights: &[f64],
    ) -> Result<(Factor, f64), FitError> {
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
        put_scale(&mut problem, &self.instrument, &unknowns, &self.sizes);
        Ok(problem)
    }

    pub(crate) fn rows(
        &self,
        machine: &Machine,
        unknowns: &[f64],
        visit: usize,
        measured: &Visit,
    ) -> Result<Rows, FitError> {
        Rows::new(&self.instrument, machine, unknowns, measured).map_err(|OutOfReach| {
            FitError::Visit {
                visit,
                reason: "no pose has these encoder angles",
            }
        })
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
