//! What several test files share: poses, other ways to the same results, and proptest's settings.
#![allow(dead_code, reason = "every test file uses its own part")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use kinematics::{Guide, Inverse, Pose, inverse};
use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed};

/// Fixed seed and number of cases, so that every run tests the same. Another seed: PROPTEST_RNG_SEED in the environment.
pub fn settings() -> Config {
    let fallback = 20_260_117;
    let seed = std::env::var("PROPTEST_RNG_SEED")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(fallback);
    println!("proptest seed {seed}");
    Config {
        cases: 2_000,
        rng_seed: RngSeed::Fixed(seed),
        rng_algorithm: RngAlgorithm::ChaCha,
        failure_persistence: None,
        ..Config::default()
    }
}

/// Poses with the centre up to `radius` from the track's centre, theta within `turns` turns.
pub fn poses(radius: f64, turns: f64) -> impl Strategy<Value = Pose<f64>> {
    let theta = -turns * TAU..turns * TAU;
    (0.0..radius, -PI..PI, theta).prop_map(|(r, direction, theta)| at(r, direction, theta))
}

/// A pose in polar coordinates.
pub fn at(r: f64, direction: f64, theta: f64) -> Pose<f64> {
    Pose {
        x: r * direction.cos(),
        y: r * direction.sin(),
        theta,
    }
}

pub fn solve(pose: &Pose<f64>) -> Inverse<f64> {
    inverse(pose).expect("a pose inside the track")
}

pub fn guides(pose: &Pose<f64>) -> [Guide<f64>; 3] {
    solve(pose).guides
}

/// Direction of guide `index` (0 to 2), straight from its definition.
pub fn guide_angle(theta: f64, index: usize) -> f64 {
    theta - PI / 6.0 + index as f64 * TAU / 3.0
}

/// The paper's direct position from single-turn pivots, with E of eq. 10 as given: the intersection of two Fermat
/// lines, each from a pivot to the outer vertex of the equilateral triangle on the other two.
pub fn fermat_centre(pivots: &[f64; 3], e: Matrix2<f64>) -> Vector2<f64> {
    let points = pivots.map(on_track);
    let line = |i: usize| {
        let (next, last) = (points[(i + 1) % 3], points[(i + 2) % 3]);
        let vertex = (next + last) / 2.0 + e * (next - last) * (3.0_f64.sqrt() / 2.0);
        (points[i], vertex - points[i])
    };
    let ((from_1, along_1), (from_2, along_2)) = (line(0), line(1));
    let steps = Matrix2::from_columns(&[along_1, -along_2])
        .lu()
        .solve(&(from_2 - from_1))
        .expect("lines that meet");
    from_1 + along_1 * steps[0]
}

/// Eq. 13, corrected: the orientation, within a turn, from the centre to pivot 2.
pub fn fermat_theta(pivots: &[f64; 3], centre: Vector2<f64>) -> f64 {
    let to_pivot_2 = on_track(pivots[1]) - centre;
    to_pivot_2.y.atan2(to_pivot_2.x) - FRAC_PI_2
}

/// E of eq. 10 as it has to be.
pub fn quarter_turn() -> Matrix2<f64> {
    Matrix2::new(0.0, -1.0, 1.0, 0.0)
}

fn on_track(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

/// Smallest difference between two angles modulo a turn.
pub fn turn_distance(a: f64, b: f64) -> f64 {
    let difference = (a - b).rem_euclid(TAU);
    difference.min(TAU - difference)
}
