//! The platform at an instant, in single precision: where its centre is, how it moves, and what it asks of the pivots.
//!
//! All along the platform's own axes, where the moved point `p` and the guides stand still: `C = P - p`,
//! `C' = P' - theta' E p`, `C'' = P'' - theta'' E p + theta'^2 p`, with E the quarter turn. Track radii, radians and
//! seconds. Single precision is off by less than 1e-7 track radii (10 nm): enough to hold a motion against its limits,
//! not to make one.

use crate::plan::cubic_segment::{CubicSegment, MotionState};
use kinematics::{Acceleration, Twist, guides_along_axes, pivot_motion_in_platform_axes};
use number::float::hypot;
use number::sqrt_f32;

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Platform {
    x: f32,
    y: f32,
    twist: Twist<f32>,
    acceleration: Acceleration<f32>,
}

impl Platform {
    /// When the moved point, which lies at `centre` in the platform's axes, is at `point` with velocity `v` and
    /// acceleration `a`, all in the base frame, and theta has this sine and cosine.
    pub fn new(
        point: [f32; 2],
        (sin, cos): (f32, f32),
        v: [f32; 3],
        a: [f32; 3],
        centre: [f32; 2],
    ) -> Self {
        let turned = |x: f32, y: f32| (x * cos + y * sin, y * cos - x * sin);
        let [p, q] = centre;
        let (x, y) = turned(point[0], point[1]);
        let (v_x, v_y) = turned(v[0], v[1]);
        let (a_x, a_y) = turned(a[0], a[1]);
        let (turn, angular_acceleration) = (v[2], a[2]);
        let inward = turn * turn;
        Self {
            x: x - p,
            y: y - q,
            twist: Twist {
                x: v_x + turn * q,
                y: v_y - turn * p,
                theta: turn,
            },
            acceleration: Acceleration {
                x: a_x + angular_acceleration * q + inward * p,
                y: a_y - angular_acceleration * p + inward * q,
                theta: angular_acceleration,
            },
        }
    }

    /// Distance of the centre from the track's.
    pub fn radius(&self) -> f32 {
        hypot(self.x, self.y)
    }

    /// Rates (rad/s) and accelerations (rad/s^2) of the pivots; with a centre outside the track they are not numbers.
    pub fn pivots(&self) -> [[f32; 3]; 2] {
        let Some(guides) = guides_along_axes(self.x, self.y, sqrt_f32) else {
            return [[f32::NAN; 3]; 2];
        };
        let motion = pivot_motion_in_platform_axes(&guides, &self.twist, &self.acceleration);
        [motion.rates, motion.accelerations]
    }
}

impl CubicSegment {
    /// The platform there, when `centre` is the moved point in its axes.
    #[inline(never)]
    pub fn platform(&self, sample: &MotionState, centre: [f32; 2]) -> Platform {
        let direction = self.sin_cos(sample.displacement[2]);
        Platform::new(self.point(sample), direction, sample.v, sample.a, centre)
    }
}

/// The greatest size of three; what is not a number is over every limit.
pub fn greatest(values: &[f32; 3]) -> f32 {
    let mut greatest = 0.0_f32;
    for value in values {
        let size = value.abs();
        if !(size <= greatest) {
            greatest = size;
        }
    }
    greatest
}
