//! The angle type: exact over many turns, conversions, and the position equations' functions of floats.

mod common;

use std::f64::consts::{PI, TAU};

use common::settings;
use kinematics::{Angle, Scalar};
use proptest::prelude::*;

/// +-10,000 turns in units.
const FAR: std::ops::Range<i64> = -10_000 << 32..10_000 << 32;
const UNIT_RAD: f64 = TAU / (1_u64 << 32) as f64;

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn turns_and_fraction_make_the_angle(units in any::<i64>()) {
        let angle = Angle::from_units(units);
        let rebuilt = (i64::from(angle.turns()) << 32) + i64::from(angle.fraction());
        prop_assert_eq!(rebuilt, units);
    }

    #[test]
    fn sums_are_exact(a in FAR, b in FAR) {
        let (a, b) = (Angle::from_units(a), Angle::from_units(b));
        prop_assert_eq!((a + b) - b, a);
        prop_assert_eq!(a - b, a + -b);
        prop_assert_eq!((a + b).units(), a.units() + b.units());
    }

    #[test]
    fn degrees_and_radians_come_back(units in FAR) {
        let angle = Angle::from_units(units);
        prop_assert_eq!(Angle::from_degrees(angle.degrees()), Some(angle));
        prop_assert_eq!(Angle::from_radians(angle.radians()), Some(angle));
    }

    #[test]
    fn whole_turns_are_exact_in_degrees(turns in -2_000_000_000_i32..2_000_000_000) {
        let degrees = 360.0 * f64::from(turns);
        let angle = Angle::from_degrees(degrees).expect("within range");
        prop_assert_eq!((angle.turns(), angle.fraction()), (turns, 0));
        prop_assert_eq!(angle.degrees(), degrees);
    }

    #[test]
    fn counts_come_back(counts in any::<u32>(), bits in 1_u32..=32, turns in -10_000_i64..10_000) {
        let counts = counts >> (32 - bits);
        let angle = Angle::from_counts(counts, bits);
        prop_assert_eq!(angle.turns(), 0);
        prop_assert_eq!((angle + Angle::from_units(turns << 32)).counts(bits), counts);
    }

    #[test]
    fn counts_are_the_nearest(fraction in any::<u32>(), bits in 1_u32..=26) {
        let angle = Angle::from_units(i64::from(fraction));
        let error = Angle::from_counts(angle.counts(bits), bits).near(angle) - angle;
        prop_assert!(error.units().abs() <= 1 << (31 - bits));
    }

    #[test]
    fn near_is_congruent_and_nearest(units in FAR, reference in FAR) {
        let (angle, reference) = (Angle::from_units(units), Angle::from_units(reference));
        let near = angle.near(reference);
        prop_assert_eq!(near.fraction(), angle.fraction());
        let half_turn = Angle::TURN.units() / 2;
        prop_assert!((-half_turn..half_turn).contains(&(near - reference).units()));
    }

    #[test]
    fn float_near_is_congruent_and_nearest(angle in -100.0..100.0, reference in -100.0..100.0) {
        let near = <f64 as Scalar>::near(angle, reference);
        prop_assert!((near - reference).abs() <= PI + 1e-12);
        prop_assert!(((near - angle) / TAU - ((near - angle) / TAU).round()).abs() < 4e-15);
    }

    #[test]
    fn polar_gives_back_the_direction(angle in -PI..PI, length in 0.01..3.0) {
        let (sin, cos) = angle.sin_cos();
        let (direction, re, im) = <f64 as Scalar>::polar(length * cos, length * sin).expect("long enough");
        prop_assert!((direction - angle).abs() < 5e-16);
        prop_assert!((re - cos).abs() < 1e-15 && (im - sin).abs() < 1e-15);
    }
}

#[test]
fn constants_are_nearest_and_their_sums_known() {
    assert_eq!(Angle::from_degrees(30.0), Some(Angle::DEG_30));
    assert_eq!(Angle::from_degrees(120.0), Some(Angle::DEG_120));
    let quarter = Angle::DEG_120 - Angle::DEG_30;
    assert_eq!(quarter.units(), Angle::TURN.units() / 4);
    let three = Angle::DEG_120 + Angle::DEG_120 + Angle::DEG_120;
    assert_eq!((Angle::TURN - three).units(), 1);
    assert_eq!(Angle::from_degrees(210.0), Some(quarter + Angle::DEG_120));
}

/// Half a turn from the reference two angles are nearest: the one below it is taken, from whichever side it is asked.
#[test]
fn at_half_a_turn_near_takes_the_angle_below() {
    let half = Angle::from_units(Angle::TURN.units() / 2);
    let one = Angle::from_units(1);
    let far = Angle::from_units((9_999 << 32) + 123_456_789);
    for reference in [Angle::ZERO, far, -far] {
        for off in [half, -half, half + Angle::TURN, -half - Angle::TURN] {
            assert_eq!(
                (reference + off).near(reference),
                reference - half,
                "{off:?}"
            );
        }
        assert_eq!(
            (reference + half - one).near(reference),
            reference + half - one
        );
        assert_eq!(
            (reference - half - one).near(reference),
            reference + half - one
        );
        assert_eq!(
            (reference + half + one).near(reference),
            reference - half + one
        );
    }
}

#[test]
fn one_unit_survives_10_000_turns() {
    let mut angle = Angle::from_degrees(3_600_000.0).expect("within range");
    angle += Angle::from_units(1);
    assert_eq!((angle.turns(), angle.fraction()), (10_000, 1));
    angle -= Angle::from_units(2);
    assert_eq!((angle.turns(), angle.fraction()), (9_999, u32::MAX));
    assert!((Angle::from_units(1).radians() - UNIT_RAD).abs() < 1e-24);
}

#[test]
fn counts_wrap_at_a_turn() {
    assert_eq!(Angle::from_units(-1).counts(26), 0);
    assert_eq!(Angle::from_counts(1 << 26, 26), Angle::ZERO);
    assert_eq!(
        Angle::from_counts(1 << 25, 26).units(),
        Angle::TURN.units() / 2
    );
    // Beyond 32 bits counts as 32, and none at all as nothing.
    assert_eq!(Angle::from_counts(7, 40).units(), 7);
    assert_eq!(Angle::from_counts(7, 0), Angle::ZERO);
    assert_eq!(Angle::from_units(7).counts(40), 7);
    assert_eq!(Angle::from_units(7).counts(0), 0);
}

#[test]
fn what_no_angle_can_hold_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        assert_eq!(Angle::from_radians(bad), None);
        assert_eq!(Angle::from_degrees(bad), None);
    }
    let limit_deg = 360.0 * 2_147_483_648.0;
    assert_eq!(Angle::from_degrees(limit_deg), None);
    assert_eq!(
        Angle::from_degrees(-limit_deg),
        Some(Angle::from_units(i64::MIN))
    );
}

#[test]
fn float_functions_refuse_what_has_no_answer() {
    for bad in [1.0, -1.0, 1.5, f64::NAN] {
        for place in 0..3 {
            let mut sines = [0.5; 3];
            sines[place] = bad;
            assert_eq!(f64::asin_cos(sines), None);
        }
    }
    for (re, im) in [
        (0.0, 0.0),
        (1e-12, 0.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert_eq!(<f64 as Scalar>::polar(re, im), None);
    }
    // The lower edge of the range belongs to the upper one.
    let (angle, _, _) = <f64 as Scalar>::polar(-1.0, -0.0).expect("a direction");
    assert_eq!(angle, PI);
}
