//! How a pivot, its ring and its guide are built.

use serde::{Deserialize, Serialize};

/// Number of pivots, drives, encoders and guides.
pub const AXES: usize = 3;

/// How one pivot, its ring and its guide are built. All zero is the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PivotGeometry {
    /// Centre of the ring in the base frame, m.
    pub ring_centre_m: [f64; 2],
    /// Radius of the pivot less the track radius, m.
    pub radius_error_m: f64,
    /// Error of the guide's direction in the platform, rad.
    pub guide_error_rad: f64,
    /// Distance of the guide's line from the platform's centre, to its left, m.
    pub guide_offset_m: f64,
    /// Run-out of the pivot along its radius, m: cosine and sine of twice to six times the ring's angle.
    pub runout_m: [[f64; 2]; 5],
    /// Straightness of the guide, m: Legendre polynomials 2 to 9 of the place on it.
    pub straightness_m: [f64; 8],
}

impl PivotGeometry {
    /// As drawn.
    pub const IDEAL: Self = Self {
        ring_centre_m: [0.0; 2],
        radius_error_m: 0.0,
        guide_error_rad: 0.0,
        guide_offset_m: 0.0,
        runout_m: [[0.0; 2]; 5],
        straightness_m: [0.0; 8],
    };

    /// With every length times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            ring_centre_m: self.ring_centre_m.map(|m| m * factor),
            radius_error_m: self.radius_error_m * factor,
            guide_error_rad: self.guide_error_rad,
            guide_offset_m: self.guide_offset_m * factor,
            runout_m: self.runout_m.map(|pair| pair.map(|m| m * factor)),
            straightness_m: self.straightness_m.map(|m| m * factor),
        }
    }
}
