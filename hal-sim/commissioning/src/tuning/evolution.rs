//! Minimum of a function with narrow curved valleys, without derivatives: evolution strategy with covariance matrix adaptation (Hansen, "The
//! CMA Evolution Strategy: A Tutorial", arXiv 1604.00772, with its default numbers but for the children). The same start gives the same end.

use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Normal numbers, always the same ones: SplitMix64, and Box and Muller's pairs.
struct Normal(u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let size = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        size * (TAU * self.uniform()).cos()
    }
}

/// How much is tried.
pub(super) struct Effort {
    /// Size of the first steps.
    pub step: f64,
    /// Points of a generation.
    pub children: usize,
    /// Generations.
    pub generations: usize,
}

/// The best point of all generations from a start, and its cost.
pub(super) fn evolve(
    start: &DVector<f64>,
    effort: &Effort,
    cost: impl Fn(&DVector<f64>) -> f64,
) -> (DVector<f64>, f64) {
    let dimensions = start.len();
    let n = dimensions as f64;
    let children = effort.children;
    let parents = children / 2;
    let raw: Vec<f64> = (1..=parents)
        .map(|k| (0.5 * (children as f64 + 1.0)).ln() - (k as f64).ln())
        .collect();
    let sum: f64 = raw.iter().sum();
    let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
    let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
    let path_rate = (effective + 2.0) / (n + effective + 5.0);
    let damping =
        1.0 + 2.0 * f64::max(0.0, ((effective - 1.0) / (n + 1.0)).sqrt() - 1.0) + path_rate;
    let shape_rate = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
    let one_rate = 2.0 / ((n + 1.3).powi(2) + effective);
    let many_rate = f64::min(
        1.0 - one_rate,
        2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective),
    );
    let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

    let mut normal = Normal(1);
    let (mut mean, mut sigma) = (start.clone(), effort.step);
    let mut covariance = DMatrix::identity(dimensions, dimensions);
    let (mut step_path, mut shape_path) = (DVector::zeros(dimensions), DVector::zeros(dimensions));
    let mut best = (start.clone(), cost(start));
    for generation in 1..=effort.generations {
        let eigen = covariance.clone().symmetric_eigen();
        let scales = eigen.eigenvalues.map(|value: f64| value.max(1e-20).sqrt());
        let root = &eigen.eigenvectors * DMatrix::from_diagonal(&scales);
        let mut all: Vec<_> = (0..children)
            .map(|_| {
                let draw = DVector::from_fn(dimensions, |_, _| normal.next());
                let way = &root * draw;
                let point = &mean + sigma * &way;
                (cost(&point), way, point)
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        if all[0].0 < best.1 {
            best = (all[0].2.clone(), all[0].0);
        }
        let way: DVector<f64> = (all.iter().zip(&weights))
            .fold(DVector::zeros(dimensions), |sum, ((_, way, _), &weight)| {
                sum + way * weight
            });
        mean += sigma * &way;
        let whitened =
            &eigen.eigenvectors * (eigen.eigenvectors.tr_mul(&way)).component_div(&scales);
        step_path = step_path * (1.0 - path_rate)
            + whitened * (path_rate * (2.0 - path_rate) * effective).sqrt();
        let length: f64 = step_path.norm();
        let settled = (1.0 - (1.0 - path_rate).powi(2 * generation as i32)).sqrt();
        let goes_on = if length / settled < (1.4 + 2.0 / (n + 1.0)) * expected {
            1.0
        } else {
            0.0
        };
        shape_path = shape_path * (1.0 - shape_rate)
            + &way * (goes_on * (shape_rate * (2.0 - shape_rate) * effective).sqrt());
        let mut many = DMatrix::zeros(dimensions, dimensions);
        for ((_, way, _), &weight) in all.iter().zip(&weights) {
            many += way * way.transpose() * weight;
        }
        let kept = 1.0 - one_rate - many_rate
            + (1.0 - goes_on) * one_rate * shape_rate * (2.0 - shape_rate);
        covariance =
            covariance * kept + &shape_path * shape_path.transpose() * one_rate + many * many_rate;
        sigma *= (path_rate / damping * (length / expected - 1.0))
            .min(1.0)
            .exp();
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_end_of_a_curved_valley() {
        // Rosenbrock's, in four dimensions: its minimum is 0 at all ones.
        let cost = |at: &DVector<f64>| -> f64 {
            (0..3)
                .map(|k| 100.0 * (at[k + 1] - at[k] * at[k]).powi(2) + (1.0 - at[k]).powi(2))
                .sum()
        };
        let effort = Effort {
            step: 0.5,
            children: 8,
            generations: 250,
        };
        let (at, least) = evolve(&DVector::from_element(4, -0.5), &effort, cost);
        assert!(
            least < 1e-9 && (at - DVector::from_element(4, 1.0)).norm() < 1e-3,
            "{least}"
        );
    }
}
