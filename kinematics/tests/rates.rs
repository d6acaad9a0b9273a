//! Rates, accelerations, the Jacobian and its inverse: against finite differences and the paper's matrices.

#![allow(clippy::needless_range_loop, reason = "several arrays side by side")]

mod common;

use std::f64::consts::{PI, TAU};

use common::*;
use kinematics::{
    Acceleration, Guide, Pose, Twist, dexterity, direct_rates, jacobian, jacobian_inverse,
    pivot_accelerations, pivot_motion, pivot_rates, worst_rate_per_rotation, worst_rate_per_speed,
};
use nalgebra::{Matrix3, RowVector3, Vector3};
use proptest::prelude::*;

/// Truncation of a central difference goes as the square of its step, rounding as one over it.
const STEP_S: f64 = 1e-5;

fn twists() -> impl Strategy<Value = Twist<f64>> {
    (-2.0..2.0, -2.0..2.0, -6.0..6.0).prop_map(|(x, y, theta)| Twist { x, y, theta })
}

fn accelerations() -> impl Strategy<Value = Acceleration<f64>> {
    (-9.0..9.0, -9.0..9.0, -9.0..9.0).prop_map(|(x, y, theta)| Acceleration { x, y, theta })
}

/// The pose and twist a time `t_s` later at constant acceleration.
fn moved(
    pose: &Pose<f64>,
    twist: &Twist<f64>,
    acceleration: &Acceleration<f64>,
    t_s: f64,
) -> (Pose<f64>, Twist<f64>) {
    let place = |p: f64, v: f64, a: f64| p + t_s * (v + t_s * a / 2.0);
    let later = Pose {
        x: place(pose.x, twist.x, acceleration.x),
        y: place(pose.y, twist.y, acceleration.y),
        theta: place(pose.theta, twist.theta, acceleration.theta),
    };
    let twist = Twist {
        x: twist.x + t_s * acceleration.x,
        y: twist.y + t_s * acceleration.y,
        theta: twist.theta + t_s * acceleration.theta,
    };
    (later, twist)
}

/// The paper's matrices, from the pivots and directions: Lambda and Z.
fn lambda_and_z(pose: &Pose<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let pivots = solve(pose).pivots;
    let row = |i: usize| {
        let direction = guide_angle(pose.theta, i);
        // Crosswise and lengthwise from C to the pivot, not through the crate's own rho.
        let rho = (pivots[i].cos() - pose.x) * direction.cos()
            + (pivots[i].sin() - pose.y) * direction.sin();
        RowVector3::new(-direction.sin(), direction.cos(), rho)
    };
    let cosine = |i: usize| (pivots[i] - guide_angle(pose.theta, i)).cos();
    let lambda = Matrix3::from_diagonal(&Vector3::new(cosine(0), cosine(1), cosine(2)));
    (lambda, Matrix3::from_rows(&[row(0), row(1), row(2)]))
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn rates_are_differences_of_pivots(pose in poses(0.8, 1.0), twist in twists()) {
        let at_rest = Acceleration::default();
        let pivots = |t_s: f64| solve(&moved(&pose, &twist, &at_rest, t_s).0).pivots;
        let (after, before) = (pivots(STEP_S), pivots(-STEP_S));
        let rates = pivot_rates(&guides(&pose), &twist);
        for i in 0..3 {
            let difference = (after[i] - before[i]) / (2.0 * STEP_S);
            prop_assert!((rates[i] - difference).abs() < 2e-8, "{} {difference}", rates[i]);
        }
    }

    #[test]
    fn accelerations_are_differences_of_rates(
        pose in poses(0.8, 1.0), twist in twists(), acceleration in accelerations()
    ) {
        let rates = |t_s: f64| {
            let (pose, twist) = moved(&pose, &twist, &acceleration, t_s);
            pivot_rates(&guides(&pose), &twist)
        };
        let (after, before) = (rates(STEP_S), rates(-STEP_S));
        let got = pivot_accelerations(&guides(&pose), &twist, &acceleration);
        for i in 0..3 {
            let difference = (after[i] - before[i]) / (2.0 * STEP_S);
            let tolerance = 3e-7 * (1.0 + got[i].abs());
            prop_assert!((got[i] - difference).abs() < tolerance, "{} {difference}", got[i]);
        }
    }

    #[test]
    fn motion_together_is_rates_and_accelerations(
        pose in poses(0.8, 1.0), twist in twists(), acceleration in accelerations()
    ) {
        let guides = guides(&pose);
        let motion = pivot_motion(&guides, &twist, &acceleration);
        let rates = pivot_rates(&guides, &twist);
        for i in 0..3 {
            prop_assert!((motion.rates[i] - rates[i]).abs() < 1e-14);
        }
        prop_assert_eq!(motion.accelerations, pivot_accelerations(&guides, &twist, &acceleration));
    }

    #[test]
    fn jacobian_is_lambda_inverse_times_z(pose in poses(0.9, 1.0)) {
        let (lambda, z) = lambda_and_z(&pose);
        let inverse_lambda = lambda.try_inverse().expect("cosines above zero");
        prop_assert!((jacobian(&guides(&pose)) - inverse_lambda * z).amax() < 1e-14);
    }

    #[test]
    fn jacobian_maps_twists_to_rates(pose in poses(0.9, 1.0), twist in twists()) {
        let guides = guides(&pose);
        let rates = jacobian(&guides) * Vector3::new(twist.x, twist.y, twist.theta);
        prop_assert!((rates - Vector3::from(pivot_rates(&guides, &twist))).amax() < 1e-14);
    }

    #[test]
    fn jacobian_inverse_is_one(pose in poses(0.99, 1.0)) {
        let guides = guides(&pose);
        let product = jacobian(&guides) * jacobian_inverse(&guides);
        prop_assert!((product - Matrix3::identity()).amax() < 3e-15);
    }

    #[test]
    fn a_twist_comes_back(pose in poses(0.95, 1.0), twist in twists()) {
        let guides = guides(&pose);
        let back = direct_rates(&guides, &pivot_rates(&guides, &twist));
        prop_assert!((back.x - twist.x).abs() < 6e-15);
        prop_assert!((back.y - twist.y).abs() < 6e-15);
        prop_assert!((back.theta - twist.theta).abs() < 6e-15);
    }

    /// What makes the inverse exist at every pose inside the track.
    #[test]
    fn guide_lengths_sum_to_sqrt_3_at_least(pose in poses(1.0, 1.0)) {
        let total: f64 = guides(&pose).iter().map(Guide::rho).sum();
        prop_assert!(total > 3.0_f64.sqrt() - 1e-12, "{total}");
    }

    /// The worst rates bound every rate.
    #[test]
    fn no_rate_is_worse_than_the_worst(r in 0.0..0.95, direction in -PI..PI, theta in -PI..PI, heading in -PI..PI) {
        let guides = guides(&at(r, direction, theta));
        let along = Twist { x: heading.cos(), y: heading.sin(), theta: 0.0 };
        let turning = Twist { theta: 1.0, ..Twist::default() };
        for i in 0..3 {
            prop_assert!(pivot_rates(&guides, &along)[i].abs() <= worst_rate_per_speed(r) + 1e-12);
            prop_assert!(pivot_rates(&guides, &turning)[i].abs() <= worst_rate_per_rotation(r) + 1e-12);
        }
    }

    #[test]
    fn f32_rates_are_those_of_f64(pose in poses(0.8, 0.5), twist in twists()) {
        let guides = guides(&pose);
        let cast = Twist { x: twist.x as f32, y: twist.y as f32, theta: twist.theta as f32 };
        let single = pivot_rates(&guides.map(|guide| guide.map(|v| v as f32)), &cast);
        let double = pivot_rates(&guides, &twist);
        for i in 0..3 {
            prop_assert!((f64::from(single[i]) - double[i]).abs() < 3e-6);
        }
    }
}

/// The worst rates are reached: across a guide with the centre beside the track's, and along the track.
#[test]
fn the_worst_rates_are_reached() {
    for r in [0.3, 0.8, 0.95] {
        // Guide 2 points along y at theta = 0: C at (r, 0) is r off its line, C at (0, -r) is 1 + r from its pivot.
        let beside = guides(&at(r, 0.0, 0.0));
        let across = Twist {
            x: 1.0,
            ..Twist::default()
        };
        let rate = pivot_rates(&beside, &across)[1].abs();
        assert!((rate - worst_rate_per_speed(r)).abs() < 1e-15);
        let below = guides(&at(r, -PI / 2.0, 0.0));
        let turning = Twist {
            theta: 1.0,
            ..Twist::default()
        };
        let rate = pivot_rates(&below, &turning)[1].abs();
        assert!((rate - worst_rate_per_rotation(r)).abs() < 1e-15);
    }
}

#[test]
fn dexterity_at_the_centre() {
    let centre = dexterity(&guides(&at(0.0, 0.0, 0.3)));
    assert!((centre - 3.0 / 10.0_f64.sqrt()).abs() < 3e-16);
}

#[test]
fn dexterity_on_the_rim_depends_on_the_direction() {
    const STEPS: usize = 3_600;
    let on_rim = (0..STEPS).map(|step| {
        let direction = TAU * step as f64 / STEPS as f64;
        dexterity(&guides(&at(0.8, direction, 0.0)))
    });
    let (lowest, highest) = on_rim.fold((f64::MAX, f64::MIN), |(low, high), xi| {
        (low.min(xi), high.max(xi))
    });
    assert!((lowest - 0.7757).abs() < 5e-5, "{lowest}");
    assert!((highest - 0.8956).abs() < 5e-5, "{highest}");
}
