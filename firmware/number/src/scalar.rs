//! [`Fixed`] as the number of the kinematics: rounding and the elementary functions.

use super::fixed::{Fixed, HALF_LSB};
use super::float::round_i32;
use super::{arcsine, polar, trigonometric};
use kinematics::{Angle, CorrectedScalar, Scalar};

impl Scalar for Fixed {
    type Angle = Angle;
    const ZERO: Self = Self(0);
    const ONE: Self = Self(1 << Self::FRACTION_BITS);
    const HALF: Self = Self(1 << (Self::FRACTION_BITS - 1));
    const THIRD: Self = Self::from_f64(1.0 / 3.0);
    const SIN_60: Self = Self::from_f64(0.866_025_403_784_438_6);
    const ANGLE_ZERO: Angle = Angle::ZERO;
    const ANGLE_30: Angle = Angle::DEG_30;
    const ANGLE_120: Angle = Angle::DEG_120;

    #[inline]
    fn half(self) -> Self {
        Self(self.0.wrapping_add(1) >> 1)
    }

    /// Rounded to nearest, once. Two products of numbers under 2 apiece at least fit.
    #[inline]
    fn sum_of_products((a, b): (Self, Self), (c, d): (Self, Self)) -> Self {
        Self::from_product(Self::add_product(Self::add_product(HALF_LSB, a, b), c, d))
    }

    #[inline]
    fn sin_cos(angle: Angle) -> (Self, Self) {
        trigonometric::sin_cos(angle.fraction())
    }

    #[inline(always)]
    fn asin_cos(sines: [Self; 3]) -> Option<[(Angle, Self); 3]> {
        arcsine::asin_cos(sines)
    }

    #[inline]
    fn polar(re: Self, im: Self) -> Option<(Angle, Self, Self)> {
        polar::polar(re, im)
    }

    #[inline]
    fn near(angle: Angle, reference: Angle) -> Angle {
        angle.near(reference)
    }

    #[inline]
    fn is_finite(self) -> bool {
        true
    }

    #[inline]
    fn angle_is_finite(_: Angle) -> bool {
        true
    }
}

/// Units of angle in a radian, and back.
const UNITS_PER_RADIAN: f32 = (4_294_967_296.0 / core::f64::consts::TAU) as f32;
const RADIANS_PER_UNIT: f32 = (core::f64::consts::TAU / 4_294_967_296.0) as f32;
/// 2^29.
const BITS_PER_ONE: f32 = (1u32 << Fixed::FRACTION_BITS) as f32;

impl CorrectedScalar for Fixed {
    type Correction = f32;

    #[inline]
    fn to_correction(self) -> f32 {
        self.to_f32()
    }

    /// Rounded to nearest, once.
    #[inline]
    fn sum_of_four_products(products: [(Self, Self); 4]) -> Self {
        let sum = (products.into_iter()).fold(HALF_LSB, |sum, (a, b)| Self::add_product(sum, a, b));
        Self::from_product(sum)
    }

    #[inline]
    fn from_correction(correction: f32) -> Self {
        Self(round_i32(correction * BITS_PER_ONE))
    }

    #[inline]
    fn angle_to_correction(angle: Angle) -> f32 {
        // Less than half a turn: 32 bits.
        angle.units() as i32 as f32 * RADIANS_PER_UNIT
    }

    /// Rounded to nearest, but for a sixteenth of a unit, up to 0.19 rad; beyond, that.
    #[inline]
    fn angle_from_correction(rad: f32) -> Angle {
        // Cut to sixteenths, which is one instruction of the chip, and rounded as an integer.
        let sixteenths = (rad * (16.0 * UNITS_PER_RADIAN)) as i32;
        Angle::from_units(i64::from(((sixteenths >> 3) + 1) >> 1))
    }

    fn length_from_f64(length: f64) -> Self {
        Self::from_f64(length)
    }

    /// No angle for what is no number.
    fn angle_from_f64(rad: f64) -> Angle {
        Angle::from_radians(rad).unwrap_or(Angle::ZERO)
    }
}
