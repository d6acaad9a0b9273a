//! The fastest speed along a line under the limits of the line and of the pivots, jerk aside.
//!
//! In `z = s'^2` acceleration is a slope, `s'' = dz/ds / 2`, and a pivot's limits are straight: `phi_i'^2 z` at most
//! the square of its rate, and `|phi_i' s'' + phi_i'' z|` at most its acceleration. Backwards from rest at the end
//! every place gets the largest z from which the rest of the line can still be kept; forwards from rest at the start z
//! then grows as fast as it may (time-optimal path parametrisation; Pham and Pham 2018, "A new approach to time-optimal
//! path parameterization based on reachability analysis").

use super::pivot_demand::{DemandGrid, GridPoint};
use heapless::Vec;
use number::float::FloatMinMax;

/// Most intervals and one.
pub(super) const GRID_POINTS: usize = 65;

/// z at every place.
pub(super) type SquaredSpeeds = [f32; GRID_POINTS];

/// A line that bounds s'' over z: `offset + slope z`.
#[derive(Clone, Copy)]
struct LinearBound {
    offset: f32,
    slope: f32,
}

impl LinearBound {
    fn at(&self, z: f32) -> f32 {
        self.offset + self.slope * z
    }
}

/// What is no demand on a pivot, to divide by.
const STILL: f32 = 1e-15;

/// Writes the fastest; see the module.
pub(super) fn velocity_limit_squared(grid: &DemandGrid, z: &mut SquaredSpeeds) {
    let n = grid.intervals();
    let half = 0.5 * n as f32;
    // A slope of z over an interval is this many times an acceleration.
    let double = 2.0 / n as f32;
    // Of the places at which the pivots' limits are active, the last first.
    let mut nodes: Vec<Node, GRID_POINTS> = Vec::new();
    let steepest = double * grid.limits.acceleration;
    let mut next = 0.0;
    for (place, z) in grid.points().iter().zip(z.iter_mut()).take(n).rev() {
        let most = 1.0 / (place.rate * place.rate);
        next = if place.pivot_limits_inactive {
            most.fmin(next + steepest)
        } else {
            let node = Node::new(place, grid.limits.acceleration);
            // There is room for all.
            let _ = nodes.push(node);
            node.largest(most, next, half)
        };
        *z = next;
    }
    let mut now = 0.0;
    z[0] = now;
    for (place, z) in grid.points().iter().zip(z.iter_mut().skip(1)).take(n) {
        let up = if place.pivot_limits_inactive {
            steepest
        } else {
            (nodes.pop()).map_or(0.0, |node| double * node.highest(now))
        };
        now = z.fmin((now + up).fmax(0.0));
        *z = now;
    }
}

/// The bounds of a place.
#[derive(Clone, Copy)]
struct Node {
    acceleration: f32,
    /// Of the pivots' bounds.
    widths: [f32; 3],
    slopes: [f32; 3],
}

impl Node {
    fn new(place: &GridPoint, acceleration: f32) -> Self {
        let widths = each!(i => 1.0 / place.first[i].abs().fmax(STILL));
        let slope = |first: f32, second: f32| if first < 0.0 { second } else { -second };
        Self {
            acceleration,
            widths,
            slopes: each!(i => slope(place.first[i], place.second[i]) * widths[i]),
        }
    }

    /// The largest acceleration at z.
    fn highest(&self, z: f32) -> f32 {
        let [a, b, c] = each!(i => self.widths[i] + self.slopes[i] * z);
        self.acceleration.fmin(a).fmin(b).fmin(c)
    }

    /// The upper bound that counts at z, or the lower one, with a `sign` of -1.
    fn bound(&self, z: f32, sign: f32) -> LinearBound {
        let mut best = LinearBound {
            offset: sign * self.acceleration,
            slope: 0.0,
        };
        let mut value = self.acceleration;
        for (width, slope) in self.widths.iter().zip(&self.slopes) {
            let other = width + slope * z * sign;
            if other < value {
                value = other;
                best = LinearBound {
                    offset: sign * width,
                    slope: *slope,
                };
            }
        }
        best
    }

    /// The largest z up to `most` from which the next place's `next` is not exceeded: the last z at which the lowest
    /// upper bound is not below the highest lower one. Newton's method from above: exact after as many rounds as there
    /// are lines on the way.
    fn largest(&self, most: f32, next: f32, half: f32) -> f32 {
        let onwards = LinearBound {
            offset: next * half,
            slope: -half,
        };
        let mut z = most;
        // It ends, since z only falls; a count of rounds would be written out six times over.
        loop {
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
