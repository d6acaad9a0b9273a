//! Lines about another point than the platform centre: refused when the platform centre would leave the usable disk on
//! its way, and only then.

mod motion_bench;

use firmware::motion::{Constraints, Position, Refusal, check_line, plan_line};
use motion_bench::*;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Two positions of a point of the platform that have the platform centre inside the disk, and the constraints for
/// them.
fn lines() -> impl Strategy<Value = (Position, Position, Constraints)> {
    let place = || (0.0..0.8_f64, -PI..PI, -0.7..0.7_f64);
    // Half of them long and about a point not far off: they go through the middle, and may leave the disk near either
    // end.
    let arm = prop_oneof![0.0..0.7_f64, 0.05..0.25_f64];
    let exponent = prop_oneof![Just(0.0), -2.0..=0.0_f64];
    ((arm, -PI..PI), place(), place(), exponent).prop_map(|((arm, direction), a, b, exponent)| {
        let centre = [arm * direction.cos(), arm * direction.sin()];
        let from = point(a, centre);
        let to = point(b, centre);
        let fraction = 10_f64.powf(exponent);
        let to = [0, 1, 2].map(|i| from[i] + ((to[i] - from[i]) as f64 * fraction) as i64);
        (
            from,
            to,
            Constraints {
                rotation_centre: centre,
                ..CONSTRAINTS
            },
        )
    })
}

/// Position of the moved point with the platform centre at radius r in a direction.
fn point((r, direction, turns): (f64, f64, f64), [p, q]: [f64; 2]) -> Position {
    let (sin, cos) = (turns * TAU).sin_cos();
    let x = r * direction.cos() + cos * p - sin * q;
    let y = r * direction.sin() + sin * p + cos * q;
    [x, y, turns].map(|value| (value * UNIT) as i64)
}

/// How far from the track's centre the platform centre is at a fraction of the way.
fn radius(from: &Position, to: &Position, fraction: f64, [p, q]: [f64; 2]) -> f64 {
    let [x, y, turns] =
        [0, 1, 2].map(|i| (from[i] as f64 + (to[i] - from[i]) as f64 * fraction) / UNIT);
    let (sin, cos) = (turns.fract() * TAU).sin_cos();
    (x - cos * p + sin * q).hypot(y - sin * p - cos * q)
}

/// The furthest on the way.
fn furthest(from: &Position, to: &Position, centre: [f64; 2]) -> f64 {
    let places = 8_000;
    (0..=places)
        .map(|k| radius(from, to, f64::from(k) / f64::from(places), centre))
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(settings(1500))]

    #[test]
    fn what_leaves_the_disk_is_refused_and_nothing_else((from, to, constraints) in lines()) {
        let furthest = furthest(&from, &to, constraints.rotation_centre);
        let answer = check_line(&from, &to, &constraints);
        // The sampling here and the rim there: a hair's breadth is left open.
        if furthest > 0.8 + 2e-6 {
            prop_assert!(matches!(answer, Err(Refusal::LeavesDisk | Refusal::OutsideDisk)), "{answer:?}");
        } else if furthest < 0.8 - 2e-6 {
            prop_assert_eq!(answer, Ok(()));
        }
        prop_assert_eq!(plan_line(1, from, to, &constraints).err(), answer.err());
    }

    #[test]
    fn many_turns_about_a_point_leave_the_disk_where_both_lengths_add_up(turns in 1.02..10_000.0_f64, r in 0.0..0.79_f64, arm in 0.0..0.79_f64) {
        let constraints = Constraints { rotation_centre: [0.0, arm], ..CONSTRAINTS };
        // The arm points inwards at the start, so that the platform centre is inside.
        let from = at(r * 100.0, 0.0, -0.25);
        let to = [from[0], from[1], from[2] + (turns * UNIT) as i64];
        let start = radius(&from, &to, 0.0, constraints.rotation_centre);
        prop_assume!(start < 0.799 && radius(&from, &to, 1.0, constraints.rotation_centre) < 0.799);
        prop_assume!((r + arm - 0.8).abs() > 1e-5);
        let answer = check_line(&from, &to, &constraints);
        prop_assert_eq!(answer.is_err(), r + arm > 0.8, "{:?}", answer);
    }

    #[test]
    fn a_target_outside_the_bounds_is_refused((from, to) in (positions(2.0), positions(2.0)), axis in 0..3_usize, above in any::<bool>()) {
        let mut constraints = CONSTRAINTS;
        let inside = [to[axis] - 1, to[axis] + 1];
        constraints.bounds[axis] = inside;
        prop_assert_eq!(check_line(&from, &to, &constraints), Ok(()));
        constraints.bounds[axis] = if above { [to[axis] + 1, to[axis] + 2] } else { [to[axis] - 2, to[axis] - 1] };
        prop_assert_eq!(check_line(&from, &to, &constraints), Err(Refusal::OutOfBounds { axis }));
    }
}

/// Also near the edge, where some orientations are not possible.
#[test]
fn where_it_is_it_can_stay() {
    let constraints = Constraints {
        rotation_centre: [0.4, 0.0],
        ..CONSTRAINTS
    };
    let here = point((0.7, 0.3, 0.1), constraints.rotation_centre);
    assert_eq!(check_line(&here, &here, &constraints), Ok(()));
    assert_eq!(plan_line(1, here, here, &constraints).unwrap().ticks(), 0);
}

#[test]
fn a_line_that_leaves_the_disk_half_way_is_refused() {
    // At the start and at the end the platform centre is 10 mm from the track's, half a turn from there 90 mm.
    let constraints = Constraints {
        rotation_centre: [0.4, 0.0],
        ..CONSTRAINTS
    };
    let (from, to) = (at(0.0, 50.0, 0.25), at(0.0, 50.0, 1.25));
    assert_eq!(
        check_line(&from, &to, &constraints),
        Err(Refusal::LeavesDisk)
    );
}
