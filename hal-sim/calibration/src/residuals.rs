//! What is left of the measured values after a fit: how large it is beside the noise, and which visits are outliers.

use nalgebra::DMatrix;

use crate::descent::State;
use crate::error::FitError;
use crate::fit::{few, is_held_out};
use crate::least_squares::Factor;
use crate::scatter::Over;
use crate::visit::Visit;

/// Steps with soft L1 before outliers are looked for.
const SOFT_STEPS: usize = 2;
/// From so many standard deviations on, a miss counts less.
const SOFT_FROM: f64 = 2.0;
/// A miss beyond so many standard deviations is an outlier.
const CUT: f64 = 4.0;
/// While there are larger ones, only misses over this share of the largest are cut.
const CUT_SHARE: f64 = 0.3;

impl State {
    /// Takes the weight of outliers away, the worst first: while one of 100 standard deviations pulls, others of 10 cannot be told from
    /// good visits.
    pub(crate) fn cut(
        &mut self,
        visits: &[Visit],
        weights: &mut [f64],
        said_rad: f64,
    ) -> Result<usize, FitError> {
        let mut steps = 0;
        loop {
            let (factor, _) = self.step(visits, weights)?;
            self.find_scatter(visits, weights, &factor, said_rad, Over::Median)?;
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
            let out = out
                .enumerate()
                .filter(|&(visit, is_out)| is_out && !is_held_out(visit));
            let out: Vec<usize> = out.map(|(visit, _)| visit).collect();
            for &visit in &out {
                weights[visit] = 0.0;
            }
            few(out.len(), visits.len(), chi2)?;
        }
    }

    /// The largest miss of each visit, in standard deviations.
    pub(crate) fn misses(&self, visits: &[Visit]) -> Result<Vec<f64>, FitError> {
        let (machine, unknowns) = self.values();
        (visits.iter().enumerate())
            .map(|(visit, measured)| {
                let rows = self.rows(&machine, &unknowns, visit, measured)?;
                let seen = rows.seen.iter().map(|&row| rows.misses[row].abs());
                Ok(seen.fold(0.0, f64::max))
            })
            .collect()
    }

    /// Visits that miss by more than the noise allows; of those that are not in the fit, by more than noise and fit allow.
    pub(crate) fn outliers(
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

    /// Of visits in the fit, and the rows that are left: each fitted number has taken one away.
    pub(crate) fn chi2(
        &self,
        visits: &[Visit],
        weights: &[f64],
        factor: &Factor,
    ) -> Result<(f64, f64), FitError> {
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
        let rows_left = count - factor.fitted().ok_or(FitError::NotFinite)?;
        Ok((square / rows_left, rows_left))
    }

    /// Of visits that are not in the fit.
    pub(crate) fn chi2_of_new(
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
        let square =
            |&row: &usize| rows.misses[row].powi(2) / (1.0 + spread.column(row).norm_squared());
        Ok(rows.seen.iter().map(square).collect())
    }
}
