//! Inverse and direct position: against each other, against the paper's construction, over symmetry and turns.

mod common;

use std::f64::consts::{PI, TAU};

use common::*;
use kinematics::{
    DirectError, Geometry, Infeasible, InverseError, Pose, direct, feasibility, inverse, margins,
};
use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn a_pose_comes_back(pose in poses(0.95, 3.0)) {
        let back = direct::<f64>(&solve(&pose).pivots).expect("a feasible triangle");
        prop_assert!((back.x - pose.x).abs() < 2e-14, "{back:?}");
        prop_assert!((back.y - pose.y).abs() < 2e-14, "{back:?}");
        prop_assert!((back.theta - pose.theta).abs() < 2e-14, "{back:?}");
    }

    /// Any pivots on the track: either they come back from the pose they set, or there is an error.
    #[test]
    fn pivots_come_back(pivots in prop::array::uniform3(-PI..PI), turns in -9_i32..9) {
        // In order on the track, within one turn from the first.
        let mut pivots = pivots;
        pivots.sort_by(f64::total_cmp);
        let pivots = pivots.map(|pivot| pivot + f64::from(turns) * TAU);
        let gaps = [pivots[1] - pivots[0], pivots[2] - pivots[1], TAU + pivots[0] - pivots[2]];
        // An inscribed angle is half of the gap it looks at: the one over 120 deg faces a gap over 240 deg.
        let facing = [2, 0, 1];
        let widest = (0..3).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b])).unwrap_or(0);
        prop_assume!((gaps[widest] - 2.0 * TAU / 3.0).abs() > 1e-3);
        match direct::<f64>(&pivots) {
            Ok(pose) => {
                prop_assert!(gaps[widest] < 2.0 * TAU / 3.0);
                let back = solve(&pose).pivots;
                for (got, want) in back.iter().zip(&pivots) {
                    prop_assert!((got - want).abs() < 1e-9, "{back:?} from {pivots:?}");
                }
            }
            Err(DirectError::ReversedGuide { guide }) => {
                prop_assert!(gaps[widest] > 2.0 * TAU / 3.0);
                prop_assert_eq!(guide, facing[widest] + 1);
            }
            Err(error) => prop_assert!(false, "{error:?}"),
        }
    }

    #[test]
    fn pivots_lie_where_the_guides_end(pose in poses(0.99, 2.0)) {
        let solved = solve(&pose);
        for i in 0..3 {
            let direction = guide_angle(pose.theta, i);
            let rho = solved.guides[i].rho();
            prop_assert!(rho > 0.0);
            prop_assert!((pose.x + rho * direction.cos() - solved.pivots[i].cos()).abs() < 1e-14);
            prop_assert!((pose.y + rho * direction.sin() - solved.pivots[i].sin()).abs() < 1e-14);
            prop_assert!((solved.pivots[i] - direction).abs() < PI / 2.0);
        }
    }

    #[test]
    fn direct_is_the_fermat_point(pose in poses(0.9, 0.5)) {
        let pivots = solve(&pose).pivots;
        let dft = direct::<f64>(&pivots).expect("a feasible triangle");
        let fermat = fermat_centre(&pivots, quarter_turn());
        prop_assert!((fermat - Vector2::new(dft.x, dft.y)).norm() < 1e-12);
        prop_assert!(turn_distance(fermat_theta(&pivots, fermat), dft.theta) < 1e-11);
    }

    /// A third of a turn gives each pivot the place of the next one.
    #[test]
    fn a_third_of_a_turn_renames_the_pivots(pose in poses(0.9, 2.0)) {
        let here = solve(&pose).pivots;
        let turned = solve(&Pose { theta: pose.theta + TAU / 3.0, ..pose }).pivots;
        prop_assert!((turned[0] - here[1]).abs() < 1e-14);
        prop_assert!((turned[1] - here[2]).abs() < 1e-14);
        prop_assert!((turned[2] - here[0] - TAU).abs() < 1e-14);
    }

    /// Turning the world turns the pivots.
    #[test]
    fn the_track_has_no_preferred_direction(r in 0.0..0.9, direction in -PI..PI, theta in -PI..PI, turn in -PI..PI) {
        let here = solve(&at(r, direction, theta)).pivots;
        let turned = solve(&at(r, direction + turn, theta + turn)).pivots;
        for i in 0..3 {
            prop_assert!((turned[i] - here[i] - turn).abs() < 1e-14);
        }
    }

    #[test]
    fn whole_turns_add_to_pivots_and_theta(pose in poses(0.9, 0.5), turns in -10_000_i32..10_000) {
        let turn = f64::from(turns) * TAU;
        // An ulp of 10,000 turns is 7e-12 rad.
        let tolerance = 1e-14 + 4.0 * f64::EPSILON * turn.abs();
        let here = solve(&pose).pivots;
        let there = solve(&Pose { theta: pose.theta + turn, ..pose }).pivots;
        for i in 0..3 {
            prop_assert!((there[i] - here[i] - turn).abs() < tolerance);
        }
        let back = direct::<f64>(&there).expect("a feasible triangle");
        prop_assert!((back.theta - pose.theta - turn).abs() < tolerance);
    }

    /// Whatever goes in, what comes out is finite or an error.
    #[test]
    fn never_a_nan(x in any::<f64>(), y in any::<f64>(), theta in any::<f64>()) {
        for (x, y) in [(x, y), (x.sin(), y.sin())] {
            let pose = Pose { x, y, theta };
            if let Ok(solved) = inverse(&pose) {
                prop_assert!(solved.pivots.iter().all(|pivot| pivot.is_finite()));
                prop_assert!(solved.guides.iter().all(|guide| guide.rho().is_finite()));
            }
            if let Ok(margins) = margins(&Geometry::REFERENCE, &pose) {
                prop_assert!(margins.guide_start.is_finite() && margins.separation_rad.is_finite());
            }
        }
        if let Ok(pose) = direct::<f64>(&[x, y, theta]) {
            prop_assert!(pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite());
            // Coinciding pivots put the centre on the track, and rounding a little beyond it.
            prop_assert!(pose.x.hypot(pose.y) < 1.0 + 1e-7);
        }
    }
}

/// The paper's eq. 10 as printed gives what the table of its errors says, so the reading of it is the paper's.
#[test]
fn the_printed_e_is_wrong() {
    let pose = Pose {
        x: 0.3,
        y: -0.2,
        theta: 0.7,
    };
    let printed = fermat_centre(&solve(&pose).pivots, Matrix2::new(-1.0, 0.0, 0.0, 1.0));
    assert!(
        (printed - Vector2::new(1.95, -2.01)).norm() < 0.005,
        "{printed}"
    );
}

#[test]
fn a_bad_pose_says_why() {
    let outside = [
        (1.0, 0.0),
        (0.0, -1.0),
        (0.8, 0.7),
        (3.0, 0.0),
        (1e300, 1e300),
    ];
    // At some orientations every guide would still meet the track.
    let turned = |(x, y)| {
        (0..360).map(move |step: i32| Pose {
            x,
            y,
            theta: f64::from(step),
        })
    };
    for pose in outside.into_iter().flat_map(turned) {
        assert_eq!(inverse(&pose), Err(InverseError::OutsideTrack));
        assert_eq!(
            feasibility(&Geometry::REFERENCE, &pose),
            Err(Infeasible::OutsideTrack)
        );
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (x, y, theta) in [(bad, 0.0, 0.0), (0.0, bad, 0.0), (0.0, 0.0, bad)] {
            let pose = Pose { x, y, theta };
            assert_eq!(inverse(&pose), Err(InverseError::NotFinite));
            assert_eq!(
                feasibility(&Geometry::REFERENCE, &pose),
                Err(Infeasible::NotFinite)
            );
        }
    }
}

#[test]
fn bad_pivots_say_why() {
    let direct = |degrees: [f64; 3]| direct::<f64>(&degrees.map(f64::to_radians));
    assert_eq!(direct([f64::NAN, 90.0, 210.0]), Err(DirectError::NotFinite));
    assert_eq!(
        direct([-30.0, 90.0, f64::INFINITY]),
        Err(DirectError::NotFinite)
    );
    assert_eq!(direct([40.0, 40.0, 40.0]), Err(DirectError::Singular));
    // Evenly spaced, but clockwise.
    assert_eq!(direct([210.0, 90.0, -30.0]), Err(DirectError::Singular));
    // The inscribed angle at pivot 2 is half of the 250 deg from pivot 3 on to pivot 1.
    let wide = direct([-55.0, 0.0, 55.0]);
    assert_eq!(wide, Err(DirectError::ReversedGuide { guide: 2 }));
    assert!(direct([-65.0, 0.0, 65.0]).is_ok());
    // Clockwise, and not even.
    let clockwise = direct([200.0, 90.0, -30.0]);
    assert!(matches!(clockwise, Err(DirectError::ReversedGuide { .. })));
}
