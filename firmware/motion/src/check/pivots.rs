//! What the platform asks of the pivots, in single precision: at an instant, from where its centre is and how it moves; and at
//! worst, at any orientation, which also serves motions without an end, that cannot be checked piece by piece.
//!
//! At an instant, all along the platform's own axes, where the moved point `p` and the guides stand still: `C = P - p`,
//! `C' = P' - theta' E p`, `C'' = P'' - theta'' E p + theta'^2 p`, with E the quarter turn. Track radii, radians and
//! seconds. Single precision is off by less than 1e-7 track radii (10 nm): enough to hold a motion against its limits,
//! not to make one.
//!
//! At worst, with the platform's centre `r` from the track's (`k = 1 / sqrt(1 - r^2)`, lengths in track radii,
//! a point moved that lies `p` from the platform's centre, so that `|C'| <= |P'| + |theta'| p`):
//!
//! ```text
//! |phi'|  <= k |C'| + |theta'| (1 + r)
//! |phi''| <= k (|C''| + 2 |theta'| |C'| + theta'^2 r + (k |C'| + |theta'| r)^2 r) + |theta''| (1 + r)
//! ```
//!
//! The first is attained; the second sums worst cases that do not meet, and is up to half too large.

use crate::constraints::{Constraints, Speeds};
use crate::plan::cubic_segment::{CubicSegment, MotionState};
use kinematics::{Acceleration, Twist, guides_along_axes, pivot_motion_in_platform_axes};
use number::float::hypot;
use number::sqrt_f32;

/// The platform at an instant, along its own axes.
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

    /// The greatest rate and the greatest acceleration of a pivot.
    pub fn most(&self) -> [f32; 2] {
        self.pivots().map(|values| greatest(&values))
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
fn greatest(values: &[f32; 3]) -> f32 {
    let mut greatest = 0.0_f32;
    for value in values {
        let size = value.abs();
        if !(size <= greatest) {
            greatest = size;
        }
    }
    greatest
}

/// The bounds of the module's head, for a platform's centre within a radius.
#[derive(Clone, Copy, Debug)]
pub struct PivotGain {
    /// The radius, track radii.
    pub radius: f32,
    /// How much faster than the platform a pivot is at most.
    pub k: f32,
    /// How far the point whose speeds are told lies from the platform's centre.
    arm: f32,
}

impl PivotGain {
    /// For a radius inside the track.
    pub fn new(radius: f32, arm: f32) -> Self {
        let k = 1.0 / sqrt_f32((1.0 - radius) * (1.0 + radius));
        Self { radius, k, arm }
    }

    /// Rate of a pivot when the point moves at `speeds`; what its acceleration adds to that of a pivot, likewise.
    pub fn rate(&self, speeds: Speeds) -> f32 {
        self.k * (speeds.linear + speeds.angular * self.arm) + speeds.angular * (1.0 + self.radius)
    }

    /// Acceleration of a pivot when the point moves at `speeds` and is not accelerated.
    pub fn bias_acceleration(&self, speeds: Speeds) -> f32 {
        let Self { radius, k, arm } = *self;
        let turn = speeds.angular;
        let linear = speeds.linear + turn * arm;
        let relative_rate = k * linear + turn * radius;
        // Turning alone accelerates the centre towards the point.
        k * (turn * (2.0 * linear + turn * (radius + arm)) + relative_rate * relative_rate * radius)
    }
}

/// The pivots' limits, and how far the moved point lies from the platform's centre.
pub struct PivotBound {
    rate: f32,
    acceleration: f32,
    /// How far the moved point lies from the platform's centre, track radii.
    pub arm: f32,
}

impl PivotBound {
    /// Of what plans keep to.
    pub fn new(constraints: &Constraints) -> Self {
        let [x, y] = constraints.centre();
        Self {
            rate: constraints.limits.pivot_rate_rad_s as f32,
            acceleration: constraints.limits.pivot_acceleration_rad_s2 as f32,
            arm: hypot(x, y),
        }
    }

    /// The part of an acceleration that the pivots can follow when the platform moves at `speeds` within `radius`.
    #[inline(never)]
    pub fn part_within(&self, radius: f32, speeds: Speeds, acceleration: Speeds) -> f32 {
        let gain = PivotGain::new(radius, self.arm);
        (self.acceleration - gain.bias_acceleration(speeds)) / gain.rate(acceleration)
    }

    /// How far from the track's centre, up to `most`, the pivots can follow `speeds` with half of their acceleration to
    /// spare; `None` where they can nowhere.
    pub fn max_radius(&self, speeds: Speeds, most: f32) -> Option<f32> {
        let follows = |radius: f32| {
            let gain = PivotGain::new(radius, self.arm);
            gain.rate(speeds) <= self.rate
                && gain.bias_acceleration(speeds) <= self.acceleration / 2.0
        };
        if follows(most) {
            return Some(most);
        }
        let (mut low, mut high) = (0.0, most);
        if !follows(low) {
            return None;
        }
        // To a millionth of a track radius.
        for _ in 0..20 {
            let middle = (low + high) / 2.0;
            if follows(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }
}

#[cfg(test)]
mod tests {
    use crate::check::pivots::*;
    use kinematics::{Acceleration, Pose, Twist, inverse, pivot_motion};
    use number::random::Random;
    use std::f64::consts::TAU;

    /// States all over the disk of 0.8, about points up to 0.8 from the platform's centre: what the bounds say, and
    /// what the worst of the pivots does.
    #[test]
    fn no_pivot_is_asked_for_more_than_the_bounds_say() {
        let mut random = Random::new(1);
        let mut next = move || random.within_one();
        let (mut rates, mut largest) = (0.0_f64, 0.0_f64);
        for round in 0..40_000 {
            let arm = if round % 2 == 0 {
                0.0
            } else {
                next().abs() * 0.8
            };
            let (r, direction, theta) = (next().abs() * 0.8, next() * TAU, next() * TAU);
            let (v, turn) = ([next() * 2.0, next() * 2.0], next() * 6.0);
            let (a, turn_acceleration) = ([next() * 40.0, next() * 40.0], next() * 120.0);
            let to_point = next() * TAU;
            let (e, n) = (arm * to_point.cos(), arm * to_point.sin());
            let pose = Pose {
                x: r * direction.cos(),
                y: r * direction.sin(),
                theta,
            };
            let twist = Twist {
                x: v[0] + turn * n,
                y: v[1] - turn * e,
                theta: turn,
            };
            let acceleration = Acceleration {
                x: a[0] + turn_acceleration * n + turn * turn * e,
                y: a[1] - turn_acceleration * e + turn * turn * n,
                theta: turn_acceleration,
            };
            let guides = inverse(&pose).expect("inside").guides;
            let exact = pivot_motion(&guides, &twist, &acceleration);
            let worst = |all: [f64; 3]| all.iter().fold(0.0_f64, |worst, x| worst.max(x.abs()));
            let speeds = |v: [f64; 2], turn: f64| Speeds {
                linear: v[0].hypot(v[1]) as f32,
                angular: turn.abs() as f32,
            };
            let (speeds, accelerations) = (speeds(v, turn), speeds(a, turn_acceleration));
            let gain = PivotGain::new(r as f32, arm as f32);
            let rate = f64::from(gain.rate(speeds));
            let asked = f64::from(gain.rate(accelerations) + gain.bias_acceleration(speeds));
            rates = rates.max(worst(exact.rates) / rate);
            largest = largest.max(worst(exact.accelerations) / asked);
        }
        println!("largest share of the bounds: rate {rates:.3}, acceleration {largest:.3}");
        assert!((0.95..=1.000_01).contains(&rates), "{rates}");
        assert!((0.8..=1.000_01).contains(&largest), "{largest}");
    }

    /// Without an acceleration of its own the platform asks for some.
    #[test]
    fn a_steady_motion_leaves_less_room() {
        let speeds = Speeds {
            linear: 0.0,
            angular: 5.0,
        };
        assert_eq!(PivotGain::new(0.0, 0.0).bias_acceleration(speeds), 0.0);
        // Half a radius out, guide across: theta'^2 d / c.
        let least = 25.0 * 0.5 / 0.75_f32.sqrt();
        assert!(PivotGain::new(0.5, 0.0).bias_acceleration(speeds) >= least);
    }
}
