//! Gains for a machine whose true numbers are known, as who commissions it would find them.

use crate::machine::devices::StageParameters;
use crate::machine::plant::PlantParameters;
use commissioning::chain::{Chain, Load, Place};
use commissioning::drive_model::Electrical;
use commissioning::record::Timing;
use commissioning::tuning::{
    Gains, Limits, MOST_MS, PLACES, Plant, SEARCHED, Sought, rest_stiffness, tune,
};
use firmware::control::servo::{BorneLimits, ServoConfig, carried_inertia};
use firmware::parameters::{Notch, Parameters};

/// The machine as the mathematics of its loops has it: windings are cold, and carriages slide.
#[must_use]
pub fn loop_model(stage: &StageParameters) -> (Chain, [Electrical; 3]) {
    let plant = &stage.plant;
    let payload = &plant.payload;
    let square = plant.track_radius_m * plant.track_radius_m;
    let moment = payload.mass_kg * payload.eccentricity_m * plant.track_radius_m;
    let (sin, cos) = payload.direction_rad.sin_cos();
    // Rigid guides: as stiff as makes no difference.
    let guide = if plant.imperfections.guide_compliance {
        1.0
    } else {
        1e3
    };
    let chain = Chain {
        motor_inertia: plant.motor_inertia_kg_m2,
        ring_inertia: plant.ring_inertia_kg_m2,
        stiffness: plant.transmission_stiffness_n_m_rad,
        damping: plant.transmission_damping_n_m_s_rad,
        viscous: plant.ring_friction.viscous,
        guide_stiffness: guide * square * plant.guide_stiffness_n_m,
        guide_damping: square * plant.guide_damping_n_s_m,
        along_stiffness: 0.0,
        along_damping: 0.0,
        load: Load {
            mass: square * (plant.platform_mass_kg + payload.mass_kg),
            inertia: plant.platform_inertia_kg_m2
                + payload.inertia_kg_m2
                + payload.mass_kg * payload.eccentricity_m.powi(2),
            moment: [moment * cos, moment * sin],
        },
    };
    let electrical = Electrical {
        resistance_ohm: plant.resistance_ohm,
        inductance_h: plant.inductance_h,
        motor_constant: plant.ring_torque_constant_n_m_a(),
        dead_time_v: 0.0,
        deviations: [0.0; 4],
    };
    (chain, [electrical; 3])
}

/// Ms of gains that were only turned down: slower ones would not follow any more what such a machine asks for.
const MOST_FITTED_MS: f64 = 3.0;

/// What the servos see at these places.
fn plants((chain, electrical): &(Chain, [Electrical; 3]), places: &[[f64; 2]]) -> Vec<Plant> {
    Plant::at_places(electrical, chain, places, &Timing::STAGE)
}

/// Parameters with gains, and with what rest leaves of them.
fn with_gains(parameters: &Parameters, gains: &Gains) -> Parameters {
    let mut told = gains.applied_to(parameters);
    told.servo.rest.stiffness = rest_stiffness(gains.least_velocity_v_s_rad());
    told
}

/// The same with the gains and filters that reject most at 30 Hz and keep an Ms of 1.9, and of 2 at the rim, by the true machine's mathematics: what the
/// step `tuning` of a commissioning would find with nothing measured wrong, no doubt of its model, and no friction that holds the stage off.
#[must_use]
pub fn with_gains_tuned(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    sought(parameters, stage, |_| Vec::new(), &Limits::ON_MODEL)
}

/// The same for every day and for guides with friction: an Ms of 1.95 is kept with windings as warm as they are at work and as cold as they are after a
/// rest, and some rejection is given for a faster tail, as the step `tuning` does.
#[must_use]
pub fn with_gains_for_every_day(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let (chain, electrical) = loop_model(stage);
    let days = [Electrical::at_work, Electrical::rested].map(|day| electrical.each_ref().map(day));
    let may_be = |places: &[[f64; 2]]| {
        (days.iter())
            .flat_map(|day| plants(&(chain, *day), places))
            .collect()
    };
    sought(parameters, stage, may_be, &Limits::WITH_FRICTION)
}

fn sought(
    parameters: &Parameters,
    stage: &StageParameters,
    may_be: impl Fn(&[[f64; 2]]) -> Vec<Plant>,
    limits: &Limits,
) -> Parameters {
    let model = loop_model(stage);
    let (chain, electrical) = &model;
    let centre = Place::centre();
    let others = &PLACES[SEARCHED..];
    let tuned = tune(
        Sought {
            found: &plants(&model, &PLACES[..SEARCHED]),
            may_be: &may_be(&PLACES[..SEARCHED]),
            elsewhere: &[plants(&model, others), may_be(others)].concat(),
        },
        electrical,
        &chain.resonances_hz(&centre),
        chain.inertia(&centre)[(0, 0)],
        limits,
    );
    let sound = (tuned.ok()).and_then(|tuned| {
        let plants = [plants(&model, &PLACES), may_be(&PLACES)].concat();
        (tuned.gains).slowed_until_sound(&plants, MOST_MS)
    });
    match sound {
        Some((gains, _)) => with_gains(parameters, &gains),
        None => with_gains_fitted(parameters, stage),
    }
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

/// What of it is left for what the model has not: a gap, a preload that opens.
const SAFETY: f64 = 0.6;

/// At which the platform swings across its guides with its pivots held, Hz.
#[must_use]
pub fn guides_hz(plant: &PlantParameters) -> f64 {
    let carried_kg = plant.platform_mass_kg + plant.payload.mass_kg;
    (1.5 * plant.guide_stiffness_n_m / carried_kg).sqrt() / core::f64::consts::TAU
}

/// The same with gains that its resonances bear, as who puts it into service turns them down: as crossovers fall on machines that were
/// tried (272 Hz rigid; 240, 204 and 120 with guides that resonate at 796, 503 and 218 Hz; three quarters of that with a transmission of
/// 600 Hz), then by two fifths, and further until the loops keep an Ms of 3 everywhere. In a hundredth of the time that a search takes.
#[must_use]
pub fn with_gains_fitted(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let (plant, reference) = (&stage.plant, &StageParameters::REFERENCE.plant);
    let softer = plant.transmission_stiffness_n_m_rad / reference.transmission_stiffness_n_m_rad;
    let transmission_hz = TRANSMISSION_HZ * softer.sqrt();
    let guides_hz = guides_hz(plant);
    // The winding's lag is the largest that the loop has.
    let lag_s = |plant: &PlantParameters| plant.inductance_h / plant.resistance_ohm;
    let share = (transmission_hz / TRANSMISSION_HZ).powf(0.3).min(1.0)
        * SAFETY
        * (lag_s(reference) / lag_s(plant)).min(1.0)
        * (guides_hz / GUIDES_HZ).sqrt().min(1.0);
    for gains in &mut told.servo.gains {
        gains.velocity_v_s_rad *= share;
        gains.position_1_s *= share;
        gains.integral_v_rad *= share * share;
    }
    let plants = plants(&loop_model(stage), &PLACES);
    // A notch takes phase too: whichever bears more, with or without. As they are where no slower ones do.
    let filtered = |notches: [Notch; 2]| {
        let mut told = told.clone();
        for filters in &mut told.servo.filters {
            filters.notches = notches;
        }
        told
    };
    let with_notches = filtered(notches(parameters, plant));
    let without = filtered(parameters.servo.filters[0].notches);
    let sound = |told: &Parameters| {
        let (gains, _) = Gains::of(told).slowed_until_sound(&plants, MOST_FITTED_MS)?;
        Some((gains.least_velocity_v_s_rad(), gains.applied_to(told)))
    };
    ([&with_notches, &without].into_iter())
        .filter_map(sound)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map_or_else(|| with_notches.clone(), |(_, told)| told)
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

#[cfg(test)]
mod tests {
    use super::super::Told;
    use super::*;
    use crate::machine::plant::Imperfections;
    use crate::machine::unknown;
    use std::f64::consts::TAU;

    /// What the shipped gains leave of a disturbance at 30 Hz, over what the best leave that know the machine.
    const MOST_OVER_BEST: f64 = 1.3;

    #[test]
    fn the_reference_stage_comes_with_gains_that_its_commissioning_found_for_it() {
        let stage = reference();
        let plants = plants(&loop_model(&stage), &PLACES);
        let [shipped, best] = [Told::Reference, Told::Everything].map(|told| {
            let told = told.parameters(&Parameters::REFERENCE, &stage);
            Gains::of(&told).at_worst(&plants).expect("a plant")
        });
        println!("shipped {shipped:?}\nbest {best:?}");
        assert!(shipped.are_sound(MOST_MS));
        assert!(shipped.rejection < MOST_OVER_BEST * best.rejection);
    }

    #[test]
    fn gains_that_are_sound_at_the_places_are_sound_all_over_the_disk() {
        let disk: Vec<[f64; 2]> = (0..9 * 12)
            .map(|k| {
                let (radius, angle) = (0.1 * f64::from(k / 12), f64::from(k % 12) * TAU / 12.0);
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let machines = [
            (reference(), Told::Reference),
            (reference(), Told::Everything),
            (unknown(9), Told::Everything),
        ];
        for (stage, told) in machines {
            let parameters = told.parameters(&Parameters::REFERENCE, &stage);
            let plants = plants(&loop_model(&stage), &disk);
            let worst = (Gains::of(&parameters).at_worst(&plants)).expect("a plant");
            println!("{told}: {worst:?}");
            assert!(worst.are_sound(MOST_MS));
        }
    }

    fn reference() -> StageParameters {
        let mut stage = StageParameters::REFERENCE;
        stage.plant.imperfections = Imperfections::ALL;
        stage
    }
}
