//! An interval of a plan: the state at its two ends, how large velocity, acceleration and jerk are in between, what the
//! pivots can make of them at most, and what may be broken in it.

use super::pivots::PivotGain;
use crate::constraints::Speeds;
use crate::plan::cubic_segment::{CubicSegment, MotionState};
use number::float::{FloatMinMax, hypot};

/// What a plan breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// The disk, with the platform's centre.
    Disk,
    /// The bounds of an axis.
    Bounds(usize),
    /// The limit of speed.
    Speed,
    /// That of acceleration.
    Acceleration,
    /// That of jerk.
    Jerk,
    /// The pivots' rate or acceleration.
    Pivots,
    /// Nothing that is known: too long a way to be looked at.
    TooLong,
}

/// One end of an interval.
#[derive(Clone, Copy, Default)]
pub struct IntervalEnd {
    pub sample: MotionState,
    /// Velocity of translation and of rotation.
    pub v: [f32; 2],
    /// Their acceleration.
    pub a: [f32; 2],
    /// Distance of the platform's centre from the track's.
    pub(super) centre_distance: f32,
    /// The greatest rate and acceleration of a pivot, once they have been asked for.
    pub(super) pivots: Option<[f32; 2]>,
}

impl IntervalEnd {
    pub(super) fn pivots(&mut self, segment: &CubicSegment, centre: [f32; 2]) -> [f32; 2] {
        *self
            .pivots
            .get_or_insert_with(|| segment.platform(&self.sample, centre).most())
    }
}

/// Of translation (track radii) and of rotation (rad), per second, squared and cubed.
#[derive(Clone, Copy, Debug)]
pub struct IntervalBounds {
    pub v: [f32; 2],
    pub a: [f32; 2],
    pub j: [f32; 2],
    /// Of translation alone: jerk is constant in an interval, but not that of a point which turns about the moved one.
    fourth: f32,
}

impl IntervalBounds {
    /// Over the `t` seconds from one state to the other, with jerks of these sizes.
    pub fn new(j: [f32; 2], from: &IntervalEnd, to: &IntervalEnd, t: f32) -> Self {
        let [x, y, theta] = each!(i => fastest(&from.sample, &to.sample, i, t));
        // By its ends too: the greatest speeds of x and y need not come together.
        let ends = from.v[0].fmax(to.v[0]);
        Self {
            v: [hypot(x, y).fmin(ends + j[0] * t * t / 8.0), theta],
            a: both!(i => from.a[i].fmax(to.a[i])),
            j,
            fourth: 0.0,
        }
    }

    /// Of a point as far as `arm` from the moved one.
    pub fn at_offset(&self, arm: f32) -> Self {
        if arm == 0.0 {
            return *self;
        }
        let ([v, turn], [a, angular_acceleration], [j, angular_jerk]) = (self.v, self.a, self.j);
        let [second, third, fourth] = self.turned();
        Self {
            v: [v + arm * turn, turn],
            a: [a + arm * second, angular_acceleration],
            j: [j + arm * third, angular_jerk],
            fourth: arm * fourth,
        }
    }

    /// The second to the fourth derivative of a unit vector that turns with theta, at most.
    fn turned(&self) -> [f32; 3] {
        let ([_, turn], [_, acceleration], [_, jerk]) = (self.v, self.a, self.j);
        let square = turn * turn;
        [
            acceleration + square,
            jerk + turn * (3.0 * acceleration + square),
            4.0 * turn * jerk
                + 3.0 * acceleration * (acceleration + 2.0 * square)
                + square * square,
        ]
    }

    /// Bounds of the pivots' rates and accelerations when these sizes are the platform centre's, at any orientation.
    pub fn pivot_bounds(&self, bound: &PivotGain) -> [f32; 2] {
        let [speeds, accelerations] =
            [self.v, self.a].map(|[linear, angular]| Speeds { linear, angular });
        [
            bound.rate(speeds),
            bound.rate(accelerations) + bound.bias_acceleration(speeds),
        ]
    }

    /// How far rate and acceleration of a pivot can rise between the ends of an interval of `t` seconds, when these sizes
    /// are the platform centre's.
    ///
    /// Seen from the platform, whose guides stand still, the centre moves with derivatives of at most `d1` to `d4`; a pivot
    /// is at the angle `theta + asin d` with `|d| <= r`, of which these are the third and the fourth derivative at most.
    pub fn pivot_rises(&self, bound: &PivotGain, t: f32) -> [f32; 2] {
        let PivotGain { radius: r, k, .. } = *bound;
        let ([v, turn], [a, _], [j, angular_jerk]) = (self.v, self.a, self.j);
        let [second, third, fourth] = self.turned();
        let d1 = v + turn * r;
        let d2 = a + 2.0 * turn * v + second * r;
        let d3 = j + 3.0 * (turn * a + second * v) + third * r;
        let d4 = self.fourth + 4.0 * (turn * j + third * v) + 6.0 * second * a + fourth * r;
        let (r2, k2) = (r * r, k * k);
        // Derivatives of asin, over k.
        let (f2, f3) = (k2 * r, k2 * k2 * (1.0 + 2.0 * r2));
        let f4 = k2 * k2 * k2 * r * (9.0 + 6.0 * r2);
        let bent = d1 * d1;
        let third = k * (d3 + 3.0 * f2 * d1 * d2 + f3 * bent * d1) + angular_jerk;
        let fourth = k
            * (d4 + f2 * (4.0 * d1 * d3 + 3.0 * d2 * d2) + 6.0 * f3 * bent * d2 + f4 * bent * bent);
        let eighth = t * t / 8.0;
        [third * eighth, fourth * eighth]
    }
}

/// Largest speed of an axis between two states of the same jerk.
fn fastest(from: &MotionState, to: &MotionState, i: usize, t: f32) -> f32 {
    let ends = from.v[i].abs().fmax(to.v[i].abs());
    let (a, b) = (from.a[i], to.a[i]);
    if a * b >= 0.0 {
        return ends;
    }
    // Acceleration passes zero after this part of the interval.
    let part = a / (a - b);
    ends.fmax((from.v[i] + a * part * t / 2.0).abs())
}
