//! The fastest speed along a line under the limits of the line and of the pivots, jerk aside.
//!
//! In `z = s'^2` acceleration is a slope, `s'' = dz/ds / 2`, and a pivot's limits are straight: `phi_i'^2 z` at most the
//! square of its rate, and `|phi_i' s'' + phi_i'' z|` at most its acceleration. Backwards from rest at the end every place
//! gets the largest z from which the rest of the line can still be kept; forwards from rest at the start z then grows as fast
//! as it may (time-optimal path parametrisation; Pham and Pham 2018, "A new approach to time-optimal path parameterization
//! based on reachability analysis").

use super::float::Order;
use super::grid::Grid;
use super::path::Demand;

/// Most stretches and one.
pub(super) const PLACES: usize = 65;

/// z at every place.
pub(super) type Squares = [f32; PLACES];

/// A line that bounds s'' over z: `offset + slope z`.
#[derive(Clone, Copy)]
struct Bound {
    offset: f32,
    slope: f32,
}

impl Bound {
    fn at(&self, z: f32) -> f32 {
        self.offset + self.slope * z
    }
}

/// Rounds in which the largest z of a place is found: it is a corner of a few straight lines.
const ROUNDS: usize = 6;
/// What is no rate of a pivot, to divide by.
const STILL: f32 = 1e-12;

/// See the module.
pub(super) fn fastest(grid: &Grid) -> Squares {
    let n = grid.stretches();
    // A slope of z over a stretch is this many times an acceleration.
    let double = 2.0 / n as f32;
    let mut z = [0.0; PLACES];
    let mut nodes = [Node::NONE; PLACES];
    for k in (0..n).rev() {
        nodes[k] = Node::new(grid, k);
        z[k] = nodes[k].largest(z[k + 1], double);
    }
    z[0] = 0.0;
    for k in 0..n {
        let node = &nodes[k];
        let up = node.highest(z[k]).at(z[k]);
        z[k + 1] = z[k + 1].smaller((z[k] + double * up).larger(0.0));
    }
    z
}

/// The bounds of a place.
#[derive(Clone, Copy)]
struct Node {
    most: f32,
    acceleration: f32,
    /// Half-widths and slopes of the pivots' bounds.
    widths: [f32; 3],
    slopes: [f32; 3],
}

impl Node {
    const NONE: Self = Self {
        most: 0.0,
        acceleration: 0.0,
        widths: [0.0; 3],
        slopes: [0.0; 3],
    };

    fn new(grid: &Grid, place: usize) -> Self {
        let Demand { first, second } = grid.at(place);
        let mut rate = 0.0_f32;
        let mut widths = [0.0; 3];
        let mut slopes = [0.0; 3];
        for i in 0..3 {
            let size = first[i].abs();
            rate = rate.larger(size);
            let over = 1.0 / size.larger(STILL);
            widths[i] = grid.pivot_acceleration * over;
            slopes[i] = if first[i] < 0.0 {
                second[i] * over
            } else {
                -second[i] * over
            };
        }
        let speed = grid
            .limits
            .rate
            .smaller(grid.pivot_rate / rate.larger(STILL));
        Self {
            most: speed * speed,
            acceleration: grid.limits.acceleration,
            widths,
            slopes,
        }
    }

    /// The upper bound that counts at z.
    fn highest(&self, z: f32) -> Bound {
        self.bound(z, 1.0)
    }

    fn bound(&self, z: f32, sign: f32) -> Bound {
        let mut best = Bound {
            offset: sign * self.acceleration,
            slope: 0.0,
        };
        let mut value = best.at(z) * sign;
        for (width, slope) in self.widths.iter().zip(&self.slopes) {
            let bound = Bound {
                offset: sign * width,
                slope: *slope,
            };
            let other = bound.at(z) * sign;
            if other < value {
                (best, value) = (bound, other);
            }
        }
        best
    }

    /// The largest z from which the next place's `next` is not exceeded: the last z at which the lowest upper bound is not
    /// below the highest lower one. Newton's method from above: exact after as many rounds as there are lines on the way.
    fn largest(&self, next: f32, double: f32) -> f32 {
        let onwards = Bound {
            offset: next / double,
            slope: -1.0 / double,
        };
        let mut z = self.most;
        for _ in 0..ROUNDS {
            let low = self.bound(z, -1.0);
            let own = self.bound(z, 1.0);
            let high = if onwards.at(z) < own.at(z) {
                onwards
            } else {
                own
            };
            if low.at(z) <= high.at(z) {
                break;
            }
            let meeting = (high.offset - low.offset) / (low.slope - high.slope);
            // Parallel within rounding.
            if !(meeting >= 0.0 && meeting < z) {
                break;
            }
            z = meeting;
        }
        z
    }
}
