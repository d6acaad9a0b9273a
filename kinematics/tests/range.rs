//! What a fixed-point number type relies on: no position equation leaves +-4, and integer angles keep every digit over
//! many turns. A stand-in for such a type, `f64` inside, checks each operation.

mod common;

use std::f64::consts::{PI, TAU};
use std::ops::{Add, Mul, Neg, Sub};

use common::*;
use kinematics::{
    Angle, CorrectedScalar, Corrections, CurvePoint, Curves, PivotCoefficients, Pose, RingErrors,
    Scalar, Series, corrected_direct, corrected_inverse, direct, inverse,
};
use proptest::prelude::*;

#[derive(Clone, Copy, PartialEq, PartialOrd, Debug)]
struct Ranged(f64);

fn ranged(value: f64) -> Ranged {
    assert!((-4.0..4.0).contains(&value), "{value} leaves the range");
    Ranged(value)
}

impl Add for Ranged {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        ranged(self.0 + other.0)
    }
}

impl Sub for Ranged {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        ranged(self.0 - other.0)
    }
}

impl Mul for Ranged {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        ranged(self.0 * other.0)
    }
}

impl Neg for Ranged {
    type Output = Self;
    fn neg(self) -> Self {
        ranged(-self.0)
    }
}

fn angle(radians: f64) -> Angle {
    Angle::from_radians(radians).expect("within range")
}

impl Scalar for Ranged {
    type Angle = Angle;

    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    const HALF: Self = Self(0.5);
    const THIRD: Self = Self(1.0 / 3.0);
    const SIN_60: Self = Self(f64::SIN_60);
    const ANGLE_ZERO: Angle = Angle::ZERO;
    const ANGLE_30: Angle = Angle::DEG_30;
    const ANGLE_120: Angle = Angle::DEG_120;

    fn sin_cos(angle: Angle) -> (Self, Self) {
        let (sin, cos) = angle.near(Angle::ZERO).radians().sin_cos();
        (ranged(sin), ranged(cos))
    }

    fn asin_cos(sines: [Self; 3]) -> Option<[(Angle, Self); 3]> {
        let swings = f64::asin_cos(sines.map(|sine| sine.0))?;
        Some(swings.map(|(swing, cosine)| (angle(swing), ranged(cosine))))
    }

    fn polar(re: Self, im: Self) -> Option<(Angle, Self, Self)> {
        let (direction, cos, sin) = f64::polar(re.0, im.0)?;
        Some((angle(direction), ranged(cos), ranged(sin)))
    }

    fn near(angle: Angle, reference: Angle) -> Angle {
        angle.near(reference)
    }

    fn is_finite(self) -> bool {
        true
    }

    fn angle_is_finite(_: Angle) -> bool {
        true
    }
}

impl CorrectedScalar for Ranged {
    type Correction = f64;

    fn to_correction(self) -> f64 {
        self.0
    }

    fn from_correction(correction: f64) -> Self {
        ranged(correction)
    }

    fn angle_to_correction(angle: Angle) -> f64 {
        angle.radians()
    }

    fn angle_from_correction(rad: f64) -> Angle {
        angle(rad)
    }

    fn length_from_f64(length: f64) -> Self {
        ranged(length)
    }

    fn angle_from_f64(rad: f64) -> Angle {
        angle(rad)
    }
}

/// Exact curves over integer angles.
struct RangedSeries(Series<f64>);

impl Curves<Ranged> for RangedSeries {
    fn are_zero(&self) -> bool {
        Curves::<f64>::are_zero(&self.0)
    }

    fn ring_errors(&self, ring: Angle) -> RingErrors<f64> {
        Curves::<f64>::ring_errors(&self.0, ring.near(Angle::ZERO).radians())
    }

    fn straightness(&self, rho: f64) -> CurvePoint<f64> {
        Curves::<f64>::straightness(&self.0, rho)
    }
}

/// As far off as the formulas take it, every number with this sign.
fn worst(sign: f64) -> PivotCoefficients {
    PivotCoefficients {
        encoder_zero_rad: 3.0 * sign,
        radius_error: 0.02 * sign,
        ring_centre: [0.01 * sign, -0.01 * sign],
        guide_error_rad: 0.02 * sign,
        guide_offset: 0.02 * sign,
        encoder_rad: [[8e-5 * sign; 2]; 12],
        runout: [[1.99e-4 * sign; 2]; 5],
        straightness: [2.49e-4 * sign; 8],
    }
}

/// What is left of an angle's digits: its unit of 1.5 nrad, and not a fifteenth of a 26-bit encoder's LSB.
const ANGLE_RAD: f64 = TAU / (1_u64 << 32) as f64;

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn positions_keep_their_digits_over_10_000_turns(pose in poses(0.8, 0.5), turns in -10_000_i64..10_000) {
        let far = Angle::from_units(turns << 32);
        let theta = angle(pose.theta);
        let there = Pose { x: ranged(pose.x), y: ranged(pose.y), theta: theta + far };
        let got = inverse(&there).expect("inside the track").pivots;
        let exact = solve(&Pose { theta: theta.radians(), ..pose }).pivots;
        for i in 0..3 {
            let error_rad = (got[i] - far).radians() - exact[i];
            prop_assert!(error_rad.abs() < ANGLE_RAD, "{error_rad}");
        }
        let back = direct::<Ranged>(&got).expect("a feasible triangle");
        prop_assert!((back.x.0 - pose.x).abs() < 1.6e-9 && (back.y.0 - pose.y).abs() < 1.6e-9);
        prop_assert!((back.theta - there.theta).radians().abs() < 1.7e-9);
    }

    /// Poses anywhere in the number's range, also outside the track.
    #[test]
    fn inverse_stays_in_range(x in -4.0..4.0, y in -4.0..4.0, theta in -PI..PI) {
        let _ = inverse(&Pose { x: ranged(x), y: ranged(y), theta: angle(theta) });
        let _ = inverse(&Pose { x: ranged(x / 4.0), y: ranged(y / 4.0), theta: angle(theta) });
    }

    /// Pivots anywhere, also where no platform could hold them.
    #[test]
    fn direct_stays_in_range(pivots in prop::array::uniform3(-PI..PI)) {
        let _ = direct::<Ranged>(&pivots.map(angle));
    }

    /// Of the worst machine at any pose that has one, many turns away: no equation leaves the range, and the pose comes back.
    #[test]
    fn corrected_positions_stay_in_range(
        x in -1.0..1.0, y in -1.0..1.0, theta in -PI..PI, turns in -10_000_i64..10_000,
        signs in prop::array::uniform3(prop::bool::ANY),
    ) {
        let pivots = signs.map(|sign| worst(if sign { 1.0 } else { -1.0 }));
        let machine = Corrections::new(&pivots, |built| RangedSeries(Series::new(built))).expect("at the limits");
        let far = Angle::from_units(turns << 32);
        let pose = Pose { x: ranged(x), y: ranged(y), theta: angle(theta) + far };
        if let Ok(there) = corrected_inverse(&pose, &machine) && x.hypot(y) < 0.8 {
            let back = corrected_direct::<Ranged, _>(&there.encoders, &machine, 6).expect("a pose");
            prop_assert!((back.x.0 - x).abs() < 4e-9 && (back.y.0 - y).abs() < 4e-9, "{back:?}");
            prop_assert!((back.theta - pose.theta).radians().abs() < 4e-9);
        }
    }
}
