//! The ends of the guides: stiff one-sided springs with dampers on rho.
//!
//! The carriages' own bumpers are not modelled: neighbouring carriages (20 deg wide) first touch with the centre
//! 88.5 mm out, where at most orientations a guide has reached its end already.

use kinematics::Guide;
use nalgebra::Vector3;

use super::parameters::PlantParameters;

/// Precomputed constants of the end stops.
#[derive(Clone, Copy, Debug)]
pub struct EndStops {
    /// Range of rho, track radii.
    range: [f64; 2],
    radius_m: f64,
    stiffness_n_m: f64,
    damping_n_s_m: f64,
}

impl EndStops {
    /// Takes the constants.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let radius_m = parameters.track_radius_m;
        Self {
            range: parameters.guide_range_m.map(|rho_m| rho_m / radius_m),
            radius_m,
            stiffness_n_m: parameters.stop_stiffness_n_m,
            damping_n_s_m: parameters.stop_damping_n_s_m,
        }
    }

    /// Generalised force on (x, y, theta), SI, of the stop that guide `guide` presses; `None` while it is free.
    #[must_use]
    pub fn force(&self, guide: &Guide<f64>, twist: &Vector3<f64>) -> Option<Vector3<f64>> {
        let compression_m = self.compression(guide)?;
        let gradient = self.rho_gradient(guide);
        // The sign of the compression is that of the push; a stop never pulls, whatever the damper wants.
        let rate_m_s = gradient.dot(twist);
        let push_n = self.stiffness_n_m * compression_m - self.damping_n_s_m * rate_m_s;
        (push_n * compression_m > 0.0).then(|| push_n * gradient)
    }

    /// Energy stored in the stop of one guide, J.
    #[must_use]
    pub fn energy_j(&self, guide: &Guide<f64>) -> f64 {
        let compression_m = self.compression(guide).unwrap_or(0.0);
        0.5 * self.stiffness_n_m * compression_m * compression_m
    }

    /// How far the stop is pressed in, m: positive at the inner end (it pushes rho up), negative at the outer.
    #[inline]
    fn compression(&self, guide: &Guide<f64>) -> Option<f64> {
        let rho = guide.rho();
        let [inner, outer] = self.range;
        if rho < inner {
            Some((inner - rho) * self.radius_m)
        } else if rho > outer {
            Some((outer - rho) * self.radius_m)
        } else {
            None
        }
    }

    /// Derivative of rho (m) by x (m), y (m) and theta: from `rho = sqrt(1 - d^2) - q` and the derivatives
    /// `d: (-sin, cos, -q)` and `q: (cos, sin, d)`.
    fn rho_gradient(&self, guide: &Guide<f64>) -> Vector3<f64> {
        let slope = guide.offset / guide.cosine;
        Vector3::new(
            slope * guide.sin - guide.cos,
            -slope * guide.cos - guide.sin,
            -slope * guide.rho() * self.radius_m,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A guide along x with the pivot at this rho.
    fn guide(rho: f64) -> Guide<f64> {
        Guide {
            cos: 1.0,
            sin: 0.0,
            offset: 0.0,
            cosine: 1.0,
            projection: 1.0 - rho,
        }
    }

    #[test]
    fn stops_push_at_both_ends_and_never_pull() {
        let stops = EndStops::new(&PlantParameters::REFERENCE);
        let still = Vector3::zeros();
        assert_eq!(stops.force(&guide(1.0), &still), None);
        // 1 mm past the inner end the platform is pushed back along -x, past the outer one along x.
        let inner = stops.force(&guide(0.15), &still).map(|force| force.x);
        let outer = stops.force(&guide(1.85), &still).map(|force| force.x);
        assert!(
            inner.is_some_and(|x| (x + 1000.0).abs() < 1e-6),
            "{inner:?}"
        );
        assert!(
            outer.is_some_and(|x| (x - 1000.0).abs() < 1e-6),
            "{outer:?}"
        );
        let leaving = Vector3::new(-1.0, 0.0, 0.0);
        assert_eq!(stops.force(&guide(0.15), &leaving), None);
        assert_eq!(stops.force(&guide(1.85), &-leaving), None);
    }
}
