//! A machine, where it stands, its loop, and what is measured of it.

use super::matrix::{Complex, Peak, largest_singular_value};
use super::sine::{AROUND_MS, WIDE, columns, push};
use firmware::parameters::{Lead, Notch, Parameters};
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::{with_gains_firmer, with_inertia_scheduled, with_payload_told};
use std::f64::consts::TAU;

/// A machine, where it stands, and its loop.
#[derive(Clone, Copy)]
pub struct Case {
    pub words: &'static str,
    pub payload_kg: f64,
    pub place_mm: [f64; 2],
    pub resonance_hz: f64,
    pub tuning: Tuning,
}

#[derive(Clone, Copy)]
pub struct Gains {
    velocity_v_s_rad: f64,
    position_1_s: f64,
    integral_1_s: f64,
}

pub const SHAPED: Tuning = Tuning::Shaped(Gains {
    velocity_v_s_rad: 43.6,
    position_1_s: 650.0,
    integral_1_s: 720.0,
});
/// For a load of 5 kg: what a ring moves is another part of it in every place, and the resonance comes closer.
pub const SHAPED_FOR_LOAD: Tuning = Tuning::Shaped(Gains {
    velocity_v_s_rad: 33.0,
    position_1_s: 520.0,
    integral_1_s: 560.0,
});

#[derive(Clone, Copy)]
pub enum Tuning {
    /// What the controller comes with, on the kind machine.
    Kind,
    /// Faster, with a notch at the resonance, a lead over the winding's corner, and gains scheduled by the inertia.
    Shaped(Gains),
    /// Told of the machine, scheduled, and firmer: what the told table is of.
    Firmer,
    /// For a soft transmission: half the velocity gain, and a notch.
    Soft,
    /// The reference stage, and all that its controller is told.
    Stage,
}

impl Case {
    fn parameters(&self) -> (StageParameters, Parameters) {
        let is_stage = matches!(self.tuning, Tuning::Stage);
        let options = RunOptions {
            mismatch_percent: 0.0,
            payload_kg: self.payload_kg,
            ..if is_stage {
                RunOptions::reference()
            } else {
                RunOptions::default()
            }
        };
        let mut stage = stage_parameters(&options);
        let softer = self.resonance_hz / 1_500.0;
        stage.plant.transmission_stiffness_n_m_rad *= softer * softer;
        stage.plant.transmission_damping_n_m_s_rad *= softer;
        let mut parameters = controller_parameters(&options);
        // Slowly round: 4 deg/s.
        parameters.limits.turn_speed_deg_s = 4.0;
        // The sine is none of its own.
        parameters.supervision.oscillation_v = 120.0;
        parameters = with_payload_told(&parameters, &stage);
        if matches!(self.tuning, Tuning::Firmer) {
            parameters = with_gains_firmer(&parameters);
        }
        let servo = &mut parameters.servo;
        // With what the platform weighs at a ring, from nothing to all of it and a load, the resonance is between 0.9 and 1.15 times
        // what it is for the slowest mode in the centre.
        let notch = |part: f64| Notch {
            frequency_hz: self.resonance_hz * part,
            width_hz: self.resonance_hz * 0.3,
            gain: 0.3,
        };
        let notches = [notch(0.95), notch(1.12)];
        for (gains, filters) in servo.gains.iter_mut().zip(&mut servo.filters) {
            match self.tuning {
                Tuning::Kind | Tuning::Firmer | Tuning::Stage => {}
                Tuning::Shaped(shaped) => {
                    gains.velocity_v_s_rad = shaped.velocity_v_s_rad;
                    gains.position_1_s = shaped.position_1_s;
                    gains.integral_v_rad = shaped.velocity_v_s_rad * shaped.integral_1_s;
                    filters.notches = notches;
                    filters.lead = Lead {
                        from_hz: 2.1 / 0.7e-3 / TAU,
                        to_hz: 3_000.0,
                    };
                }
                Tuning::Soft => {
                    gains.velocity_v_s_rad *= 0.5;
                    gains.integral_v_rad *= 0.25;
                    gains.position_1_s *= 0.5;
                    filters.notches = notches;
                }
            }
        }
        if matches!(self.tuning, Tuning::Shaped(_) | Tuning::Firmer) {
            parameters = with_inertia_scheduled(&parameters);
        }
        (stage, parameters)
    }

    pub fn row(&self) -> String {
        let (stage, mut parameters) = self.parameters();
        let sensitivities: Vec<(f64, Complex)> =
            columns(&stage, &parameters, self.place_mm, 0, &WIDE)
                .into_iter()
                .map(|(hz, [own, ..])| (hz, own))
                .collect();
        let crossover_hz = (sensitivities.iter().rev())
            .find(|(_, [re, im])| {
                // |L| = |1 - S| / |S|.
                (1.0 - re).hypot(*im) >= re.hypot(*im)
            })
            .map_or(f64::NAN, |(hz, _)| *hz);
        let most = Peak::of((sensitivities.iter()).map(|(hz, [re, im])| (*hz, re.hypot(*im))));
        let low = sensitivities
            .iter()
            .find(|(hz, _)| *hz >= 30.0)
            .map_or(f64::NAN, |(_, [re, im])| re.hypot(*im));
        let rested = push(&stage, &parameters, self.place_mm);
        parameters.servo.rest.stiffness = 1.0;
        let full = push(&stage, &parameters, self.place_mm);
        format!(
            "| {} | {crossover_hz:.0} | {:.2} at {:.0} | {low:.3} | {full} | {rested} |",
            self.words, most.size, most.hz
        )
    }

    /// Ms of each pivot, and the largest singular value.
    pub fn peaks(&self) -> [Peak; 4] {
        let (stage, parameters) = self.parameters();
        let columns =
            [0, 1, 2].map(|pivot| columns(&stage, &parameters, self.place_mm, pivot, &AROUND_MS));
        let own = [0, 1, 2].map(|pivot: usize| {
            Peak::of(columns[pivot].iter().map(|(hz, column)| {
                let [re, im] = column[pivot];
                (*hz, re.hypot(im))
            }))
        });
        let matrices = (0..columns[0].len()).map(|k| {
            let matrix = [0, 1, 2]
                .map(|row: usize| [0, 1, 2].map(|column: usize| columns[column][k].1[row]));
            (columns[0][k].0, largest_singular_value(&matrix))
        });
        let [first, second, third] = own;
        [first, second, third, Peak::of(matrices)]
    }
}
