//! Rows of a least-squares problem to an orthogonal factor, by Householder's reflections, and what the factor says of uncertainty.
//!
//! Every unknown is counted in its own size, so a row of 1 for each of them is what is known before: it stands above the measured rows.
//! Normal equations would square the condition and lose the weak directions.

use nalgebra::{DMatrix, DVector};

/// The problem's triangular factor: `R z = q` has the solution, `R^-1 R^-T` is the covariance.
#[derive(Clone, Debug)]
pub struct Factor {
    /// R, upper triangular.
    pub root: DMatrix<f64>,
    right: DVector<f64>,
}

/// Measured rows, with room for what is known before.
#[derive(Clone, Debug)]
pub struct Problem {
    rows: DMatrix<f64>,
    right: DVector<f64>,
    unknowns: usize,
    next: usize,
}

impl Problem {
    /// With rows of what is known before: each unknown is 0 to 1, and stands at `now`.
    #[must_use]
    pub fn new(now: &DVector<f64>, measured_rows: usize) -> Self {
        let unknowns = now.len();
        let mut problem = Self::without_priors(unknowns, unknowns + measured_rows);
        for (place, value) in now.iter().enumerate() {
            problem.set(place, 1.0);
            problem.end_row(-value);
        }
        problem
    }

    /// With measured rows alone.
    #[must_use]
    pub fn without_priors(unknowns: usize, rows: usize) -> Self {
        Self {
            rows: DMatrix::zeros(rows.max(unknowns), unknowns),
            right: DVector::zeros(rows.max(unknowns)),
            unknowns,
            next: 0,
        }
    }

    /// One coefficient of the row that is being written.
    pub fn set(&mut self, unknown: usize, value: f64) {
        self.rows[(self.next, unknown)] = value;
    }

    /// Ends the row with its right side.
    pub fn end_row(&mut self, right: f64) {
        self.right[self.next] = right;
        self.next += 1;
    }

    /// Householder's reflections, column by column.
    #[must_use]
    pub fn factor(self) -> Factor {
        let Self {
            rows,
            mut right,
            unknowns,
            ..
        } = self;
        let qr = rows.qr();
        qr.q_tr_mul(&mut right);
        Factor {
            root: qr.unpack_r(),
            right: right.rows(0, unknowns).into(),
        }
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

    /// Numbers that the measured rows have paid for: all less what was known before.
    #[must_use]
    pub fn fitted(&self) -> Option<f64> {
        let unknowns = self.root.ncols();
        let inverse = self.spread(&DMatrix::identity(unknowns, unknowns))?;
        Some(unknowns as f64 - inverse.norm_squared())
    }
}
