//! Rows of a least-squares problem to an orthogonal factor, by Householder's reflections, and what the factor says of uncertainty.
//!
//! Every unknown is counted in its own size, so what is known before is a row of 1 for each of them: the factor starts with these.
//! Measured rows are folded in some at a time, while they are in the cache. Normal equations would square the condition and lose
//! the weak directions.

use nalgebra::{DMatrix, DVector};

/// Rows that are folded in at once.
const BLOCK: usize = 64;

/// The problem's triangular factor: `R z = q` has the solution, `R^-1 R^-T` is the covariance.
#[derive(Clone, Debug)]
pub struct Factor {
    /// R, upper triangular.
    pub root: DMatrix<f64>,
    /// q.
    right: DVector<f64>,
}

/// A problem that rows are added to.
#[derive(Clone, Debug)]
pub struct Problem {
    /// R and beside it q, transposed: a row of R is a column here, and lies in one piece.
    factor: DMatrix<f64>,
    /// Rows that are not in the factor yet; the right side is the last column.
    block: DMatrix<f64>,
    rows: usize,
}

impl Problem {
    /// With what is known before: each unknown is 0 to 1, and stands at `now`.
    #[must_use]
    pub fn new(now: &DVector<f64>) -> Self {
        let mut problem = Self::without_priors(now.len());
        for (unknown, value) in now.iter().enumerate() {
            problem.factor[(unknown, unknown)] = 1.0;
            problem.factor[(now.len(), unknown)] = -value;
        }
        problem
    }

    /// With nothing known before.
    #[must_use]
    pub fn without_priors(unknowns: usize) -> Self {
        Self {
            factor: DMatrix::zeros(unknowns + 1, unknowns),
            block: DMatrix::zeros(BLOCK, unknowns + 1),
            rows: 0,
        }
    }

    /// One coefficient of the row that is being written; the others are 0.
    pub fn set(&mut self, unknown: usize, value: f64) {
        self.block[(self.rows, unknown)] = value;
    }

    /// Ends the row with its right side.
    pub fn end_row(&mut self, right: f64) {
        self.set(self.factor.ncols(), right);
        self.rows += 1;
        if self.rows == BLOCK {
            self.fold();
        }
    }

    /// All rows in the factor.
    #[must_use]
    pub fn factor(mut self) -> Factor {
        self.fold();
        let unknowns = self.factor.ncols();
        Factor {
            root: self.factor.rows(0, unknowns).transpose(),
            right: self.factor.row(unknowns).transpose(),
        }
    }

    /// Reflects each column of the block into the factor's diagonal.
    fn fold(&mut self) {
        let columns = self.block.ncols();
        for k in 0..self.factor.ncols() {
            let (reflected, mut others) = self.block.columns_range_pair_mut(k, k + 1..columns);
            let below = reflected.norm_squared();
            if below == 0.0 {
                continue;
            }
            let diagonal = self.factor[(k, k)];
            let length = -(diagonal * diagonal + below).sqrt().copysign(diagonal);
            let first = diagonal - length;
            let scale = 2.0 / (first * first + below);
            self.factor[(k, k)] = length;
            let mut row = self.factor.column_mut(k);
            for (mut other, entry) in (others.column_iter_mut()).zip(row.iter_mut().skip(k + 1)) {
                let share = scale * (first * *entry + reflected.dot(&other));
                *entry -= share * first;
                other.axpy(-share, &reflected, 1.0);
            }
        }
        self.block.fill(0.0);
        self.rows = 0;
    }
}

impl Factor {
    /// The step to the solution; `None` if an unknown is in no row.
    #[must_use]
    pub fn step(&self) -> Option<DVector<f64>> {
        self.root.solve_upper_triangular(&self.right)
    }

    /// What columns of derivatives make of the uncertainty: `R^-T a` for each column a, whose squares add up to its variance.
    #[must_use]
    pub fn spread(&self, derivatives: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        self.root.tr_solve_upper_triangular(derivatives)
    }

    /// One standard deviation of each unknown, in its size.
    #[must_use]
    pub fn deviations(&self) -> Option<Vec<f64>> {
        let unknowns = self.root.ncols();
        let inverse = self.spread(&DMatrix::identity(unknowns, unknowns))?;
        Some(inverse.column_iter().map(|column| column.norm()).collect())
    }

    /// Numbers that the measured rows have paid for: all less what was known before.
    #[must_use]
    pub fn fitted(&self) -> Option<f64> {
        let unknowns = self.root.ncols();
        let inverse = self.spread(&DMatrix::identity(unknowns, unknowns))?;
        Some(unknowns as f64 - inverse.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A 7th degree polynomial through 200 points and weak priors, against the normal equations, which this small problem bears.
    #[test]
    fn the_factor_solves_and_covers() {
        const UNKNOWNS: usize = 8;
        let now = DVector::from_fn(UNKNOWNS, |i, _| 0.1 * i as f64);
        let mut problem = Problem::new(&now);
        let mut square = DMatrix::<f64>::identity(UNKNOWNS, UNKNOWNS);
        let mut right = -&now;
        for point in 0..200 {
            let x = f64::from(point) / 200.0;
            let row = DVector::from_fn(UNKNOWNS, |power, _| 10.0 * x.powi(power as i32));
            let value = (5.0 * x).sin();
            for (unknown, &coefficient) in row.iter().enumerate() {
                problem.set(unknown, coefficient);
            }
            problem.end_row(value);
            square += &row * row.transpose();
            right += &row * value;
        }
        let factor = problem.factor();
        let covariance = square.try_inverse().expect("priors make it regular");
        let step = factor.step().expect("full rank");
        assert!((step - &covariance * right).amax() < 1e-9);
        let spread = (factor.spread(&DMatrix::identity(UNKNOWNS, UNKNOWNS))).expect("full rank");
        assert!((spread.tr_mul(&spread) - &covariance).amax() < 1e-9);
        let deviations = factor.deviations().expect("full rank");
        for (deviation, variance) in deviations.iter().zip(covariance.diagonal().iter()) {
            assert!((deviation * deviation - variance).abs() < 1e-9);
        }
        let fitted = factor.fitted().expect("full rank");
        assert!((fitted - (UNKNOWNS as f64 - covariance.trace())).abs() < 1e-9);
    }

    #[test]
    fn an_unknown_in_no_row_is_noticed() {
        let mut problem = Problem::without_priors(2);
        problem.set(0, 1.0);
        problem.end_row(1.0);
        assert_eq!(problem.factor().step(), None);
    }
}
