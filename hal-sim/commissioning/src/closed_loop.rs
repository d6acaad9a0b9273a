//! The closed loop as it was measured, at the lines of its excitation, and what the servos drive.
//!
//! A known voltage `e` is added to what a servo asks for; `S = U E^-1` is what the loop leaves of it. U is not the voltage that the bridge was told: of
//! that the dead time takes a part, and the controller adds what it thinks that to be. It is the voltage at the winding, which currents
//! and angles tell: `U = (R + s L) I + K s p`, p being the motor's angle. The plant that the servos see is `Phi U^-1`.
//!
//! The motor's angle is that of its ring and what the transmission winds up by. Beside the frequency at which the motor swings on the transmission
//! by itself that does not follow from the ring's, and the model tells it from the currents of all three drives: where the platform resonates
//! near by, the motor's back-EMF is most of the voltage.

use crate::chain::{Chain, Place};
use crate::drive_model::Electrical;
use crate::frequency_response::{Line, Run, hold};
use crate::record::Timing;
use crate::spectrum::spectrum;
use firmware::control::excitation::Multisine;
use nalgebra::{Complex, Matrix3};
use std::f64::consts::TAU;

/// What was measured at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopLine {
    /// Frequency.
    pub hz: f64,
    /// From voltages at the windings to angles, rad/V.
    pub plant: Matrix3<Complex<f64>>,
    /// What becomes of a voltage that is added to the servos'.
    pub sensitivity: Matrix3<Complex<f64>>,
}

/// Loops at the lines, in which each drive was excited with sines of a peak; NaN where nothing follows.
#[must_use]
pub fn closed_loop(
    runs: &[Run],
    lines: &[Line],
    peak_v: f64,
    model: (&[Electrical; 3], &Chain, &Place),
    timing: &Timing,
) -> Vec<LoopLine> {
    let mut excited: Vec<_> = runs
        .iter()
        .flat_map(|run| excitation(run, peak_v, timing))
        .collect();
    excited.sort_by(|a, b| a.0.total_cmp(&b.0));
    (lines.iter().zip(excited))
        .map(|(line, (_, volts))| {
            let winding = winding_volts(line, model);
            let nothing = Matrix3::repeat(Complex::new(f64::NAN, f64::NAN));
            LoopLine {
                hz: line.hz,
                plant: (winding.try_inverse()).map_or(nothing, |inverse| line.angle_rad * inverse),
                sensitivity: winding / volts,
            }
        })
        .collect()
}

/// Frequencies of a run's lines, and what was added there, V: as the controller makes it, held from tick to tick.
fn excitation(run: &Run, peak_v: f64, timing: &Timing) -> Vec<(f64, Complex<f64>)> {
    let harmonics: Vec<u32> = run.bins.iter().map(|bin| *bin as u32).collect();
    let mut sines = Multisine::new(&harmonics, peak_v);
    let period: Vec<f64> = (0..run.period_ticks)
        .map(|_| f64::from(sines.next_volts()))
        .collect();
    let spectrum = spectrum(&period);
    (run.bins.iter())
        .map(|&bin| {
            let hz = bin as f64 / (run.period_ticks as f64 * timing.tick_s);
            (hz, spectrum[bin] * hold(hz, timing))
        })
        .collect()
}

/// Voltages at the windings.
fn winding_volts(
    line: &Line,
    (drives, chain, place): (&[Electrical; 3], &Chain, &Place),
) -> Matrix3<Complex<f64>> {
    let s = Complex::new(0.0, TAU * line.hz);
    let torques = Matrix3::from_fn(|i, k| line.current_a[(i, k)] * drives[i].motor_constant);
    let as_modelled = chain.compliance(line.hz, place).motor * torques * s;
    Matrix3::from_fn(|i, k| {
        let (drive, current) = (&drives[i], line.current_a[(i, k)]);
        let ring_rate = s * line.angle_rad[(i, k)];
        let rate = chain
            .motor_rate(line.hz, ring_rate, torques[(i, k)])
            .unwrap_or(as_modelled[(i, k)]);
        (drive.resistance_ohm + s * drive.inductance_h) * current + drive.motor_constant * rate
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive_model::Guess;

    /// A motor that swings on its transmission at 500 Hz, and a platform that resonates near by: the voltage at the windings is told all the way.
    #[test]
    fn a_motor_on_its_transmission_is_told_beside_its_own_frequency_too() {
        let chain = Chain {
            stiffness: Guess::STAGE.0.motor_inertia * (TAU * 500.0).powi(2),
            damping: 1.4,
            ..Guess::STAGE.0
        };
        let drive = Electrical {
            resistance_ohm: 2.0,
            inductance_h: 8e-4,
            motor_constant: 3.5,
            dead_time_v: 0.0,
            deviations: [0.0; 4],
        };
        let (place, none) = (Place::centre(), Matrix3::zeros());
        let constant = Complex::from(drive.motor_constant);
        for hz in (300..900).map(f64::from) {
            let s = Complex::new(0.0, TAU * hz);
            let answer = chain.compliance(hz, &place);
            let impedance = Complex::from(drive.resistance_ohm) + s * drive.inductance_h;
            let expected =
                Matrix3::identity() * impedance + answer.motor * (constant * constant * s);
            let line = Line {
                hz,
                volts: Matrix3::zeros(),
                current_a: Matrix3::identity(),
                angle_rad: answer.ring * constant,
                angle_deviation_rad: none,
                current_deviation_a: none,
            };
            let off = winding_volts(&line, (&[drive; 3], &chain, &place)) - expected;
            assert!(off.norm() < 1e-6 * expected.norm(), "{hz} Hz: {off}");
        }
    }
}
