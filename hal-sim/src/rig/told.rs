//! A controller that is told of the machine before it: the true numbers in place of the model's, each of them something that `SPA` sets.

use super::calibrated::calibration_told;
use super::gains::{with_gains_tuned, with_motion_fitted};
use super::shipped::with_reference_settings;
use super::{leads_turns, turn_zeros};
use crate::machine::devices::{COUNTS_PER_TURN, StageParameters};
use commissioning::tuning::IDENTIFIED_LEARNING;
use firmware::calibration::MachineCalibration;
use firmware::control::servo::{ServoConfig, carried_inertia};
use firmware::parameters::{
    EncoderMounting, GearError, Harmonic, Parameters, SubdivisionHarmonic, Wiring,
};
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
    /// And all else that it can be told: [`with_everything_told`].
    Everything,
    /// What the reference stage comes with, whatever this one is: what `tripivot commission` found of it
    /// (`tripivot machine >ref.toml; tripivot commission --machine ref.toml` leaves it in `settings.txt`, here `reference_stage.txt`), and the
    /// calibration that would come of it if nothing were measured wrong, zeros with it.
    Reference,
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
            Self::Everything => with_everything_told(parameters, stage),
            Self::Reference => with_reference_told(parameters, stage),
        }
    }

    /// The controller's calibration with what it is told.
    #[must_use]
    pub fn calibration(self, stage: &StageParameters) -> Option<MachineCalibration> {
        let on = &stage.plant.imperfections;
        let is_built = on.geometry || on.encoder_eccentricity || on.encoder_harmonics;
        match self {
            Self::Everything if is_built => Some(calibration_told(stage)),
            Self::Reference if is_built => Some(calibration_told(&reference(stage))),
            _ => None,
        }
    }
}

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nothing => "nothing",
            Self::Machine => "machine",
            Self::MachineAndRipple => "machine and ripple",
            Self::Everything => "everything",
            Self::Reference => "what commissioning found",
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
        drive.motor_inertia_kg_m2 = plant.motor_inertia_kg_m2;
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

/// The same with friction and stiffness of the guides.
#[must_use]
pub fn with_guides_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let plant = &stage.plant;
    let friction = &plant.guide_friction;
    if plant.imperfections.guide_friction {
        told.guides.coulomb_n = friction.coulomb;
        told.guides.viscous_n_s_m = friction.viscous;
        told.guides.presliding_um = friction.presliding * 1e6;
    }
    if plant.imperfections.guide_compliance {
        told.guides.stiffness_n_um = plant.guide_stiffness_n_m * 1e-6;
    }
    told
}

/// The same with the order of the plugs, the directions of the motors, and zeros and directions of the encoders.
#[must_use]
pub fn with_wiring_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let wiring = &stage.wiring;
    let digits = |connectors: [u8; 3]| {
        (connectors.iter()).fold(0, |number, at| 10 * number + u16::from(*at) + 1)
    };
    told.wiring = Wiring {
        encoder_order: digits(wiring.port_of_ring),
        bridge_order: digits(wiring.bridge_of_ring),
        motors_reversed: wiring.leads_exchanged,
    };
    for (mounting, encoder) in told.encoders.iter_mut().zip(&stage.encoders) {
        *mounting = EncoderMounting {
            zero_counts: encoder.zero_counts,
            reversed: encoder.reversed,
        };
    }
    told
}

/// All that parameters can say of a machine, gains that its resonances bear, and a motion that its motors do.
#[must_use]
pub fn with_everything_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let told = with_numbers_told(parameters, stage);
    with_motion_fitted(&with_gains_tuned(&told, stage))
}

/// Zeros are the true ones, as those of a calibration; and what of the reference stage is not on this one is not made up for.
fn with_reference_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let (reference, on) = (reference(stage), &stage.plant.imperfections);
    let mut told = with_reference_settings(parameters);
    let leads = leads_turns(&told, &reference);
    turn_zeros(&mut told, leads);
    if !on.motor_friction {
        for drive in &mut told.drives {
            drive.coulomb_n_m -= reference.plant.motor_friction.coulomb;
        }
    }
    if !on.guide_friction {
        (told.guides.coulomb_n, told.guides.viscous_n_s_m) = (0.0, 0.0);
    }
    if !on.guide_compliance {
        told.guides.stiffness_n_um = 0.0;
    }
    if !on.gear_error {
        told.servo.gear_errors = Parameters::REFERENCE.servo.gear_errors;
    }
    if !on.subdivisional_error {
        told.subdivision = Parameters::REFERENCE.subdivision;
    }
    told
}

fn reference(stage: &StageParameters) -> StageParameters {
    let mut reference = StageParameters::REFERENCE;
    reference.plant.imperfections = stage.plant.imperfections;
    reference
}

fn with_numbers_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let on = &stage.plant.imperfections;
    let machine = with_guides_told(&with_machine_told(parameters, stage), stage);
    let mut told = with_wiring_told(&machine, stage);
    if on.torque_ripple {
        told = with_ripple_told(&told, stage);
    }
    if on.gear_error {
        told = with_gear_errors_told(&told, stage);
    }
    if on.subdivisional_error {
        told = with_subdivision_told(&told, stage);
    }
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

/// The same with the cyclic errors of the gears.
#[must_use]
pub fn with_gear_errors_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let gear = &stage.plant.gear;
    for (error, phase_rad) in (told.servo.gear_errors.iter_mut()).zip(gear.cyclic_phase_rad) {
        *error = GearError {
            amplitude_urad: 1e6 * gear.cyclic_error_rad,
            phase_deg: phase_rad.to_degrees(),
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

/// All of it but the ripple, and a learning for what is left.
#[must_use]
pub fn with_machine_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let drives = with_drives_told(parameters, stage);
    let mut told = with_inertia_scheduled(&with_payload_told(&drives, stage));
    told.servo.learning = IDENTIFIED_LEARNING;
    told
}
