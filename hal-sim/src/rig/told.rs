//! A controller that is told of the machine before it: the true numbers in place of the model's, each of them something that `SPA` sets.

use crate::machine::devices::{COUNTS_PER_TURN, StageParameters};
use crate::machine::plant::PlantParameters;
use firmware::control::servo::{BorneLimits, ServoConfig, carried_inertia};
use firmware::parameters::{Harmonic, Notch, Parameters, SubdivisionHarmonic};
use std::fmt;

/// What a controller is told of the machine before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// It is as it comes.
    Nothing,
    /// [`with_machine_told`].
    Machine,
    /// And [`with_ripple_told`].
    MachineAndRipple,
}

impl Told {
    /// The controller's parameters with what it is told.
    #[must_use]
    pub fn parameters(self, parameters: &Parameters, stage: &StageParameters) -> Parameters {
        match self {
            Self::Nothing => parameters.clone(),
            Self::Machine => with_machine_told(parameters, stage),
            Self::MachineAndRipple => {
                with_ripple_told(&with_machine_told(parameters, stage), stage)
            }
        }
    }
}

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nothing => "nothing",
            Self::Machine => "machine",
            Self::MachineAndRipple => "machine and ripple",
        })
    }
}

/// The controller's parameters with the drives and the platform as they are on this machine, and gains that fit its motors. Payload
/// and everything else stay what the controller takes them for.
#[must_use]
pub fn with_drives_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let plant = &stage.plant;
    for (drive, gains) in told.drives.iter_mut().zip(&mut told.servo.gains) {
        // Volts for the same torque.
        let weaker = drive.torque_constant_n_m_a / plant.torque_constant_n_m_a
            * (plant.resistance_ohm / drive.resistance_ohm);
        gains.velocity_v_s_rad *= weaker;
        gains.integral_v_rad *= weaker;
        drive.torque_constant_n_m_a = plant.torque_constant_n_m_a;
        drive.resistance_ohm = plant.resistance_ohm;
        drive.inductance_h = plant.inductance_h;
        drive.inertia_kg_m2 = plant.ring_inertia_kg_m2 + plant.motor_inertia_kg_m2;
        drive.viscous_n_m_s = plant.ring_friction.viscous;
        drive.coulomb_n_m = plant.ring_friction.coulomb;
        if plant.imperfections.motor_friction {
            drive.coulomb_n_m += plant.motor_friction.coulomb;
        }
    }
    told.platform.mass_kg = plant.platform_mass_kg;
    told.platform.inertia_kg_m2 = plant.platform_inertia_kg_m2;
    told
}

/// The same with the load on the platform.
#[must_use]
pub fn with_payload_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let payload = &stage.plant.payload;
    let (sin, cos) = payload.direction_rad.sin_cos();
    let platform = &mut told.platform;
    platform.payload_kg = payload.mass_kg;
    platform.payload_inertia_kg_m2 = payload.inertia_kg_m2;
    platform.payload_centre_mm = [cos, sin].map(|part| part * payload.eccentricity_m * 1e3);
    told
}

/// The same with the velocity and integral gains scheduled by what a pivot moves. The gains are for the inertia at a pivot with the
/// reference stage's platform in the middle.
#[must_use]
pub fn with_inertia_scheduled(parameters: &Parameters) -> Parameters {
    let reference = Parameters::REFERENCE;
    let body = ServoConfig::new(&reference).body;
    let carried = carried_inertia(&body, &[1.0; 3], &[1.0; 3], 0);
    let mut told = parameters.clone();
    told.servo.scheduled_inertia_kg_m2 = reference.drives[0].inertia_kg_m2 + f64::from(carried);
    told
}

/// The same with the torque ripple of the motors.
#[must_use]
pub fn with_ripple_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let plant = &stage.plant;
    for ripple in &mut told.servo.ripple {
        ripple.harmonics[0] = Harmonic {
            periods: plant.ripple_periods_per_motor_turn * plant.gear_ratio,
            amplitude_n_m: plant.ripple_n_m,
            phase_deg: 0.0,
        };
    }
    told
}

/// The same with the errors of the encoders within the periods of their scales.
#[must_use]
pub fn with_subdivision_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let both = told.subdivision.iter_mut().zip(&stage.encoders);
    for (subdivision, encoder) in both {
        let periods = encoder.scale_periods_per_turn;
        // The sine rises through zero where the ring's angle is zero, whichever way the encoder counts. Whole turns of the phase are
        // taken away in whole numbers.
        let counts =
            (u64::from(encoder.zero_counts) * u64::from(periods)) % u64::from(COUNTS_PER_TURN);
        subdivision.periods = periods;
        subdivision.harmonics[0] = SubdivisionHarmonic {
            amplitude_nrad: (encoder.subdivisional_error_rad * 1e9).round() as u16,
            phase_tenths_deg: (-3_600.0 * counts as f64 / f64::from(COUNTS_PER_TURN)).round()
                as i16,
        };
    }
    told
}

/// Share of the integral gain with which an identified machine learns what changes: more would answer to the motors' ripple.
pub const IDENTIFIED_LEARNING: f64 = 0.25;

/// All of it but the ripple, and a learning for what is left.
#[must_use]
pub fn with_machine_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let drives = with_drives_told(parameters, stage);
    let mut told = with_inertia_scheduled(&with_payload_told(&drives, stage));
    told.servo.learning = IDENTIFIED_LEARNING;
    told
}

/// The same with gains for a machine that is told of and has no resonance under 1.5 kHz: those that it comes with leave room for a machine
/// that is a third off.
#[must_use]
pub fn with_gains_firmer(parameters: &Parameters) -> Parameters {
    let mut told = parameters.clone();
    for gains in &mut told.servo.gains {
        gains.velocity_v_s_rad *= 1.1;
        gains.integral_v_rad = gains.velocity_v_s_rad * FIRMER_INTEGRAL_1_S;
    }
    told
}

/// Integral gain over velocity gain then: 350 as it comes.
const FIRMER_INTEGRAL_1_S: f64 = 500.0;

/// Resonance of the reference stage's transmission, Hz, and that of its guides across with its platform between them.
const TRANSMISSION_HZ: f64 = 1500.0;
const GUIDES_HZ: f64 = 796.0;

/// What of it is left for what is not known of a machine: places where its pivots carry more or less, a gap, a load off its centre.
const SAFETY: f64 = 0.6;

/// The same with gains that its resonances bear, as who puts it into service turns them down: as crossovers fall on machines that were
/// tried (272 Hz rigid; 240, 204 and 120 with guides that resonate at 796, 503 and 218 Hz; three quarters of that with a transmission of
/// 600 Hz), and then by two fifths.
#[must_use]
pub fn with_gains_fitted(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let (plant, reference) = (&stage.plant, &StageParameters::REFERENCE.plant);
    let softer = plant.transmission_stiffness_n_m_rad / reference.transmission_stiffness_n_m_rad;
    let transmission_hz = TRANSMISSION_HZ * softer.sqrt();
    let carried_kg = plant.platform_mass_kg + plant.payload.mass_kg;
    let guides_hz = (1.5 * plant.guide_stiffness_n_m / carried_kg).sqrt() / core::f64::consts::TAU;
    // The winding's lag is the largest that the loop has.
    let lag_s = |plant: &PlantParameters| plant.inductance_h / plant.resistance_ohm;
    let share = (transmission_hz / TRANSMISSION_HZ).powf(0.3).min(1.0)
        * SAFETY
        * (lag_s(reference) / lag_s(plant)).min(1.0)
        * (guides_hz / GUIDES_HZ).sqrt().min(1.0);
    for filters in &mut told.servo.filters {
        filters.notches = notches(parameters, plant);
    }
    for gains in &mut told.servo.gains {
        gains.velocity_v_s_rad *= share;
        gains.position_1_s *= share;
        gains.integral_v_rad *= share * share;
    }
    told
}

/// The same with a motion that its motors bear.
#[must_use]
pub fn with_motion_fitted(parameters: &Parameters) -> Parameters {
    BorneLimits::new(parameters).applied_to(parameters)
}

/// Resonances under which a loop has to be kept from a drive's, Hz: what lies higher it does not reach.
const REACHED_HZ: f64 = 1_500.0;

/// Notches at the resonances of a drive in the middle of the disk. The first: its motor against its ring with what that carries, where the
/// guides are stiff. The second: the upper one of motor, ring and carried body in a row, where they are not, `l^2 - A l + B = 0` in the square
/// of the angular frequency. Their widths are for what a pivot carries elsewhere.
fn notches(parameters: &Parameters, plant: &PlantParameters) -> [Notch; 2] {
    let body = ServoConfig::new(parameters).body;
    let carried_kg_m2 = f64::from(carried_inertia(&body, &[1.0; 3], &[1.0; 3], 0));
    let radius_m = parameters.geometry.radius_mm * 1e-3;
    let transmission = plant.transmission_stiffness_n_m_rad;
    let guide = plant.guide_stiffness_n_m * radius_m * radius_m;
    let [motor, ring, carried] = [
        plant.motor_inertia_kg_m2,
        plant.ring_inertia_kg_m2,
        carried_kg_m2,
    ]
    .map(f64::recip);
    let load = 1.0 / (1.0 / ring + carried_kg_m2);
    let stiff = transmission * (motor + load);
    let a = transmission * (motor + ring) + guide * (ring + carried);
    let b = transmission * guide * (motor * ring + motor * carried + ring * carried);
    let upper = 0.5 * (a + (a * a - 4.0 * b).sqrt());
    [(stiff, 0.25), (upper, 0.3)].map(|(square, width)| {
        let frequency_hz = square.sqrt() / core::f64::consts::TAU;
        Notch {
            frequency_hz: if frequency_hz < REACHED_HZ {
                frequency_hz
            } else {
                0.0
            },
            width_hz: width * frequency_hz,
            gain: 0.15,
        }
    })
}
