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
