//! The carriages' bumpers: stiff one-sided springs with dampers between neighbours on the track.
//!
//! Neighbouring carriages first touch with the centre 88.5 mm out, where at most orientations a guide has reached its end already:
//! only a stage that runs on without control gets there.

use core::f64::consts::TAU;
use nalgebra::Vector3;

use super::parameters::PlantParameters;
use super::pivot_geometry::AXES;

/// Angle between two neighbours at which their carriages touch: 20 deg.
pub const CARRIAGE_RAD: f64 = 20.0 / 360.0 * TAU;

/// Precomputed constants of the bumpers: as hard as the guides' ends, at the track's radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bumpers {
    stiffness_n_m_rad: f64,
    damping_n_m_s_rad: f64,
}

impl Bumpers {
    pub fn new(parameters: &PlantParameters) -> Self {
        let square_m2 = parameters.track_radius_m * parameters.track_radius_m;
        Self {
            stiffness_n_m_rad: parameters.stop_stiffness_n_m * square_m2,
            damping_n_m_s_rad: parameters.stop_damping_n_s_m * square_m2,
        }
    }

    /// Torques on the rings, N m.
    pub fn torques_n_m(&self, ring_rad: &Vector3<f64>, ring_rad_s: &Vector3<f64>) -> Vector3<f64> {
        let mut torques_n_m = Vector3::zeros();
        for i in 0..AXES {
            let pressed_rad = pressed_rad(ring_rad, i);
            if pressed_rad > 0.0 {
                let next = (i + 1) % AXES;
                let opening_rad_s = ring_rad_s[next] - ring_rad_s[i];
                // A bumper never pulls, whatever its damper wants.
                let push_n_m = (self.stiffness_n_m_rad * pressed_rad
                    - self.damping_n_m_s_rad * opening_rad_s)
                    .max(0.0);
                torques_n_m[next] += push_n_m;
                torques_n_m[i] -= push_n_m;
            }
        }
        torques_n_m
    }

    /// Energy stored in the bumpers, J.
    pub fn energy_j(&self, ring_rad: &Vector3<f64>) -> f64 {
        (0..AXES)
            .map(|i| 0.5 * self.stiffness_n_m_rad * pressed_rad(ring_rad, i).powi(2))
            .sum()
    }
}

/// How far the bumpers between carriage `i` and the next are pressed in, rad: 0 where they do not touch.
pub(super) fn pressed_rad(ring_rad: &Vector3<f64>, i: usize) -> f64 {
    let turns = (ring_rad[(i + 1) % AXES] - ring_rad[i]) * (1.0 / TAU);
    (CARRIAGE_RAD - (turns - turns.floor()) * TAU).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_push_each_other_apart_and_never_pull() {
        let bumpers = Bumpers::new(&PlantParameters::REFERENCE);
        let apart = Vector3::new(0.0, 2.1, 4.2);
        let still = Vector3::zeros();
        assert_eq!(bumpers.torques_n_m(&apart, &still), still);
        // The third and the first, a turn apart, 10 mrad closer than carriages are wide: 1e4 N m/rad.
        let close = Vector3::new(TAU + 1.0, 3.1, 1.0 - CARRIAGE_RAD + 0.01);
        let torques_n_m = bumpers.torques_n_m(&close, &still);
        assert!((torques_n_m - Vector3::new(100.0, 0.0, -100.0)).norm() < 1e-9);
        let leaving = Vector3::new(10.0, 0.0, -10.0);
        assert_eq!(bumpers.torques_n_m(&close, &leaving), still);
        assert!((bumpers.energy_j(&close) - 0.5).abs() < 1e-12);
    }
}
