//! Wrong zeros, from the torques of a body in closed form and of simulated machines.

mod machine;
mod tour;

use commissioning::platform::{PlatformError, Tour};
use commissioning::zero_errors;
use machine::unknown;
use tour::{BODY, EVALUATION, drive};

fn with_wrong_zeros(tour: &Tour, too_large_rad: [f64; 3]) -> Tour {
    let mut tour = tour.clone();
    for (angles, by) in tour.angle_rad.iter_mut().zip(too_large_rad) {
        angles.iter_mut().for_each(|angle| *angle += by);
    }
    tour
}

/// The largest that is wrong with what is found of these errors; their mean does not show.
fn off_rad(found: [f64; 3], truth: [f64; 3]) -> f64 {
    let mean = truth.iter().sum::<f64>() / 3.0;
    (found.iter().zip(truth))
        .map(|(found, truth)| (found - (truth - mean)).abs())
        .fold(0.0, f64::max)
}

const ERRORS: [[f64; 3]; 5] = [
    [0.0, 0.0, 0.0],
    [0.0175, 0.0, 0.0],
    [0.0, -0.1, 0.03],
    [0.3, 0.0, 0.0],
    // All alike: the machine is turned, and nothing else.
    [0.2, 0.2, 0.2],
];

#[test]
fn those_of_a_body_by_lagrange_are_found() {
    let tour = BODY.tour();
    for truth in ERRORS {
        let tours = [with_wrong_zeros(&tour, truth)];
        let found = zero_errors(&tours, &EVALUATION).expect("a tour");
        let off = off_rad(found.too_large_rad, truth);
        println!("{truth:?}: {off:.2e} rad off, {found:?}");
        assert!(off < MOST_OFF_LAGRANGE_RAD, "{truth:?}: {found:?}");
        assert!(found.deviation_rad < 1e-3);
    }
}

/// Torques of something else beside: told are what an uneven gear asks of its motor, what friction of a ring that creeps takes, and what two current sensors
/// are off.
#[derive(Clone, Copy, Debug, Default)]
struct Beside {
    gear_kg_m2_rad: f64,
    creeping_n_m: f64,
    gains: [f64; 2],
}

impl Beside {
    fn tour(&self) -> Tour {
        let mut tour = BODY.tour();
        let step_s = tour.step_s;
        for (i, torques) in tour.torque_n_m.iter_mut().enumerate() {
            let angles = &tour.angle_rad[i];
            let gear = |k: usize| (EVALUATION.gear_ratio * angles[k] + i as f64).sin();
            let gain = [0.0, self.gains[0], self.gains[1]][i];
            for k in 1..angles.len() - 1 {
                let bend = (gear(k + 1) - 2.0 * gear(k) + gear(k - 1)) / (step_s * step_s);
                let rate = (angles[k + 1] - angles[k - 1]) / (2.0 * step_s);
                torques[k] += self.gear_kg_m2_rad * bend;
                if rate.abs() < 0.1 {
                    torques[k] += self.creeping_n_m.copysign(rate);
                }
                torques[k] *= 1.0 + gain;
            }
        }
        tour
    }
}

#[test]
fn gears_creeping_rings_and_current_sensors_are_no_wrong_zeros() {
    let none = Beside::default();
    for beside in [
        Beside {
            gear_kg_m2_rad: 0.015 * 280e-6,
            ..none
        },
        Beside {
            creeping_n_m: 0.3,
            ..none
        },
        Beside {
            gains: [0.03, -0.02],
            ..none
        },
    ] {
        let found = zero_errors(&[beside.tour()], &EVALUATION).expect("a tour");
        let off = off_rad(found.too_large_rad, [0.0; 3]);
        println!("{beside:?}: {off:.2e} rad off");
        assert!(off < MOST_OFF_LAGRANGE_RAD, "{beside:?}: {found:?}");
    }
}

/// What smoothing a tour that turns costs, and a tenth more.
const MOST_OFF_LAGRANGE_RAD: f64 = 2.6e-5;
/// The worst of the machines tried here, and a tenth more. A single tour repeats no angle, and gears, motors and frames that are not as drawn have their
/// part, which the deviation that is told does not know.
const MOST_OFF_RAD: f64 = 8.7e-3;

#[test]
fn those_of_unknown_machines_are_found() {
    let mut worst = 0.0_f64;
    for seed in 0..4 {
        let tour = drive(&unknown(seed), 9.0);
        for truth in ERRORS {
            let tours = [with_wrong_zeros(&tour, truth)];
            let found = zero_errors(&tours, &EVALUATION).expect("a tour");
            let off = off_rad(found.too_large_rad, truth);
            println!(
                "{seed}, {truth:?}: {:.1} mrad off, +-{:.1}",
                1e3 * off,
                1e3 * found.deviation_rad
            );
            worst = worst.max(off);
        }
    }
    assert!(worst < MOST_OFF_RAD, "{worst}");
}

#[test]
fn angles_that_are_no_pose_are_refused() {
    let mut tour = BODY.tour();
    tour.angle_rad[1] = tour.angle_rad[0].clone();
    assert!(matches!(
        zero_errors(&[tour], &EVALUATION),
        Err(PlatformError::NoPose { .. } | PlatformError::Condition { .. })
    ));
}
