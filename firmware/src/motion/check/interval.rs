//! An interval of a plan: the state at its two ends, how large velocity, acceleration and jerk are in between, and what
//! the pivots can make of them at most.

use super::pivot_bounds::PivotGain;
use super::platform::greatest;
use crate::motion::plan::cubic_segment::{CubicSegment, MotionState};
use crate::motion::speeds::Speeds;
use crate::number::float::{FloatMinMax, hypot};

/// One end of an interval.
#[derive(Clone, Copy, Default)]
pub(crate) struct IntervalEnd {
    pub sample: MotionState,
    /// Velocity of translation and of rotation.
    pub v: [f32; 2],
    /// Their acceleration.
    pub a: [f32; 2],
    /// Distance of the moved point from the track's centre.
    pub point_distance: f32,
    /// Distance of the platform's centre from it.
    pub(super) centre_distance: f32,
    /// The greatest rate and acceleration of a pivot, once they have been asked for.
    pub(super) pivots: Option<[f32; 2]>,
}

impl IntervalEnd {
    pub(super) fn pivots(&mut self, segment: &CubicSegment, centre: [f32; 2]) -> [f32; 2] {
        *self.pivots.get_or_insert_with(|| {
            let pivots = segment.platform(&self.sample, centre).pivots();
            pivots.map(|three| greatest(&three))
        })
    }
}

/// Of translation (track radii) and of rotation (rad), per second, squared and cubed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IntervalBounds {
    pub v: [f32; 2],
    pub a: [f32; 2],
    pub j: [f32; 2],
}

impl IntervalBounds {
    /// Over the `t` seconds from one state to the other, with jerks of these sizes.
    pub fn new(j: [f32; 2], from: &IntervalEnd, to: &IntervalEnd, t: f32) -> Self {
        let [x, y, theta] = [0, 1, 2].map(|i| fastest(&from.sample, &to.sample, i, t));
        // By its ends too: the greatest speeds of x and y need not come together.
        let ends = from.v[0].fmax(to.v[0]);
        Self {
            v: [hypot(x, y).fmin(ends + j[0] * t * t / 8.0), theta],
            a: [0, 1].map(|i| from.a[i].fmax(to.a[i])),
            j,
        }
    }

    /// Of a point as far as `arm` from the moved one.
    pub fn at_offset(&self, arm: f32) -> Self {
        let ([v, turn], [a, angular_acceleration], [j, angular_jerk]) = (self.v, self.a, self.j);
        Self {
            v: [v + arm * turn, turn],
            a: [
                a + arm * (angular_acceleration + turn * turn),
                angular_acceleration,
            ],
            j: [
                j + arm * (angular_jerk + turn * (3.0 * angular_acceleration + turn * turn)),
                angular_jerk,
            ],
        }
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

    /// How far rate and acceleration of a pivot can rise between the ends of an interval, from the bounds of both: a
    /// pivot's third and fourth derivative are sums of products of the lower ones, times powers of `k`, which bounds
    /// how fast `1 / c` changes.
    pub fn pivot_rises(&self, [u, w]: [f32; 2], bound: &PivotGain, t: f32) -> [f32; 2] {
        let k = bound.k;
        let jerk = k * (self.j[0] + 2.0 * self.j[1]);
        let ku = k * u;
        let third = jerk + 3.0 * ku * w + ku * ku * u;
        let fourth = ku * (4.0 * jerk + 6.0 * ku * w + ku * ku * u) + 3.0 * k * w * w;
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
