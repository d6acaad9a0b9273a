//! 400 poses with pivots, guide lengths and dexterity from 50-digit arithmetic.

mod common;

use kinematics::{Pose, Real, dexterity, direct, inverse};

const CSV: &str = include_str!("data/kinematics-r0.8.csv");

struct Vector {
    pose: Pose<f64>,
    pivots: [f64; 3],
    rho: [f64; 3],
    dexterity: f64,
}

fn vectors() -> Vec<Vector> {
    let parse = |line: &str| {
        let fields: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().expect("a number"))
            .collect();
        let [x, y, theta, p1, p2, p3, r1, r2, r3, dexterity] = fields[..] else {
            panic!("ten fields in {line}");
        };
        Vector {
            pose: Pose { x, y, theta },
            pivots: [p1, p2, p3],
            rho: [r1, r2, r3],
            dexterity,
        }
    };
    let vectors: Vec<_> = CSV.lines().skip(1).map(parse).collect();
    assert_eq!(vectors.len(), 400);
    vectors
}

/// An angle beyond 1 rad is compared relative to its size: 1 ulp of 18 rad alone is 3.6e-15.
fn angle_error(got: f64, want: f64) -> f64 {
    (got - want).abs() / want.abs().max(1.0)
}

/// Worst errors over all vectors with the arithmetic done in `T`: pivots, rho, dexterity, and the direct solution's
/// centre and theta.
fn worst_errors<T: Real>() -> [f64; 5] {
    let mut worst = [0.0_f64; 5];
    let mut note = |index: usize, error: f64| {
        assert!(!error.is_nan());
        worst[index] = worst[index].max(error);
    };
    for vector in vectors() {
        let Pose { x, y, theta } = vector.pose;
        let pose = Pose {
            x: T::from_f64(x),
            y: T::from_f64(y),
            theta: T::from_f64(theta),
        };
        let solved = inverse(&pose).expect("inside the track");
        for i in 0..3 {
            note(0, angle_error(solved.pivots[i].to_f64(), vector.pivots[i]));
            note(1, (solved.guides[i].rho().to_f64() - vector.rho[i]).abs());
        }
        note(
            2,
            (dexterity(&solved.guides).to_f64() - vector.dexterity).abs(),
        );
        let back = direct::<T>(&vector.pivots.map(T::from_f64)).expect("a feasible triangle");
        note(
            3,
            (back.x.to_f64() - x).abs().max((back.y.to_f64() - y).abs()),
        );
        note(4, angle_error(back.theta.to_f64(), theta));
    }
    println!("pivots, rho, dexterity, centre, theta: {worst:?}");
    worst
}

#[test]
fn f64_agrees_to_3e_15() {
    let worst = worst_errors::<f64>();
    assert!(worst.iter().all(|&error| error <= 3e-15), "{worst:?}");
}

/// f32 rounds its input too: half an ulp of 20 rad is 1e-6 rad.
#[test]
fn f32_agrees_to_1_2e_6() {
    let worst = worst_errors::<f32>();
    assert!(worst.iter().all(|&error| error <= 1.2e-6), "{worst:?}");
}
