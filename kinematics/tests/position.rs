//! Inverse and direct position: against each other, against the paper's construction, over symmetry and turns.

mod common;

use std::cell::Cell;
use std::f64::consts::{PI, TAU};

use common::*;
use kinematics::{
    DirectError, Geometry, Infeasible, InverseError, Pose, Scalar, direct, feasibility,
    guides_along_axes, inverse, margins,
};
use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::TestRunner;

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn a_pose_comes_back(pose in poses(0.95, 3.0)) {
        let back = direct::<f64>(&solve(&pose).pivots).expect("a feasible triangle");
        prop_assert!((back.x - pose.x).abs() < 5e-15, "{back:?}");
        prop_assert!((back.y - pose.y).abs() < 5e-15, "{back:?}");
        prop_assert!((back.theta - pose.theta).abs() < 5e-15, "{back:?}");
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
                    prop_assert!((got - want).abs() < 1e-13, "{back:?} from {pivots:?}");
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
        prop_assert!((fermat - Vector2::new(dft.x, dft.y)).norm() < 2e-15);
        prop_assert!(turn_distance(fermat_theta(&pivots, fermat), dft.theta) < 6e-15);
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

    /// By their definition, without an angle: each guide's direction at theta = 0, and the centre across and along it.
    #[test]
    fn guides_along_axes_are_those_of_the_pose_at_zero(r in 0.0..0.99, direction in -PI..PI) {
        let Pose { x, y, .. } = at(r, direction, 0.0);
        let guides = guides_along_axes(x, y, f64::sqrt).expect("inside the track");
        for (i, guide) in guides.iter().enumerate() {
            let (sin, cos) = guide_angle(0.0, i).sin_cos();
            prop_assert!((guide.cos - cos).abs() < 1e-15 && (guide.sin - sin).abs() < 1e-15);
            prop_assert!((guide.offset - (y * cos - x * sin)).abs() < 1e-15);
            prop_assert!((guide.projection - (x * cos + y * sin)).abs() < 1e-15);
            // The pivot is on the track, in front of the guide.
            prop_assert!(guide.rho() > 0.0);
            let pivot = (x + guide.rho() * cos).hypot(y + guide.rho() * sin);
            prop_assert!((pivot - 1.0).abs() < 1e-14, "{pivot}");
        }
    }

    /// Turning the pose and looking along its axes changes the directions alone.
    #[test]
    fn guides_along_axes_are_those_of_any_orientation(r in 0.0..0.99, direction in -PI..PI, theta in -PI..PI) {
        let Pose { x, y, .. } = at(r, direction, 0.0);
        let along = guides_along_axes(x, y, f64::sqrt).expect("inside the track");
        for (guide, along) in guides(&at(r, direction + theta, theta)).iter().zip(along) {
            prop_assert!((guide.offset - along.offset).abs() < 2e-15);
            prop_assert!((guide.projection - along.projection).abs() < 2e-15);
            prop_assert!((guide.cosine - along.cosine).abs() < 1e-14);
        }
    }
}

#[test]
fn guides_along_axes_end_at_the_track_and_take_the_callers_root() {
    for bad in [1.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
        assert_eq!(guides_along_axes(bad, 0.0, f64::sqrt), None);
        assert_eq!(guides_along_axes(0.0, bad, f64::sqrt), None);
    }
    assert_eq!(guides_along_axes(0.8, 0.7, f64::sqrt), None);
    assert!(guides_along_axes(0.7_f32, 0.7, f32::sqrt).is_some());
    let squares = guides_along_axes(0.6, 0.0, |square| square).expect("inside the track");
    assert_eq!(squares[1].cosine, (1.0 - 0.6) * (1.0 + 0.6));
}

/// A coordinate: any number and what is none, or about as large as a pose's, or one at which something ends.
fn anything() -> impl Strategy<Value = f64> {
    const ENDS: &[f64] = &[0.0, -0.0, 0.5, f64::SIN_60, 1.0, -1.0, PI, f64::MAX];
    prop_oneof![prop::num::f64::ANY, -2.0..2.0, select(ENDS)]
}

/// A pose of any coordinates, or one whose centre is within some roundings of the track's rim, across a guide.
fn any_pose() -> impl Strategy<Value = Pose<f64>> {
    let anywhere =
        (anything(), anything(), anything()).prop_map(|(x, y, theta)| Pose { x, y, theta });
    let rim =
        (-9_i32..9, 0_usize..3, any::<bool>(), -PI..PI).prop_map(|(roundings, i, left, theta)| {
            let across = if left { PI / 2.0 } else { -PI / 2.0 };
            let radius = 1.0 + f64::from(roundings) * f64::EPSILON / 2.0;
            at(radius, guide_angle(theta, i) + across, theta)
        });
    prop_oneof![anywhere, rim]
}

/// Any pivots, some of which may coincide, or nearly.
fn any_pivots() -> impl Strategy<Value = [f64; 3]> {
    let close = (anything(), prop::array::uniform3(-9.0..9.0))
        .prop_map(|(pivot, off)| off.map(|off: f64| pivot + off.round() * 1e-9));
    let places = prop::array::uniform3(-PI..PI);
    prop_oneof![prop::array::uniform3(anything()), close, places]
}

/// Whatever goes in, what comes out is finite, or an error that tells what was not finite from what was out of reach.
#[test]
fn never_a_nan() {
    let (solved, refused) = (Cell::new(0), Cell::new(0));
    let mut runner = TestRunner::new(settings());
    let outcome = runner.run(&any_pose(), |pose| {
        let finite = [pose.x, pose.y, pose.theta].iter().all(|v| v.is_finite());
        let (inverse, margins) = (inverse(&pose), margins(&Geometry::REFERENCE, &pose));
        prop_assert_eq!(inverse.is_ok(), margins.is_ok());
        prop_assert_eq!(inverse == Err(InverseError::NotFinite), !finite);
        if let (Ok(inverse), Ok(margins)) = (inverse, margins) {
            solved.set(solved.get() + 1);
            prop_assert!(inverse.pivots.iter().all(|pivot| pivot.is_finite()));
            for guide in inverse.guides {
                prop_assert!(guide.rho().is_finite() && guide.offset.abs() < 1.0);
                prop_assert!((guide.cos.hypot(guide.sin) - 1.0).abs() < 1e-14);
            }
            prop_assert!(margins.disk.is_finite() && margins.separation_rad.is_finite());
            prop_assert!(margins.guide_start.is_finite() && margins.guide_end.is_finite());
        } else if finite {
            refused.set(refused.get() + 1);
        }
        Ok(())
    });
    assert_eq!(outcome, Ok(()));
    // Enough of each are met for the above to mean something.
    assert!(
        solved.get() > 500 && refused.get() > 500,
        "{solved:?} {refused:?}"
    );
}

#[test]
fn never_a_nan_the_other_way() {
    let (solved, refused) = (Cell::new(0), Cell::new(0));
    let mut runner = TestRunner::new(settings());
    let outcome = runner.run(&any_pivots(), |pivots| {
        let finite = pivots.iter().all(|pivot| pivot.is_finite());
        let direct = direct::<f64>(&pivots);
        prop_assert_eq!(direct == Err(DirectError::NotFinite), !finite);
        match direct {
            Ok(pose) => {
                solved.set(solved.get() + 1);
                prop_assert!(pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite());
                // Coinciding pivots put the centre on the track, and rounding a little beyond it.
                prop_assert!(pose.x.hypot(pose.y) < 1.0 + 1e-7);
            }
            Err(DirectError::Singular) => refused.set(refused.get() + 1),
            Err(_) => {}
        }
        Ok(())
    });
    assert_eq!(outcome, Ok(()));
    assert!(
        solved.get() > 100 && refused.get() > 100,
        "{solved:?} {refused:?}"
    );
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
