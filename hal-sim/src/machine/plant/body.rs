//! The rigid body on the guides: platform and payload, about the platform's centre.

use nalgebra::{Matrix3, Vector3};

use super::parameters::PlantParameters;

/// Mass, first moment and inertia of everything that moves with the platform.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    mass_kg: f64,
    /// Mass times centre, in the platform frame, kg m.
    first_moment_kg_m: [f64; 2],
    /// About the platform's centre.
    inertia_kg_m2: f64,
}

impl Body {
    /// Joins platform and payload.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let payload = &parameters.payload;
        let moment_kg_m = payload.mass_kg * payload.eccentricity_m;
        let (sin, cos) = <f64 as kinematics::Scalar>::sin_cos(payload.direction_rad);
        Self {
            mass_kg: parameters.platform_mass_kg + payload.mass_kg,
            first_moment_kg_m: [moment_kg_m * cos, moment_kg_m * sin],
            inertia_kg_m2: parameters.platform_inertia_kg_m2
                + payload.inertia_kg_m2
                + moment_kg_m * payload.eccentricity_m,
        }
    }

    /// First moment in the base frame, kg m, at the orientation with the given sine and cosine.
    #[must_use]
    pub fn first_moment(&self, sin: f64, cos: f64) -> [f64; 2] {
        let [x, y] = self.first_moment_kg_m;
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// Mass matrix for (x, y, theta), SI, given the first moment in the base frame.
    ///
    /// From `T = m |C'|^2 / 2 + theta' (s x C') + I theta'^2 / 2` with `s x C' = s_x y' - s_y x'`.
    #[must_use]
    pub fn mass_matrix(&self, [sx, sy]: [f64; 2]) -> Matrix3<f64> {
        let m = self.mass_kg;
        Matrix3::new(m, 0.0, -sy, 0.0, m, sx, -sy, sx, self.inertia_kg_m2)
    }

    /// Generalised forces that come from the body itself: centrifugal force of its first moment, and gravity.
    #[must_use]
    pub fn forces(&self, [sx, sy]: [f64; 2], spin_rad_s: f64, gravity: [f64; 2]) -> Vector3<f64> {
        let square = spin_rad_s * spin_rad_s;
        let [gx, gy] = gravity;
        Vector3::new(
            sx * square + self.mass_kg * gx,
            sy * square + self.mass_kg * gy,
            sx * gy - sy * gx,
        )
    }
}
