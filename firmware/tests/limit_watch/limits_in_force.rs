//! Limits that a script can change.

use super::quantities::Pair;
use crate::motion_bench::LIMITS;

/// Limits of speed in force.
#[derive(Clone, Copy, Debug)]
pub struct SpeedLimits {
    /// Of the path and of rotation.
    pub path: Pair,
    /// Of x, y and rotation (`VEL`), which streams and waves do not keep.
    pub axes: [f64; 3],
}

/// Limits of the pivots.
#[derive(Clone, Copy, Debug)]
pub struct PivotLimits {
    pub rate_rad_s: f64,
    pub acceleration_rad_s2: f64,
}

impl SpeedLimits {
    /// Those of the reference stage.
    pub const FULL: Self = Self {
        path: [LIMITS.speed_mm_s, LIMITS.turn_speed_deg_s],
        axes: [f64::INFINITY; 3],
    };

    /// The higher of both, one by one.
    pub fn max(&self, other: &Self) -> Self {
        Self {
            path: [0, 1].map(|i| self.path[i].max(other.path[i])),
            axes: [0, 1, 2].map(|i| self.axes[i].max(other.axes[i])),
        }
    }
}

impl PivotLimits {
    /// Those of the reference stage.
    pub const FULL: Self = Self {
        rate_rad_s: LIMITS.pivot_rate_rad_s,
        acceleration_rad_s2: LIMITS.pivot_acceleration_rad_s2,
    };
}
