//! The ends of the guides: stiff one-sided springs with dampers on rho.

use super::parameters::PlantParameters;

/// Precomputed constants of the end stops.
#[derive(Clone, Copy, Debug)]
pub struct EndStops {
    range_m: [f64; 2],
    stiffness_n_m: f64,
    damping_n_s_m: f64,
}

impl EndStops {
    /// Takes the constants.
    #[must_use]
    pub const fn new(parameters: &PlantParameters) -> Self {
        Self {
            range_m: parameters.guide_range_m,
            stiffness_n_m: parameters.stop_stiffness_n_m,
            damping_n_s_m: parameters.stop_damping_n_s_m,
        }
    }

    /// Force that pushes the pivot outwards along its guide, N, at a place and its rate.
    #[must_use]
    pub fn force_n(&self, rho_m: f64, rho_m_s: f64) -> f64 {
        let compression_m = self.compression_m(rho_m);
        if compression_m == 0.0 {
            return 0.0;
        }
        // The sign of the compression is that of the push; a stop never pulls, whatever the damper wants.
        let push_n = self.spring_n(compression_m, rho_m_s);
        if push_n * compression_m > 0.0 {
            push_n
        } else {
            0.0
        }
    }

    /// Force of spring and damper, N, that may pull too.
    #[must_use]
    pub const fn spring_n(&self, compression_m: f64, rho_m_s: f64) -> f64 {
        self.stiffness_n_m * compression_m - self.damping_n_s_m * rho_m_s
    }

    /// Energy stored in the stop of one guide, J.
    #[must_use]
    pub fn energy_j(&self, rho_m: f64) -> f64 {
        let compression_m = self.compression_m(rho_m);
        0.5 * self.stiffness_n_m * compression_m * compression_m
    }

    /// How far the stop is pressed in, m: positive at the inner end (it pushes rho up), negative at the outer.
    fn compression_m(&self, rho_m: f64) -> f64 {
        let [inner_m, outer_m] = self.range_m;
        rho_m.clamp(inner_m, outer_m) - rho_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_push_at_both_ends_and_never_pull() {
        let stops = EndStops::new(&PlantParameters::REFERENCE);
        assert_eq!(stops.force_n(0.1, 0.0), 0.0);
        // 1 mm past the inner end the pivot is pushed outwards, past the outer one inwards.
        let (inner_n, outer_n) = (stops.force_n(0.015, 0.0), stops.force_n(0.185, 0.0));
        assert!((inner_n - 1000.0).abs() < 1e-6, "{inner_n}");
        assert!((outer_n + 1000.0).abs() < 1e-6, "{outer_n}");
        assert_eq!(stops.force_n(0.015, 1.0), 0.0);
        assert_eq!(stops.force_n(0.185, -1.0), 0.0);
    }
}
