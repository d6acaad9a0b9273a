//! Guides that give way and rub: energy, momentum, order, resonance, sag and lost motion.

use std::f64::consts::TAU;

use hal_sim::machine::plant::{
    AXES, Drive, External, FrictionParameters, Imperfections, Payload, Plant, PlantParameters,
};

const STEP_S: f64 = 12.5e-6;
const ELASTIC: Imperfections = Imperfections {
    guide_compliance: true,
    ..Imperfections::NONE
};
const PAYLOAD: Payload = Payload {
    mass_kg: 4.0,
    inertia_kg_m2: 0.01,
    eccentricity_m: 0.05,
    direction_rad: 0.7,
};
/// Rings that do not move.
const HEAVY_RINGS_KG_M2: f64 = 1e10;

fn conservative() -> PlantParameters {
    PlantParameters {
        payload: PAYLOAD,
        transmission_damping_n_m_s_rad: 0.0,
        stop_damping_n_s_m: 0.0,
        guide_damping_n_s_m: 0.0,
        imperfections: ELASTIC,
        ..PlantParameters::REFERENCE
    }
}

fn run(plant: &mut Plant, seconds: f64, step_s: f64, drives: &[Drive; AXES]) {
    for _ in 0..(seconds / step_s).round() as u64 {
        plant.step(step_s, drives);
    }
    assert_eq!(plant.broken(), None);
}

#[test]
fn free_motion_keeps_its_energy_and_its_angular_momentum() {
    let parameters = conservative();
    let mut plant = Plant::new(parameters);
    plant.set_pose_at_rest([0.02, -0.01, 0.4]);
    plant.set_velocity([0.04, 0.03, 5.0]);
    let energy_j = |plant: &Plant| plant.kinetic_energy_j() + plant.elastic_energy_j();
    let (start_j, start) = (energy_j(&plant), angular_momentum(&parameters, &plant));
    let (mut drift, mut change, mut farthest_m) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..300 {
        run(&mut plant, 1e-3, STEP_S, &[Drive::Coast; AXES]);
        drift = drift.max((energy_j(&plant) / start_j - 1.0).abs());
        change = change.max((angular_momentum(&parameters, &plant) / start - 1.0).abs());
        let gaps_m = plant.gaps_m();
        farthest_m = gaps_m.into_iter().map(f64::abs).fold(farthest_m, f64::max);
    }
    println!("drift of energy {drift:.2e}, of momentum {change:.2e}, guides {farthest_m:.2e} m");
    assert!(drift < DRIFT && change < MOMENTUM, "{drift:e} {change:e}");
    // The centrifugal force of 5 kg at 5 rad/s pulls the guides.
    assert!(farthest_m > 20e-9, "{farthest_m:e}");
}
const DRIFT: f64 = 7.7e-13;
const MOMENTUM: f64 = 1.2e-14;

fn angular_momentum(parameters: &PlantParameters, plant: &Plant) -> f64 {
    let (rates, motors) = (plant.pivot_rates_rad_s(), plant.motor_rates_rad_s());
    let rings: f64 = (0..AXES)
        .map(|i| {
            parameters.ring_inertia_kg_m2 * rates[i] + parameters.motor_inertia_kg_m2 * motors[i]
        })
        .sum();
    let ([x, y, theta], [vx, vy, spin]) = (plant.pose(), plant.velocity());
    let angle = theta + PAYLOAD.direction_rad;
    let (ax, ay) = (
        PAYLOAD.eccentricity_m * angle.cos(),
        PAYLOAD.eccentricity_m * angle.sin(),
    );
    rings
        + parameters.platform_mass_kg * (x * vy - y * vx)
        + PAYLOAD.mass_kg * ((x + ax) * (vy + spin * ax) - (y + ay) * (vx - spin * ay))
        + (parameters.platform_inertia_kg_m2 + PAYLOAD.inertia_kg_m2) * spin
}

#[test]
fn integrator_is_of_fourth_order() {
    let end = |step_s: f64| {
        let mut plant = Plant::new(PlantParameters {
            payload: PAYLOAD,
            imperfections: Imperfections {
                viscous_friction: true,
                geometry: true,
                ..ELASTIC
            },
            ..PlantParameters::REFERENCE
        });
        plant.set_pose_at_rest([0.03, -0.02, 0.3]);
        let drives = [20.0, -4.0, 11.0].map(Drive::Voltage);
        run(&mut plant, 5e-3, step_s, &drives);
        (plant.pose(), plant.velocity())
    };
    let (reference, _) = end(25e-6 / 32.0);
    let errors = [25e-6, 12.5e-6, 6.25e-6].map(|step_s| {
        let (pose, _) = end(step_s);
        (0..3)
            .map(|i| (pose[i] - reference[i]).abs())
            .fold(0.0, f64::max)
    });
    println!("errors {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.6..4.6).contains(&order), "order {order} from {errors:?}");
    }
}

#[test]
fn the_platform_sags_and_rings_on_its_guides() {
    // The rings held, a force moves the platform by F / 1.5 k, and it rings with sqrt(1.5 k / m): 796 Hz with 3 kg.
    let parameters = PlantParameters {
        ring_inertia_kg_m2: HEAVY_RINGS_KG_M2,
        imperfections: ELASTIC,
        ..PlantParameters::REFERENCE
    };
    let mut plant = Plant::new(parameters);
    let push = External {
        force_n: [12.0, 0.0],
        ..External::default()
    };
    plant.set_external(push);
    run(&mut plant, 0.2, STEP_S, &[Drive::Coast; AXES]);
    let sag_m = plant.pose()[0];
    assert!((sag_m / (12.0 / 75e6) - 1.0).abs() < 1.6e-5, "{sag_m:e}");
    plant.set_external(External::default());
    let mut crossings = Vec::new();
    let mut last_m = sag_m;
    for step in 0..800 {
        run(&mut plant, 2.5e-6, 2.5e-6, &[Drive::Coast; AXES]);
        let x_m = plant.pose()[0];
        if x_m * last_m < 0.0 {
            crossings.push(f64::from(step) * 2.5e-6);
        }
        last_m = x_m;
    }
    let last = crossings.len() - 1;
    let hz = last as f64 / (2.0 * (crossings[last] - crossings[0]));
    let expected_hz = (75e6_f64 / 3.0).sqrt() / TAU;
    println!("sag {sag_m:.3e} m, {hz:.1} Hz, {expected_hz:.1} Hz expected");
    assert!((hz / expected_hz - 1.0).abs() < 2e-3, "{hz}");
}

/// The ring drive of a quasi-static motion: each ring follows its angle of a pose on a stiff spring.
fn held_rings(plant: &Plant, wanted_rad: [f64; AXES]) -> External {
    let (angles, rates) = (plant.pivots_rad(), plant.pivot_rates_rad_s());
    External {
        ring_torque_n_m: [0, 1, 2].map(|i| 1e5 * (wanted_rad[i] - angles[i]) - 120.0 * rates[i]),
        ..External::default()
    }
}

#[test]
fn friction_of_the_guides_is_motion_that_no_encoder_sees() {
    let friction = PlantParameters::REFERENCE.guide_friction;
    let parameters = PlantParameters {
        guide_friction: FrictionParameters {
            viscous: 0.0,
            stiction_ratio: 1.0,
            ..friction
        },
        imperfections: Imperfections {
            guide_friction: true,
            ..ELASTIC
        },
        ..PlantParameters::REFERENCE
    };
    // The rigid machine says which ring angles belong to a pose.
    let mut ideal = Plant::new(PlantParameters::REFERENCE);
    let mut squares_m2 = Vec::new();
    for (index, place) in [[0.0, 0.0], [0.03, 0.02], [-0.05, 0.01], [0.02, -0.06]]
        .into_iter()
        .enumerate()
    {
        let angle = 0.3 + 1.7 * index as f64;
        let along = [angle.cos(), angle.sin()];
        let arrive = |sign: f64, ideal: &mut Plant| {
            let mut plant = Plant::new(parameters);
            let pose = |from_m: f64| {
                [
                    place[0] + from_m * along[0],
                    place[1] + from_m * along[1],
                    0.4,
                ]
            };
            plant.set_pose_at_rest(pose(sign * 2e-4));
            for step in 0..24_000 {
                // 0.2 mm in 0.24 s, ten times the presliding, and then rest.
                let left = (1.0 - f64::from(step) / 19_200.0).max(0.0);
                ideal.set_pose_at_rest(pose(sign * 2e-4 * left));
                plant.set_external(held_rings(&plant, ideal.pivots_rad()));
                run(&mut plant, STEP_S, STEP_S, &[Drive::Coast; AXES]);
            }
            // What the encoders make of the rings' angles, to first order about the pose.
            let wanted = ideal.pivots_rad();
            let off = nalgebra::Vector3::from_fn(|i, _| plant.pivots_rad()[i] - wanted[i]);
            let seen = ideal.jacobian().try_inverse().unwrap() * off;
            [0, 1].map(|i| plant.pose()[i] - pose(0.0)[i] - seen[i])
        };
        let (there, back) = (arrive(1.0, &mut ideal), arrive(-1.0, &mut ideal));
        let lost_m = 0.5 * (there[0] - back[0]).hypot(there[1] - back[1]);
        println!("lost motion at {place:?}: +-{:.1} nm", lost_m * 1e9);
        squares_m2.push(lost_m * lost_m);
    }
    let rms_m = (squares_m2.iter().sum::<f64>() / squares_m2.len() as f64).sqrt();
    println!("rms {:.1} nm", rms_m * 1e9);
    // In the centre two guides push against the third: 2 F / 1.5 k, 26.7 nm to either side. Over the disk 1.45 F / k, 29 nm.
    assert!((24e-9..32e-9).contains(&rms_m), "{rms_m:e}");
}
