//! Speed of translation and of rotation as one pair, and rates of the axes per second.

use super::plan::units::PER_AXIS_UNIT;
use number::float::{FloatMinMax, hypot, i64_to_f32_fast};

/// Speed of the moved point, track radii per second, and rate of rotation, rad per second; or their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Speeds {
    /// Of translation.
    pub linear: f32,
    /// Of rotation.
    pub angular: f32,
}

impl Speeds {
    /// Of a vector of x, y and theta.
    pub fn of(vector: &[f32; 3]) -> Self {
        Self {
            linear: hypot(vector[0], vector[1]),
            angular: vector[2].abs(),
        }
    }

    /// Both times a factor.
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            linear: self.linear * factor,
            angular: self.angular * factor,
        }
    }

    /// The greater of both parts.
    pub fn max(self, other: Self) -> Self {
        Self {
            linear: self.linear.fmax(other.linear),
            angular: self.angular.fmax(other.angular),
        }
    }
}

/// Rates of the axes (2^-72 units a tick, `hz` ticks a second) as track radii and rad per second.
pub fn per_second(rates: &[i64; 3], hz: f32) -> [f32; 3] {
    let unit = PER_AXIS_UNIT * hz;
    let [x, y, theta] = each!(i => i64_to_f32_fast(rates[i]) * unit);
    [x, y, theta * core::f32::consts::TAU]
}
