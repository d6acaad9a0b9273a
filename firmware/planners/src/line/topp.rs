//! The fastest speed along a line under the limits of the line and of the pivots, jerk aside.
//!
//! In `z = s'^2` acceleration is a slope, `s'' = dz/ds / 2`, and a pivot's limits are straight: `phi_i'^2 z` at most
//! the square of its rate, and `|phi_i' s'' + phi_i'' z|` at most its acceleration. Backwards from rest at the end
//! every place gets the largest z from which the rest of the line can still be kept; forwards from rest at the start z
//! then grows as fast as it may (time-optimal path parametrisation; Pham and Pham 2018, "A new approach to time-optimal
//! path parameterization based on reachability analysis").
//!
//! # As segments
//!
//! The fastest speed along a line becomes a few segments of constant acceleration.
//!
//! In z = s'^2 over s a constant acceleration is a straight line. Where the fastest motion accelerates as it may, z is
//! one already; where it follows the pivots, z is a curve. One pass lays straight lines under it, each as long as it
//! stays between z and a share of z: from where the line before ended, the range of slopes that do narrows from place
//! to place, and the line ends where none is left. A share that leaves too many lines is lowered.

use super::pivot_demand::{DemandGrid, GridPoint};
use heapless::Vec;
use motion::constraints::PathLimits;
use motion::tolerances::SAME_SLOPE;
use number::float::FloatMinMax;
use number::sqrt_f32;

/// Most intervals and one.
pub(super) const GRID_POINTS: usize = 65;

/// z at every place.
pub(super) type SquaredSpeeds = [f32; GRID_POINTS];

/// A line that bounds s'' over z: its offset and its slope.
#[derive(Clone, Copy)]
struct LinearBound(f32, f32);

impl LinearBound {
    fn at(&self, z: f32) -> f32 {
        self.0 + self.1 * z
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
    for (place, z) in grid.places.iter().zip(z.iter_mut()).take(n).rev() {
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
    for (place, z) in grid.places.iter().zip(z.iter_mut().skip(1)).take(n) {
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
        let mut best = LinearBound(sign * self.acceleration, 0.0);
        for (width, slope) in self.widths.iter().zip(&self.slopes) {
            let other = LinearBound(sign * width, *slope);
            if sign * other.at(z) < sign * best.at(z) {
                best = other;
            }
        }
        best
    }

    /// The largest z up to `most` from which the next place's `next` is not exceeded: the last z at which the lowest
    /// upper bound is not below the highest lower one. Newton's method from above: exact after as many rounds as there
    /// are lines on the way.
    fn largest(&self, most: f32, next: f32, half: f32) -> f32 {
        let onwards = LinearBound(next * half, -half);
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
            let meeting = (high.0 - low.0) / (low.1 - high.1);
            // Parallel within rounding.
            if !(meeting >= 0.0 && meeting < z) {
                break;
            }
            z = meeting;
        }
        z
    }
}

/// Most segments: each corner takes two pieces of a plan.
pub(super) const MAX_SEGMENTS: usize = 12;

/// A corner: where, and the speed there (per second).
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub s: f32,
    pub rate: f32,
}

/// Corners of a motion from rest to rest.
pub(super) type Corners = Vec<Corner, { MAX_SEGMENTS + 1 }>;

/// The share of z that is given away, the least and the most.
const LEAST: f32 = 0.01;
const MOST: f32 = 0.3;
/// What was too little grows by this factor and this much more at least.
const STEP: f32 = 1.35;
const STEP_MORE: f32 = 0.015;

/// Writes the corners of segments under `z`, of which there are `intervals` and one, whose slopes stand for
/// accelerations up to `acceleration`. `None` where it takes too many segments.
pub(super) fn fit_segments_below(
    z: &SquaredSpeeds,
    intervals: usize,
    acceleration: f32,
    corners: &mut Corners,
) -> Option<()> {
    let z = z.get(..=intervals)?;
    let mut loss = LEAST;
    while let Err(place) = lay_segments(z, acceleration, 1.0 - loss, corners) {
        if loss >= MOST {
            return None;
        }
        // What makes the segments of a curve as much longer as they would have to be, and a step at least.
        let longer = intervals as f32 / place as f32;
        loss = (loss * (longer * longer))
            .fmax(STEP * loss + STEP_MORE)
            .fmin(MOST);
    }
    Some(())
}

/// Takes out the corners that stand so close that their ramps would meet and ask for too much jerk together. Only
/// corners at which the acceleration falls: without them the speed is lower.
pub(super) fn remove_close_corners(corners: &mut Corners, limits: &PathLimits) {
    let mut k = 1;
    while k + 2 < corners.len() {
        // How long a segment lasts, and its acceleration.
        let segment = |k: usize| {
            let (from, to) = (&corners[k], &corners[k + 1]);
            let seconds = 2.0 * (to.s - from.s) / (from.rate + to.rate);
            (seconds, (to.rate - from.rate) / seconds)
        };
        let ((_, before), (seconds, here), (_, after)) =
            (segment(k - 1), segment(k), segment(k + 1));
        let (first, second) = (before - here, here - after);
        let ramps = (first + second) / (2.0 * limits.jerk);
        if first > 0.0 && second > 0.0 && seconds < ramps {
            // The one that stands out less.
            corners.remove(if first < second { k } else { k + 1 });
            k = k.saturating_sub(1).max(1);
        } else {
            k += 1;
        }
    }
}

/// One pass, written; an error is the place up to which the segments suffice.
#[inline(never)]
fn lay_segments(
    z: &[f32],
    acceleration: f32,
    share: f32,
    corners: &mut Corners,
) -> Result<(), usize> {
    let last = z.len() - 1;
    let spacing = 1.0 / last as f32;
    let steepest = 2.0 * acceleration * spacing;
    corners.clear();
    let (mut from, mut start) = (0, 0.0);
    // There is room for one more than there are segments.
    let _ = corners.push(Corner { s: 0.0, rate: 0.0 });
    while from < last {
        let (mut low, mut high) = (-steepest, steepest);
        let mut to = from + 1;
        // The first segment is taken in any case: at its end a line can be as low as it likes.
        high = high.fmin(z[to] - start);
        low = low.fmax(z[to] * share - start).fmin(high);
        while to < last {
            let steps = (to + 1 - from) as f32;
            let over = 1.0 / steps;
            let highest = high.fmin((z[to + 1] - start) * over);
            let lowest = low.fmax((z[to + 1] * share - start) * over);
            if lowest > highest + steepest * SAME_SLOPE {
                break;
            }
            (low, high) = (lowest.fmin(highest), highest);
            to += 1;
        }
        start = (start + high * (to - from) as f32).fmax(0.0);
        from = to;
        let (s, rate) = (from as f32 * spacing, sqrt_f32(start));
        corners.push(Corner { s, rate }).map_err(|_| from)?;
    }
    // At the end z is 0, and so is the speed but for roundings.
    if let Some(corner) = corners.last_mut() {
        corner.rate = 0.0;
    }
    Ok(())
}
