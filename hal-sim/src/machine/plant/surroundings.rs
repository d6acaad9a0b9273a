//! What changes slowly around the machine: the floor's shaking, and the warmth of the windings and of the track.

use core::f64::consts::TAU;
use kinematics::Scalar;

use super::parameters::{PlantParameters, TrackParameters, WindingParameters};
use super::pivot_geometry::AXES;

/// Frequencies of the floor, Hz, 2 to 20 as buildings have them, and phases in turns: those of y follow those of x.
const FLOOR_HZ: [f64; 5] = [2.3, 4.1, 7.9, 12.7, 18.9];
const FLOOR_TURNS: [[f64; 5]; 2] = [
    [0.11, 0.73, 0.38, 0.92, 0.57],
    [0.64, 0.29, 0.83, 0.05, 0.46],
];

/// Time and warmth, with what comes of them.
#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    /// Root mean square of the floor's acceleration along x and along y, m/s^2; 0 while it is still.
    floor_m_s2: f64,
    winding: Option<WindingParameters>,
    cold_ohm: f64,
    time_s: f64,
    /// Of the windings, over those at which their resistance was measured, K.
    warmer_k: [f64; AXES],
    track: Option<TrackParameters>,
    /// Of the track, over that at which its radius was measured, K.
    track_warmer_k: f64,
}

impl Surroundings {
    pub fn new(parameters: &PlantParameters) -> Self {
        let flags = parameters.imperfections;
        let winding = flags.winding_heat.then_some(parameters.winding);
        let track = flags.track_heat.then_some(parameters.track);
        Self {
            floor_m_s2: if flags.floor_vibration {
                parameters.floor_acceleration_m_s2
            } else {
                0.0
            },
            winding,
            cold_ohm: parameters.resistance_ohm,
            time_s: 0.0,
            warmer_k: [winding.map_or(0.0, |winding| winding.start_k); AXES],
            track,
            track_warmer_k: track.map_or(0.0, |track| track.start_k),
        }
    }

    /// Lets time go by with these currents.
    pub fn step(&mut self, step_s: f64, currents_a: [f64; AXES]) {
        self.time_s += step_s;
        if self.winding.is_none() && self.track.is_none() {
            return;
        }
        let resistance_ohm = self.resistance_ohm();
        let lost_w =
            [0, 1, 2].map(|axis| resistance_ohm[axis] * currents_a[axis] * currents_a[axis]);
        if let Some(winding) = self.winding {
            for (warmer_k, power_w) in self.warmer_k.iter_mut().zip(lost_w) {
                let settled_k = power_w * winding.thermal_resistance_k_w;
                *warmer_k += (settled_k - *warmer_k) * (step_s / winding.time_constant_s);
            }
        }
        if let Some(track) = self.track {
            let settled_k = lost_w.iter().sum::<f64>() * track.thermal_resistance_k_w;
            self.track_warmer_k +=
                (settled_k - self.track_warmer_k) * (step_s / track.time_constant_s);
        }
    }

    /// Resistances of the windings, ohm.
    pub fn resistance_ohm(&self) -> [f64; AXES] {
        let per_k = self.winding.map_or(0.0, |winding| winding.resistance_per_k);
        self.warmer_k
            .map(|warmer_k| self.cold_ohm * (1.0 + per_k * warmer_k))
    }

    /// How much warmer the windings are than where their resistance was measured, K.
    pub const fn warmer_k(&self) -> [f64; AXES] {
        self.warmer_k
    }

    /// How much warmer the track is than where its radius was measured, K; none where its warmth does nothing.
    pub fn track_warmer_k(&self) -> Option<f64> {
        self.track.map(|_| self.track_warmer_k)
    }

    /// What the machine feels of the floor in the plane, m/s^2: the floor's acceleration, the other way round.
    pub fn floor_m_s2(&self) -> [f64; 2] {
        if self.floor_m_s2 == 0.0 {
            return [0.0; 2];
        }
        // Each of so many sines with an equal part of the mean square.
        let peak_m_s2 = self.floor_m_s2 * (2.0 / FLOOR_HZ.len() as f64).sqrt();
        FLOOR_TURNS.map(|phases| {
            FLOOR_HZ
                .iter()
                .zip(phases)
                .map(|(hz, turns)| {
                    <f64 as Scalar>::sin_cos(TAU * (hz * self.time_s + turns)).0 * peak_m_s2
                })
                .sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::plant::Imperfections;

    fn unkind() -> PlantParameters {
        PlantParameters {
            imperfections: Imperfections::ALL,
            ..PlantParameters::REFERENCE
        }
    }

    #[test]
    fn a_floor_shakes_as_much_as_it_is_said_to() {
        let parameters = unkind();
        let mut surroundings = Surroundings::new(&parameters);
        let (mut squares, steps) = ([0.0; 2], 200_000);
        for _ in 0..steps {
            surroundings.step(1e-4, [0.0; AXES]);
            let floor = surroundings.floor_m_s2();
            squares = [0, 1].map(|i| squares[i] + floor[i] * floor[i] / f64::from(steps));
        }
        for square in squares {
            let share = square.sqrt() / parameters.floor_acceleration_m_s2;
            assert!((share - 1.0).abs() < 0.01, "{share}");
        }
    }

    #[test]
    fn a_winding_warms_by_its_losses_and_its_resistance_grows() {
        let mut surroundings = Surroundings::new(&unkind());
        let cold_ohm = PlantParameters::REFERENCE.resistance_ohm;
        assert!(
            surroundings
                .resistance_ohm()
                .iter()
                .all(|&ohm| ohm == cold_ohm)
        );
        for _ in 0..400_000 {
            surroundings.step(1e-3, [2.0, -2.0, 0.0]);
        }
        // P = I^2 R0 (1 + a T) and T = P Rth: T = I^2 R0 Rth / (1 - I^2 R0 Rth a).
        let cold_k = 4.0 * cold_ohm * 3.0;
        let settled_k = cold_k / (1.0 - cold_k * 0.0039);
        let [one_k, two_k, three_k] = surroundings.warmer_k();
        assert!((one_k - settled_k).abs() < 0.01, "{one_k} {settled_k}");
        assert!(one_k == two_k && three_k == 0.0);
        let grown = surroundings.resistance_ohm()[0] / cold_ohm;
        assert!((grown - (1.0 + 0.0039 * one_k)).abs() < 1e-12);
    }

    #[test]
    fn a_track_warms_by_the_losses_of_all_windings_over_hours() {
        let mut parameters = unkind();
        parameters.imperfections.winding_heat = false;
        parameters.track.start_k = -5.0;
        let mut surroundings = Surroundings::new(&parameters);
        assert_eq!(surroundings.track_warmer_k(), Some(-5.0));
        let settled_k = (4.0 + 1.0) * parameters.resistance_ohm * 0.5;
        for _ in 0..7_200 {
            surroundings.step(1.0, [2.0, -1.0, 0.0]);
        }
        let expected_k = settled_k - (settled_k + 5.0) * (-1.0_f64).exp();
        let warmer_k = surroundings.track_warmer_k().unwrap_or_default();
        assert!((warmer_k - expected_k).abs() < 1e-3, "{warmer_k}");
        assert_eq!(surroundings.warmer_k(), [0.0; AXES]);
    }

    #[test]
    fn a_kind_machine_stands_still_and_stays_cold() {
        let mut surroundings = Surroundings::new(&PlantParameters::REFERENCE);
        surroundings.step(100.0, [6.0; AXES]);
        assert_eq!(surroundings.floor_m_s2(), [0.0; 2]);
        assert_eq!(surroundings.warmer_k(), [0.0; AXES]);
        assert_eq!(surroundings.track_warmer_k(), None);
    }
}
