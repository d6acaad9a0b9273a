//! What a number has to be able to do for the kinematics to run on it.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number the position equations run on, with the kind of angle that goes with it.
///
/// Position code neither divides nor lets an intermediate leave +-4 (lengths are in track radii, and the centre lies
/// inside the track), so that a fixed-point type of that range can implement this.
pub trait Scalar:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// A multi-turn angle.
    type Angle: Copy
        + Debug
        + PartialEq
        + PartialOrd
        + Add<Output = Self::Angle>
        + Sub<Output = Self::Angle>;

    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// 1/3.
    const THIRD: Self;
    /// sin 60 deg = cos 30 deg = sqrt(3)/2.
    const SIN_60: Self;
    /// No angle.
    const ANGLE_ZERO: Self::Angle;
    /// 30 deg.
    const ANGLE_30: Self::Angle;
    /// 120 deg.
    const ANGLE_120: Self::Angle;

    /// Half of this number.
    #[inline]
    fn half(self) -> Self {
        self * Self::HALF
    }

    /// `a b + c d`: most products of the position equations come in pairs, which a fixed-point number sums before it rounds.
    #[inline]
    fn sum_of_products((a, b): (Self, Self), (c, d): (Self, Self)) -> Self {
        a * b + c * d
    }

    /// Sine and cosine of `angle`, in this order.
    fn sin_cos(angle: Self::Angle) -> (Self, Self);

    /// The arc sine, in (-90 deg, 90 deg), and its cosine sqrt(1 - sine^2), of three sines: together, because every user of
    /// one needs the other, and three at a time, because three share the loading of a polynomial's coefficients. `None`
    /// unless -1 < sine < 1 for all of them, so for NaN too.
    fn asin_cos(sines: [Self; 3]) -> Option<[(Self::Angle, Self); 3]>;

    /// Direction of the vector (`re`, `im`): its angle in (-half a turn, half a turn], the cosine and the sine of it.
    /// `None` when the vector is not finite, or too short for its direction to mean anything.
    fn polar(re: Self, im: Self) -> Option<(Self::Angle, Self, Self)>;

    /// The angle that differs from `angle` by whole turns and lies nearest to `reference`.
    fn near(angle: Self::Angle, reference: Self::Angle) -> Self::Angle;

    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// Neither NaN nor infinite.
    fn angle_is_finite(angle: Self::Angle) -> bool;
}

/// A floating-point [`Scalar`] with angles in radians: adds the division, square root and range that rates, Jacobian,
/// dexterity and margins need.
pub trait Real: Scalar<Angle = Self> + Div<Output = Self> + nalgebra::Scalar {
    /// Spacing of the numbers just above 1.
    const EPSILON: Self;

    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;

    /// The same value as an `f64`.
    fn to_f64(self) -> f64;

    /// Square root; NaN for a negative number.
    fn sqrt(self) -> Self;
}
