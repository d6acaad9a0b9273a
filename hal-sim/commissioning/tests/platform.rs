//! What simulated machines carry, from a tour; and a body in closed form.

mod machine;
mod tour;

use commissioning::platform::{Platform, PlatformError, platform};
use machine::unknown;
use std::f64::consts::TAU;
use tour::{BODY, Body, EVALUATION, drive, pivots};

#[test]
fn what_unknown_machines_carry() {
    let mut off = [const { Vec::new() }; 5];
    for seed in 0..4 {
        let parameters = unknown(seed);
        let tour = drive(&parameters, 9.0);
        let found = platform(&[tour], &EVALUATION).expect("a platform");
        let plant = &parameters.plant;
        let payload = &plant.payload;
        let mass = plant.platform_mass_kg + payload.mass_kg;
        let inertia = plant.platform_inertia_kg_m2
            + payload.inertia_kg_m2
            + payload.mass_kg * payload.eccentricity_m.powi(2);
        // Torques are what the current sensors make of them.
        let told = parameters.analog.current_gain.iter().sum::<f64>() / 3.0;
        let (sin, cos) = payload.direction_rad.sin_cos();
        let centre = [cos, sin].map(|part| part * payload.mass_kg * payload.eccentricity_m / mass);
        off[0].push((found.mass_kg / mass / told - 1.0).abs());
        off[1].push((found.inertia_kg_m2 / inertia / told - 1.0).abs());
        off[2].push(
            (found.drive_inertia / (plant.motor_inertia_kg_m2 + plant.ring_inertia_kg_m2) / told
                - 1.0)
                .abs(),
        );
        let [x, y] = found.moment_kg_m.map(|moment| moment / found.mass_kg);
        off[3].push(1e3 * (x - centre[0]).hypot(y - centre[1]));
        off[4].push((found.carriages.coulomb_n / plant.guide_friction.coulomb / told - 1.0).abs());
    }
    let figures = [
        ("mass", 0.0019, 0.0021),
        ("inertia", 0.0079, 0.0125),
        ("motor and ring", 0.0028, 0.0032),
        ("centre of mass, mm", 0.313, 0.627),
        ("friction of a carriage", 0.0017, 0.0094),
    ];
    for ((name, median, worst), off) in figures.into_iter().zip(&mut off) {
        off.sort_by(f64::total_cmp);
        println!(
            "{name}: median {:.4}, worst {:.4}",
            off[off.len() / 2],
            off[off.len() - 1]
        );
        assert!(
            off[off.len() / 2] < median && off[off.len() - 1] < worst,
            "{name}"
        );
    }
}

fn is_right(found: &Platform) {
    let Body {
        mass_kg,
        centre_m: [x, y],
        inertia_kg_m2,
        ring_kg_m2,
    } = BODY;
    let about_centre = inertia_kg_m2 + mass_kg * (x * x + y * y);
    assert!((found.mass_kg / mass_kg - 1.0).abs() < 2e-3, "{found:?}");
    // Smoothing a tour that turns costs a little.
    assert!(
        (found.inertia_kg_m2 / about_centre - 1.0).abs() < 4e-3,
        "{found:?}"
    );
    assert!(
        (found.drive_inertia / ring_kg_m2 - 1.0).abs() < 2e-3,
        "{found:?}"
    );
    assert!(
        (found.moment_kg_m[0] / (mass_kg * x) - 1.0).abs() < 1e-2,
        "{found:?}"
    );
    assert!(
        (found.moment_kg_m[1] / (mass_kg * y) - 1.0).abs() < 1e-2,
        "{found:?}"
    );
    assert!(found.carriages.coulomb_n.abs() < 0.01 && found.friction[0].abs() < 1e-3);
}

#[test]
fn a_body_by_lagrange_is_found_again() {
    let tour = BODY.tour();
    is_right(&platform(&[tour], &EVALUATION).expect("a platform"));
}

#[test]
fn tours_that_tell_nothing_are_refused() {
    let tour = BODY.tour();
    let mut short = tour.clone();
    short.torque_n_m[1].pop();
    assert_eq!(platform(&[short], &EVALUATION), Err(PlatformError::Lengths));
    // Always in the same place: nothing moves, and nothing follows.
    let mut still = tour.clone();
    for angles in &mut still.angle_rad {
        let first = angles[0];
        angles.fill(first);
    }
    assert!(matches!(
        platform(&[still], &EVALUATION),
        Err(PlatformError::Condition { .. })
    ));
    // Shaken in the middle alone: mass, inertia and rings are the same there.
    let mut middle = tour.clone();
    for (sample, time) in (1_200..16_000).map(|k| f64::from(k) * 5e-4).enumerate() {
        let shake = |hz: f64| (TAU * hz * time).sin();
        let angles = pivots([
            0.005 * shake(3.1),
            0.005 * shake(2.3),
            2.0 * time + 0.2 * shake(3.7),
        ]);
        for (all, angle) in middle.angle_rad.iter_mut().zip(angles) {
            all[sample] = angle;
        }
    }
    let refused = platform(&[middle], &EVALUATION);
    assert!(
        matches!(refused, Err(PlatformError::Condition { condition }) if condition < 1e6),
        "{refused:?}"
    );
    // A pivot whose torque is told with the wrong sign.
    let mut reversed = tour.clone();
    reversed.torque_n_m[2]
        .iter_mut()
        .for_each(|torque| *torque = -*torque);
    assert!(matches!(
        platform(&[reversed], &EVALUATION),
        Err(PlatformError::Gain { .. })
    ));
}
