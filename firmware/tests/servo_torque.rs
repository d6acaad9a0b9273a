//! Torque feedforward against the Lagrangian of the carried body, built here from its kinetic energy alone.

mod proptest_settings;

use firmware::control::servo::{Presliding, ServoConfig, friction_torques, platform_torques};
use firmware::parameters::{Parameters, Platform};
use kinematics::{Acceleration, Pose, Twist, in_platform_axes, inverse};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::PI;

const RADIUS_M: f64 = 0.1;

/// Kinetic energy (J) of platform and payload, in SI units: each a mass point at its centre of mass, and an inertia.
fn energy(platform: &Platform, [_, _, theta]: [f64; 3], [x, y, turning]: [f64; 3]) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let [a, b] = platform.payload_centre_mm.map(|mm| mm * 1e-3);
    let arm = [a * cos - b * sin, a * sin + b * cos];
    let speed_squared =
        |arm: [f64; 2]| (x - turning * arm[1]).powi(2) + (y + turning * arm[0]).powi(2);
    let inertia = platform.inertia_kg_m2 + platform.payload_inertia_kg_m2;
    0.5 * (platform.mass_kg * speed_squared([0.0; 2])
        + platform.payload_kg * speed_squared(arm)
        + inertia * turning * turning)
}

fn nudged(mut at: [f64; 3], k: usize, by: f64) -> [f64; 3] {
    at[k] += by;
    at
}

/// Momentum that belongs to coordinate k. The energy is quadratic in the velocity: a central difference is exact.
fn momentum(platform: &Platform, q: [f64; 3], v: [f64; 3], k: usize) -> f64 {
    energy(platform, q, nudged(v, k, 0.5)) - energy(platform, q, nudged(v, k, -0.5))
}

/// Generalised force of Lagrange's equation: d/dt (dT/dv_k) - dT/dq_k, in N, N and N m.
fn force(platform: &Platform, q: [f64; 3], v: [f64; 3], a: [f64; 3], k: usize) -> f64 {
    const STEP: f64 = 1e-4;
    let later = |t: f64| {
        let q = [0, 1, 2].map(|i| q[i] + v[i] * t + a[i] * t * t / 2.0);
        momentum(platform, q, [0, 1, 2].map(|i| v[i] + a[i] * t), k)
    };
    let change = (later(STEP) - later(-STEP)) / (2.0 * STEP);
    let by_place = (energy(platform, nudged(q, k, STEP), v)
        - energy(platform, nudged(q, k, -STEP), v))
        / (2.0 * STEP);
    change - by_place
}

/// How pivot i turns (rad) when coordinate k (m, m, rad) changes: differences of the inverse solution.
fn pivot_per(q: [f64; 3], k: usize) -> [f64; 3] {
    const STEP: f64 = 1e-5;
    let pivots = |[x, y, theta]: [f64; 3]| {
        inverse(&Pose {
            x: x / RADIUS_M,
            y: y / RADIUS_M,
            theta,
        })
        .expect("inside the track")
        .pivots
    };
    let step = if k < 2 { STEP * RADIUS_M } else { STEP };
    let (more, less) = (pivots(nudged(q, k, step)), pivots(nudged(q, k, -step)));
    [0, 1, 2].map(|i| (more[i] - less[i]) / (2.0 * step))
}

fn parameters(payload_kg: f64, payload_centre_mm: [f64; 2]) -> Parameters {
    Parameters {
        platform: Platform {
            payload_kg,
            payload_inertia_kg_m2: 0.002 * payload_kg,
            payload_centre_mm,
            ..Parameters::REFERENCE.platform
        },
        ..Parameters::REFERENCE
    }
}

prop_compose! {
    fn states()(
        r in 0.0..0.08_f64, direction in -PI..PI, theta in -PI..PI,
        v in [-0.2..0.2_f64, -0.2..0.2, -6.3..6.3], a in [-4.0..4.0_f64, -4.0..4.0, -126.0..126.0],
    ) -> ([f64; 3], [f64; 3], [f64; 3]) {
        ([r * direction.cos(), r * direction.sin(), theta], v, a)
    }
}

proptest! {
    #![proptest_config(settings(2_000))]

    /// Virtual work: for every coordinate the pivots' torques do what the body's force does.
    #[test]
    fn torques_do_the_work_of_the_force(
        (q, v, a) in states(),
        payload_kg in prop_oneof![Just(0.0), 0.0..5.0_f64],
        centre_mm in [-40.0..40.0_f64, -40.0..40.0],
    ) {
        let parameters = parameters(payload_kg, centre_mm);
        let body = ServoConfig::new(&parameters).body;
        let pose = Pose { x: q[0] / RADIUS_M, y: q[1] / RADIUS_M, theta: q[2] };
        let guides = inverse(&pose).unwrap().guides.map(|guide| guide.map(|value| value as f32));
        let twist = Twist { x: (v[0] / RADIUS_M) as f32, y: (v[1] / RADIUS_M) as f32, theta: v[2] as f32 };
        let acceleration = Acceleration { x: (a[0] / RADIUS_M) as f32, y: (a[1] / RADIUS_M) as f32, theta: a[2] as f32 };
        let (twist, acceleration) = in_platform_axes(&guides, &twist, &acceleration);
        let torques = platform_torques(&body, &guides, &twist, &acceleration).map(f64::from);
        for k in 0..3 {
            let column = pivot_per(q, k);
            let work: f64 = (0..3).map(|i| torques[i] * column[i]).sum();
            let wanted = force(&parameters.platform, q, v, a, k);
            // Forces reach 60 N, torques 5 N m; an f32 keeps seven digits of what they are made of.
            let unit = if k < 2 { 1.0 / RADIUS_M } else { 1.0 };
            prop_assert!((work - wanted).abs() < 2.2e-6 * unit, "coordinate {k}: {work} for {wanted}");
        }
    }

    /// And against friction of the carriages: what the pivots do is what is lost on the guides, f rho' each.
    #[test]
    fn torques_do_the_work_of_the_friction(
        (q, v, _) in states(),
        friction in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    ) {
        let lengths = |t: f64| {
            let at = |k: usize, unit: f64| (q[k] + t * v[k]) / unit;
            let pose = Pose { x: at(0, RADIUS_M), y: at(1, RADIUS_M), theta: at(2, 1.0) };
            inverse(&pose).unwrap().guides.map(|guide| guide.rho())
        };
        let guides = inverse(&Pose { x: q[0] / RADIUS_M, y: q[1] / RADIUS_M, theta: q[2] }).unwrap().guides;
        let [along, rho, cosines] = [friction, guides.map(|guide| guide.rho()), guides.map(|guide| guide.cosine)]
            .map(|values| values.map(|value: f64| value as f32));
        let [_, torques] = friction_torques(&along, &rho, &cosines);
        let torques = torques.map(f64::from);
        let done: f64 = (0..3).map(|i| torques[i] * (0..3).map(|k| pivot_per(q, k)[i] * v[k]).sum::<f64>()).sum();
        let (before, after) = (lengths(-1e-6), lengths(1e-6));
        let lost: f64 = (0..3).map(|i| friction[i] * (after[i] - before[i]) / 2e-6).sum();
        prop_assert!((done - lost).abs() < 1e-5, "{done} for {lost}");
    }

    #[test]
    fn presliding_stays_within_the_contact(ways in prop::collection::vec(prop_oneof![-1e-3..1e-3_f32, -3.0..3.0_f32, -1e6..1e6_f32], 1..200)) {
        let mut contact = Presliding::default();
        for way in ways {
            let before = contact.advance(0.0);
            let after = contact.advance(way);
            prop_assert!((-1.0..=1.0).contains(&after), "{after}");
            // It does not go against the way, a rounding aside.
            prop_assert!((after - before) * way.signum() >= -2e-7);
        }
    }
}

#[test]
fn presliding_follows_dahl() {
    // z = 1 - exp(-s) from rest; after a reversal z = -1 + (1 + z0) exp(-s). Steps of a thousandth.
    let mut contact = Presliding::default();
    let mut deflection = 0.0;
    for _ in 0..1_500 {
        deflection = contact.advance(1e-3);
    }
    let z0 = 1.0 - (-1.5_f32).exp();
    assert!((deflection - z0).abs() < 2.2e-4, "{deflection} for {z0}");
    for _ in 0..700 {
        deflection = contact.advance(-1e-3);
    }
    let z1 = -1.0 + (1.0 + z0) * (-0.7_f32).exp();
    assert!((deflection - z1).abs() < 2.3e-4, "{deflection} for {z1}");
    for _ in 0..20_000 {
        deflection = contact.advance(-1e-3);
    }
    // As near as a step of a thousandth can be told from none in an f32.
    assert!((deflection + 1.0).abs() < 9.9e-5, "{deflection}");
}

#[test]
fn at_rest_nothing_is_asked_for() {
    let parameters = parameters(3.0, [20.0, -30.0]);
    let body = ServoConfig::new(&parameters).body;
    let guides = inverse(&Pose {
        x: 0.5,
        y: 0.2,
        theta: 1.0,
    })
    .unwrap()
    .guides;
    let guides = guides.map(|guide| guide.map(|value: f64| value as f32));
    let torques = platform_torques(&body, &guides, &Twist::default(), &Acceleration::default());
    assert_eq!(torques, [0.0; 3]);
}
