//! Geometry, feasibility and margins.

mod common;

use std::f64::consts::{PI, TAU};

use common::*;
use kinematics::{
    Geometry, GeometryError, Infeasible, Pose, closest_separation_rad, feasibility, margins,
    worst_rate_per_rotation, worst_rate_per_speed,
};
use proptest::prelude::*;

const REFERENCE: Geometry = Geometry::REFERENCE;

fn geometry(start: f64, length: f64, separation_deg: f64) -> Geometry {
    Geometry::new(100.0, start, length, separation_deg.to_radians()).expect("a geometry")
}

proptest! {
    #![proptest_config(settings())]

    /// The rim itself included, at every orientation, whichever proportion sets it.
    #[test]
    fn the_usable_disk_is_feasible(
        start in 0.05..0.5, spare in -0.2..0.2, separation_deg in 0.0..60.0,
        share in prop_oneof![Just(1.0), 0.0..1.0], direction in -PI..PI, theta in -PI..PI,
    ) {
        let geometry = geometry(start, 2.0 * (1.0 - start) + spare, separation_deg);
        let pose = at(share * geometry.usable_radius(), direction, theta);
        prop_assert!(feasibility(&geometry, &pose).is_ok(), "{:?}", feasibility(&geometry, &pose));
        let single = Pose { x: pose.x as f32, y: pose.y as f32, theta: pose.theta as f32 };
        prop_assert!(feasibility(&geometry, &single).is_ok());
    }

    #[test]
    fn separation_keeps_to_its_closed_form(r in 0.0..0.99, direction in -PI..PI, theta in -PI..PI) {
        let pose = at(r, direction, theta);
        let [phi_1, phi_2, phi_3] = solve(&pose).pivots;
        let closest = (phi_2 - phi_1).min(phi_3 - phi_2).min(phi_1 + TAU - phi_3);
        prop_assert!(closest >= closest_separation_rad(r) - 1e-12);
        let margins = margins(&REFERENCE, &pose).expect("inside the track");
        prop_assert!((margins.separation_rad + REFERENCE.separation_rad - closest).abs() < 5e-15);
    }

    /// Also in f32, where an angle of 10,000 turns rounds by 0.2 deg: given that angle, the margins are exact.
    #[test]
    fn margins_keep_their_digits_over_turns(pose in poses(0.8, 10_000.0)) {
        let single = Pose { x: pose.x as f32, y: pose.y as f32, theta: pose.theta as f32 };
        let same = Pose { x: single.x.into(), y: single.y.into(), theta: single.theta.into() };
        let got = margins(&REFERENCE, &single).expect("inside the track");
        let want = margins::<f64>(&REFERENCE, &same).expect("inside the track");
        prop_assert!((f64::from(got.guide_start) - want.guide_start).abs() < 2e-7);
        prop_assert!((f64::from(got.separation_rad) - want.separation_rad).abs() < 5e-7);
    }

    #[test]
    fn margins_forget_whole_turns(pose in poses(0.8, 0.5), turns in -9_999_i32..9_999) {
        let theta = pose.theta + f64::from(turns) * TAU;
        let here = margins(&REFERENCE, &pose).expect("inside the track");
        let there = margins(&REFERENCE, &Pose { theta, ..pose }).expect("inside the track");
        prop_assert!((here.guide_start - there.guide_start).abs() < 3.5e-12);
        prop_assert!((here.guide_end - there.guide_end).abs() < 1.1e-11);
        prop_assert!((here.separation_rad - there.separation_rad).abs() < 1.4e-11);
    }
}

/// Over all orientations the closest two pivots come as close as the closed form says, and the figures in the docs.
#[test]
fn the_closest_separation_is_reached() {
    for (r, degrees) in [(0.6, 57.4), (0.8, 32.3), (0.95, 9.3)] {
        // Guides 1 and 3 lie symmetrically about -y; with C above O, at theta = 0, their pivots are the widest apart.
        let [phi_1, _, phi_3] = solve(&at(r, -PI / 2.0, 0.0)).pivots;
        let gap = phi_1 + TAU - phi_3;
        assert!((gap - closest_separation_rad(r)).abs() < 2e-15, "{gap}");
        assert!((gap.to_degrees() - degrees).abs() < 0.05);
    }
    assert!((closest_separation_rad(0.0) - TAU / 3.0).abs() < 1e-15);
}

/// Just beyond the rim some orientation is refused for the very reason that sets the radius.
#[test]
fn beyond_the_rim_the_limit_that_sets_it_is_named() {
    let found = |geometry: &Geometry| {
        let radius = geometry.usable_radius() + 1e-6;
        (0..3_600)
            .map(|step| at(radius, PI / 2.0, TAU * f64::from(step) / 3_600.0))
            .filter_map(|pose| feasibility(geometry, &pose).err())
            .find(|reason| *reason != Infeasible::OutsideDisk)
    };
    let by_start = found(&geometry(0.3, 1.8, 0.0));
    assert!(matches!(by_start, Some(Infeasible::GuideStart { .. })));
    let by_end = found(&geometry(0.2, 1.5, 0.0));
    assert!(matches!(by_end, Some(Infeasible::GuideEnd { .. })));
    let by_separation = found(&geometry(0.05, 1.9, 40.0));
    assert!(matches!(
        by_separation,
        Some(Infeasible::PivotsTooClose { .. })
    ));
}

#[test]
fn the_guide_or_pivots_are_named() {
    // At theta = 0 the guides point to -30, 90 and 210 deg.
    for (index, degrees) in [(1, -30.0_f64), (2, 90.0), (3, 210.0)] {
        let direction = degrees.to_radians();
        let towards = at(0.85, direction, 0.0);
        let start = Infeasible::GuideStart { guide: index };
        assert_eq!(feasibility(&REFERENCE, &towards), Err(start));
        let away = at(0.85, direction + PI, 0.0);
        let end = Infeasible::GuideEnd { guide: index };
        assert_eq!(feasibility(&REFERENCE, &away), Err(end));
        let narrow = geometry(0.05, 1.9, 40.0);
        let (first, second) = (index % 3 + 1, (index + 1) % 3 + 1);
        let close = Infeasible::PivotsTooClose { first, second };
        assert_eq!(feasibility(&narrow, &away), Err(close));
    }
    // Between two guides' directions all of them reach; only other orientations do not.
    let between = at(0.81, 0.0, 0.0);
    assert_eq!(
        feasibility(&REFERENCE, &between),
        Err(Infeasible::OutsideDisk)
    );
    assert!(feasibility(&REFERENCE, &at(0.79, 0.0, 0.0)).is_ok());
}

#[test]
fn margins_at_the_centre() {
    let margins = feasibility(&REFERENCE, &at(0.0, 0.0, 1.0)).expect("the centre is feasible");
    assert!((margins.disk - 0.8).abs() < 1e-15);
    assert!((margins.guide_start - 0.8).abs() < 1e-15);
    assert!((margins.guide_end - 0.8).abs() < 1e-15);
    assert!((margins.separation_rad.to_degrees() - 100.0).abs() < 2e-14);
}

#[test]
fn the_reference_disk_is_80_mm() {
    let Geometry {
        radius_mm,
        guide_start,
        guide_length,
        separation_rad,
    } = REFERENCE;
    let checked = Geometry::new(radius_mm, guide_start, guide_length, separation_rad);
    assert_eq!(checked, Ok(REFERENCE));
    assert!((REFERENCE.usable_radius() * radius_mm - 80.0).abs() < 1e-15);
}

#[test]
fn wide_carriages_leave_a_disk_as_their_sine_says() {
    for deg in 0..120 {
        let half = f64::from(120 - deg).to_radians() / 2.0;
        let by_sine = half.sin() / 60.0_f64.to_radians().sin();
        let usable = geometry(1e-9, 3.0, f64::from(deg)).usable_radius();
        assert!(
            (usable - by_sine.min(1.0 - 1e-9)).abs() < 1e-15,
            "{deg} deg: {usable} {by_sine}"
        );
    }
}

#[test]
fn a_bad_proportion_is_named() {
    let refused = |radius: f64, start: f64, length: f64, separation: f64| {
        Geometry::new(radius, start, length, separation).err()
    };
    assert_eq!(
        refused(0.0, 0.2, 1.6, 0.3),
        Some(GeometryError::Radius(0.0))
    );
    let endless = f64::INFINITY;
    assert_eq!(
        refused(endless, 0.2, 1.6, 0.3),
        Some(GeometryError::Radius(endless))
    );
    assert_eq!(
        refused(100.0, 0.0, 1.6, 0.3),
        Some(GeometryError::GuideStart(0.0))
    );
    assert_eq!(
        refused(100.0, 1.0, 1.6, 0.3),
        Some(GeometryError::GuideStart(1.0))
    );
    assert_eq!(
        refused(100.0, 0.25, 0.75, 0.3),
        Some(GeometryError::GuideEnd(1.0))
    );
    assert_eq!(
        refused(100.0, 0.2, endless, 0.3),
        Some(GeometryError::GuideEnd(endless))
    );
    assert_eq!(
        refused(100.0, 0.2, 1.6, 2.1),
        Some(GeometryError::Separation(2.1))
    );
    assert_eq!(
        refused(100.0, 0.2, 1.6, -0.1),
        Some(GeometryError::Separation(-0.1))
    );
    for index in 0..4 {
        let mut proportions = [100.0, 0.2, 1.6, 0.3];
        proportions[index] = f64::NAN;
        let [radius, start, length, separation] = proportions;
        assert!(refused(radius, start, length, separation).is_some());
    }
}

#[test]
fn worst_rates_have_the_documented_figures() {
    assert!((worst_rate_per_speed(0.8) - 1.0 / 0.6).abs() < 1e-15);
    assert!((worst_rate_per_speed(0.95) - 3.2).abs() < 0.01);
    assert!((worst_rate_per_rotation(0.8) - 1.8).abs() < 1e-15);
    assert!(
        worst_rate_per_speed(1.0).is_infinite() && worst_rate_per_speed(f64::NAN).is_infinite()
    );
}
