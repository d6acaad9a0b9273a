//! A frame for a transition: one axis along the way to go, one across. Most of what the path is allowed can then go to the
//! first, and a target on the line under way is reached on that line.

use super::axis::{Axis, JERK_STEP};
use super::limits::Limits;
use super::plan::{Piece, Position};
use super::transition::{Pieces, target};
use kinematics::Geometry;

/// Direction of the axis along.
pub(super) struct Heading {
    cos: f64,
    sin: f64,
}

/// What is no motion across: 2^-31 track radii of way, 2^-44 track radii a tick of the velocity that rounding leaves.
const STILL_WAY: f64 = 2_199_023_255_552.0;
const STILL_RATE: f64 = 268_435_456.0;

impl Heading {
    /// Towards the target from about where a stop would end; all of what is under way counts when that is the target.
    pub fn new(state: &[Axis; 3], to: &Position, limits: &Limits, geometry: &Geometry) -> Self {
        let unit = geometry.radius_mm * libm::exp2(-72.0);
        let v = [0, 1].map(|i| state[i].velocity as f64 * unit * limits.rate_hz);
        let speed = libm::hypot(v[0], v[1]);
        let seconds = speed / (2.0 * limits.acceleration_mm_s2)
            + limits.acceleration_mm_s2 / (2.0 * limits.jerk_mm_s3);
        let way =
            [0, 1].map(|i| (target(to[i]) - state[i].position) as f64 * unit - v[i] * seconds);
        let length = libm::hypot(way[0], way[1]);
        if length > 0.0 {
            Self {
                cos: way[0] / length,
                sin: way[1] / length,
            }
        } else {
            Self { cos: 1.0, sin: 0.0 }
        }
    }

    /// A vector as seen along and across.
    fn seen(&self, x: f64, y: f64) -> [f64; 2] {
        [self.cos * x + self.sin * y, self.cos * y - self.sin * x]
    }

    /// The axes along, across and theta, with their ways to the target.
    pub fn view(&self, state: &[Axis; 3], to: &Position) -> [(Axis, i128); 3] {
        let [x, y, theta] = [0, 1, 2].map(|i| (state[i], target(to[i]) - state[i].position));
        let way = self.seen(x.1 as f64, y.1 as f64);
        let velocity = self.seen(x.0.velocity as f64, y.0.velocity as f64);
        let acceleration = self.seen(x.0.acceleration as f64, y.0.acceleration as f64);
        let axis = |i: usize| {
            let axis = Axis {
                position: 0,
                velocity: velocity[i] as i64,
                acceleration: acceleration[i] as i64,
            };
            (axis, way[i] as i128)
        };
        let still = way[1].abs() < STILL_WAY
            && velocity[1].abs() < STILL_RATE
            && acceleration[1].abs() < STILL_RATE;
        let across = if still { Default::default() } else { axis(1) };
        [axis(0), across, theta]
    }

    /// Turns the jerks back to x and y. Each takes up what the rounding of the one before left of the acceleration.
    pub fn turn_back(&self, pieces: &mut Pieces, state: &[Axis; 3]) {
        let mut axes = [state[0], state[1]];
        let mut exact = axes.map(|axis| axis.acceleration as f64);
        for Piece { ticks, jerk } in pieces {
            let [along, across] = [jerk[0] as f64, jerk[1] as f64];
            let turned = [
                self.cos * along - self.sin * across,
                self.sin * along + self.cos * across,
            ];
            let n = *ticks as f64;
            for i in 0..2 {
                exact[i] += turned[i] * n;
                let needed = (exact[i] - axes[i].acceleration as f64) / n;
                jerk[i] = libm::rint(needed / JERK_STEP as f64) as i64 * JERK_STEP;
                axes[i].acceleration += jerk[i] * *ticks as i64;
            }
        }
    }
}
