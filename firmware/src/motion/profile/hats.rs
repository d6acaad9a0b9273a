//! The broken line of an axis' acceleration as a sum of three hats: of the start's acceleration, of the peak, of the
//! brake.
//!
//! ```text
//!   a0 \   P  /------\                Area f: the speed that a hat of height 1 gains. Moment g about the end: the way.
//!       \    /        \               With c2 = g2 / f2, the brake's centroid before the end, the two equations of `fit`
//!        \  /          \              are solved by
//!  0 -----\/------------\------\---/-   P = (d - v (n - c2) - a0 (g0 - f0 c2)) / (g1 - f1 c2)
//!         n0    n1   n2   n3    \_/ Q   Q = -(v + a0 f0 + P f1) / f2
//! ```

use super::any_state::task::Task;
use super::shape::{Shape, Solution};
use crate::number::float::ticks_to_f32;

/// Areas, and what the way gains by the heights when the brake always ends at rest.
pub(super) struct Hats {
    area: [f32; 3],
    /// By the start's velocity and acceleration.
    by_start: [f32; 2],
    /// By the peak.
    pub gain: f32,
}

impl Hats {
    pub fn new(shape: &Shape) -> Self {
        const THIRD: f32 = 1.0 / 3.0;
        let n = shape.n.map(ticks_to_f32);
        let braking = n[4] + n[5] + n[6];
        let brake = (n[4] + n[6]) / 2.0 + n[5];
        let brake_moment = n[4] / 2.0 * (n[5] + n[6] + n[4] * THIRD)
            + n[5] * (n[6] + n[5] / 2.0)
            + n[6] * n[6] * THIRD;
        let centroid = brake_moment / brake;
        // From here on distances from the brake's centroid, not from the end.
        let far = braking - centroid;
        let rest = n[1] + n[2] + n[3] + far;
        let start = n[0] / 2.0;
        let (mut peak, mut gain) = (start, start * (rest + n[0] * THIRD));
        if shape.released_in_part {
            peak += n[4] / 2.0;
            gain += n[4] / 2.0 * (far - n[4] * THIRD);
        } else {
            peak += n[1] + n[2] / 2.0;
            gain += n[1] * (n[1] / 2.0 + n[2] + n[3] + far)
                + n[2] / 2.0 * (n[2] * (2.0 * THIRD) + n[3] + far);
        }
        Self {
            area: [start, peak, brake],
            by_start: [n[0] + rest, start * (rest + n[0] * (2.0 * THIRD))],
            gain,
        }
    }

    /// The heights that lead to rest at the target.
    pub fn solution(&self, task: &Task<f32>) -> Option<Solution> {
        let (d, v, a) = (task.distance, task.velocity, task.acceleration);
        let peak = (d - v * self.by_start[0] - a * self.by_start[1]) / self.gain;
        let top = v + a * self.area[0] + peak * self.area[1];
        let brake = -top / self.area[2];
        (peak.is_finite() && brake.is_finite()).then_some(Solution { peak, brake, top })
    }
}
