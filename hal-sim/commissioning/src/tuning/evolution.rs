//! Minimum of a function with narrow curved valleys, without derivatives: evolution strategy with covariance matrix adaptation (Hansen, "The
//! CMA Evolution Strategy: A Tutorial", arXiv 1604.00772, with its default numbers but for the children). The same start gives the same end.

use nalgebra::{DMatrix, DVector};
use parallel::{cores, of_all};
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

/// How a search goes.
pub(super) struct Effort {
    /// Size of the first steps.
    pub step: f64,
    /// Points of a generation.
    pub children: usize,
    /// Size of steps at which it has ended.
    pub until: f64,
}

/// Weights of the best children, and how fast what was learnt of the valley follows them.
struct Rates {
    weights: Vec<f64>,
    effective: f64,
    path: f64,
    damping: f64,
    shape: f64,
    one: f64,
    many: f64,
    /// Length of a path that leads nowhere.
    expected: f64,
}

impl Rates {
    fn new(dimensions: usize, children: usize) -> Self {
        let n = dimensions as f64;
        let raw: Vec<f64> = (1..=children / 2)
            .map(|k| (0.5 * (children as f64 + 1.0)).ln() - (k as f64).ln())
            .collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let path = (effective + 2.0) / (n + effective + 5.0);
        let one = 2.0 / ((n + 1.3).powi(2) + effective);
        Self {
            weights,
            effective,
            path,
            damping: 1.0 + 2.0 * f64::max(0.0, ((effective - 1.0) / (n + 1.0)).sqrt() - 1.0) + path,
            shape: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            one,
            many: f64::min(
                1.0 - one,
                2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective),
            ),
            expected: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

/// A search, which goes on from where it stands as often as it is asked to.
pub(super) struct Evolution {
    effort: Effort,
    rates: Rates,
    normal: Normal,
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    step_path: DVector<f64>,
    shape_path: DVector<f64>,
    generation: i32,
    best: (DVector<f64>, f64),
}

impl Evolution {
    pub fn new(start: &DVector<f64>, effort: Effort) -> Self {
        let n = start.len();
        Self {
            rates: Rates::new(n, effort.children),
            normal: Normal(1),
            mean: start.clone(),
            sigma: effort.step,
            covariance: DMatrix::identity(n, n),
            step_path: DVector::zeros(n),
            shape_path: DVector::zeros(n),
            generation: 0,
            best: (start.clone(), f64::INFINITY),
            effort,
        }
    }

    /// So many generations more, of this cost: it may be another one than before.
    pub fn go_on(&mut self, generations: usize, cost: impl Fn(&DVector<f64>) -> f64 + Sync) {
        self.best.1 = cost(&self.best.0);
        for _ in 0..generations {
            if !self.has_another(&cost) {
                break;
            }
        }
    }

    /// The best point of all generations, and its cost.
    pub fn best(&self) -> &(DVector<f64>, f64) {
        &self.best
    }

    /// A generation, unless its steps would be too small to tell.
    fn has_another(&mut self, cost: impl Fn(&DVector<f64>) -> f64 + Sync) -> bool {
        let n = self.mean.len();
        let eigen = self.covariance.clone().symmetric_eigen();
        let scales = eigen.eigenvalues.map(|value: f64| value.max(1e-20).sqrt());
        if self.sigma * scales.max() < self.effort.until {
            return false;
        }
        let root = &eigen.eigenvectors * DMatrix::from_diagonal(&scales);
        let ways: Vec<_> = (0..self.effort.children)
            .map(|_| &root * DVector::from_fn(n, |_, _| self.normal.next()))
            .collect();
        let children = of_all(&ways, cores(), |way| {
            let point = &self.mean + self.sigma * way;
            (cost(&point), point)
        });
        let mut all: Vec<_> = (children.into_iter().zip(&ways))
            .map(|((cost, point), way)| (cost, way, point))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        if all[0].0 < self.best.1 {
            self.best = (all[0].2.clone(), all[0].0);
        }
        let parents: Vec<_> = (all.iter().map(|(_, way, _)| *way))
            .zip(self.rates.weights.iter().copied())
            .collect();
        let way: DVector<f64> =
            (parents.iter()).fold(DVector::zeros(n), |sum, &(way, weight)| sum + way * weight);
        let whitened =
            &eigen.eigenvectors * (eigen.eigenvectors.tr_mul(&way)).component_div(&scales);
        let mut many = DMatrix::zeros(n, n);
        for (way, weight) in parents {
            many += way * way.transpose() * weight;
        }
        self.learn(&way, &whitened, &many);
        true
    }

    /// From the way to the next mean, the same in steps of size 1, and the covariance of the parents.
    fn learn(&mut self, way: &DVector<f64>, whitened: &DVector<f64>, many: &DMatrix<f64>) {
        let n = self.mean.len() as f64;
        let rates = &self.rates;
        let of_path = |rate: f64| (rate * (2.0 - rate) * rates.effective).sqrt();
        self.mean += self.sigma * way;
        self.generation += 1;
        self.step_path = &self.step_path * (1.0 - rates.path) + whitened * of_path(rates.path);
        let length: f64 = self.step_path.norm();
        let settled = (1.0 - (1.0 - rates.path).powi(2 * self.generation)).sqrt();
        let goes_on = length / settled < (1.4 + 2.0 / (n + 1.0)) * rates.expected;
        self.shape_path *= 1.0 - rates.shape;
        let mut kept = 1.0 - rates.one - rates.many;
        if goes_on {
            self.shape_path += way * of_path(rates.shape);
        } else {
            kept += rates.one * rates.shape * (2.0 - rates.shape);
        }
        self.covariance = &self.covariance * kept
            + &self.shape_path * self.shape_path.transpose() * rates.one
            + many * rates.many;
        self.sigma *= (rates.path / rates.damping * (length / rates.expected - 1.0))
            .min(1.0)
            .exp();
    }
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
            until: 1e-9,
        };
        let mut search = Evolution::new(&DVector::from_element(4, -0.5), effort);
        search.go_on(100, cost);
        let half = search.best().1;
        search.go_on(150, cost);
        let (at, least) = search.best().clone();
        assert!(least < 1e-3 * half, "{least} {half}");
        assert!(
            least < 1e-9 && (at - DVector::from_element(4, 1.0)).norm() < 1e-3,
            "{least}"
        );
    }
}
