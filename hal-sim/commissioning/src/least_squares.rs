//! Non-linear least squares by Levenberg's and Marquardt's steps, derivatives by differences.

use nalgebra::{DMatrix, DVector};

/// Where it ended.
pub struct Minimum {
    /// The unknowns.
    pub at: DVector<f64>,
    /// Sum of the squared residuals.
    pub cost: f64,
    /// Inverse of the normal matrix: the covariance, if residuals are in units of their deviations.
    pub covariance: DMatrix<f64>,
}

/// Step of an unknown for its derivative: unknowns are logarithms, or of size 1.
const STEP: f64 = 1e-5;
/// A cost that falls by less, over itself, ends the search.
const ENOUGH: f64 = 1e-7;

/// Minimises the sum of squares of what `residuals` gives. `None` where even the start gives no number.
pub fn minimise(
    start: &DVector<f64>,
    steps: usize,
    residuals: impl Fn(&DVector<f64>) -> DVector<f64>,
) -> Option<Minimum> {
    let (mut at, mut now) = (start.clone(), residuals(start));
    let mut cost = now.norm_squared();
    let mut damping = 1e-2;
    let mut normal = DMatrix::identity(at.len(), at.len());
    if !cost.is_finite() {
        return None;
    }
    for _ in 0..steps {
        let slopes = slopes(&at, &residuals);
        normal = slopes.tr_mul(&slopes);
        let downhill = slopes.tr_mul(&now);
        let mut fell = 0.0;
        for _ in 0..12 {
            let mut damped = normal.clone();
            for i in 0..at.len() {
                damped[(i, i)] += damping * normal[(i, i)].max(1e-12);
            }
            let step = damped.cholesky()?.solve(&downhill);
            let next = &at - step;
            let there = residuals(&next);
            let next_cost = there.norm_squared();
            if next_cost < cost {
                fell = (cost - next_cost) / cost;
                (at, now, cost) = (next, there, next_cost);
                damping = f64::max(damping * 0.3, 1e-9);
                break;
            }
            damping *= 4.0;
        }
        if fell < ENOUGH {
            break;
        }
    }
    let covariance = normal.try_inverse()?;
    Some(Minimum {
        at,
        cost,
        covariance,
    })
}

fn slopes(at: &DVector<f64>, residuals: &impl Fn(&DVector<f64>) -> DVector<f64>) -> DMatrix<f64> {
    let columns: Vec<_> = (0..at.len())
        .map(|unknown| {
            let moved = |by: f64| {
                let mut moved = at.clone();
                moved[unknown] += by;
                residuals(&moved)
            };
            (moved(STEP) - moved(-STEP)) / (2.0 * STEP)
        })
        .collect();
    DMatrix::from_columns(&columns)
}
