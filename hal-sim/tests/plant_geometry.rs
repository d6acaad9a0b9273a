//! The geometry of a machine as built, against poses and angles of two machines that were computed elsewhere, and its derivatives
//! against differences.

use std::collections::HashMap;

use hal_sim::machine::plant::{AXES, Imperfections, PivotGeometry, Plant, PlantParameters};

const LINES: [&str; 2] = [
    include_str!("../../kinematics/tests/data/built-lines.json"),
    include_str!("../../kinematics/tests/data/built-lines.csv"),
];
const ALL: [&str; 2] = [
    include_str!("../../kinematics/tests/data/built-all.json"),
    include_str!("../../kinematics/tests/data/built-all.csv"),
];

/// A machine of the data, lengths over its track radius, on a track of 1 m.
fn machine(json: &str) -> PlantParameters {
    let numbers: HashMap<String, f64> = serde_json::from_str(json).unwrap();
    let pivots = [0, 1, 2].map(|i| PivotGeometry {
        ring_centre_m: ["ax", "ay"].map(|name| numbers[&format!("{name}{i}")]),
        radius_error_m: numbers[&format!("dR{i}")],
        guide_error_rad: numbers[&format!("e{i}")],
        guide_offset_m: numbers[&format!("d{i}")],
        runout_m: [2, 3, 4, 5, 6]
            .map(|k| ["rc", "rs"].map(|name| numbers[&format!("{name}{k}_{i}")])),
        straightness_m: [2, 3, 4, 5, 6, 7, 8, 9].map(|k| numbers[&format!("S{k}_{i}")]),
    });
    PlantParameters {
        track_radius_m: 1.0,
        guide_range_m: [0.16, 1.84],
        pivots,
        imperfections: Imperfections {
            geometry: true,
            ..Imperfections::NONE
        },
        ..PlantParameters::REFERENCE
    }
}

#[test]
fn angles_and_places_of_built_machines_are_those_of_the_vectors() {
    for [json, csv] in [LINES, ALL] {
        let mut plant = Plant::new(machine(json));
        let mut worst = [0.0_f64; 2];
        let mut count = 0;
        for line in csv.lines().skip(1) {
            let fields: Vec<f64> = line
                .split(',')
                .map(|field| field.parse().unwrap())
                .collect();
            plant.set_pose_at_rest([fields[0], fields[1], fields[2]]);
            assert_eq!(plant.broken(), None);
            let (angles, rhos) = (plant.pivots_rad(), plant.rhos_m());
            for i in 0..AXES {
                worst[0] = worst[0].max((angles[i] - fields[3 + i]).abs());
                worst[1] = worst[1].max((rhos[i] - fields[9 + i]).abs());
            }
            count += 1;
        }
        println!(
            "{count} poses: angles {:.2e} rad, rho {:.2e}",
            worst[0], worst[1]
        );
        assert!(
            count > 100 && worst[0] < 1e-12 && worst[1] < 1e-12,
            "{worst:?}"
        );
    }
}

#[test]
fn the_reference_stage_is_the_machine_of_the_vectors() {
    let scaled = PlantParameters::REFERENCE
        .pivots
        .map(|pivot| pivot.scaled(10.0));
    for (ours, theirs) in scaled.iter().zip(machine(ALL[0]).pivots) {
        let numbers = |pivot: &PivotGeometry| {
            let mut numbers = vec![
                pivot.radius_error_m,
                pivot.guide_error_rad,
                pivot.guide_offset_m,
            ];
            numbers.extend(pivot.ring_centre_m);
            numbers.extend(pivot.runout_m.as_flattened());
            numbers.extend(pivot.straightness_m);
            numbers
        };
        for (a, b) in numbers(ours).into_iter().zip(numbers(&theirs)) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
    }
}

#[test]
fn rates_of_rings_are_the_derivatives_of_their_angles() {
    let mut plant = Plant::new(machine(ALL[0]));
    for pose in [[0.1, -0.3, 0.4], [-0.5, 0.5, -7.0], [0.0, 0.79, 2.0]] {
        plant.set_pose_at_rest(pose);
        let jacobian = plant.jacobian();
        for column in 0..3 {
            const H: f64 = 1e-6;
            let mut angles = [[0.0; AXES]; 2];
            for (angles, sign) in angles.iter_mut().zip([-1.0, 1.0]) {
                let mut moved = pose;
                moved[column] += sign * H;
                plant.set_pose_at_rest(moved);
                *angles = plant.pivots_rad();
            }
            for row in 0..AXES {
                let slope = (angles[1][row] - angles[0][row]) / (2.0 * H);
                assert!(
                    (slope - jacobian[(row, column)]).abs() < 1e-8,
                    "{slope} {jacobian}"
                );
            }
        }
    }
}
