//! What a number has to be able to do besides for the kinematics of a built machine.

use crate::scalar::{Real, Scalar};

/// A [`Scalar`] with the float that its small corrections are computed in. What a machine is off the drawing is some
/// thousandths: there a float's range is worth more than a fixed-point number's last bits.
pub trait CorrectedScalar: Scalar {
    /// The float. A [`Real`] is its own.
    type Correction: Real;

    /// The number as a float.
    fn to_correction(self) -> Self::Correction;

    /// The sum of four products, which a fixed-point number rounds once.
    #[inline]
    fn sum_of_four_products([one, two, three, four]: [(Self, Self); 4]) -> Self {
        Self::sum_of_products(one, two) + Self::sum_of_products(three, four)
    }

    /// The nearest number to a float of at most 1.
    fn from_correction(correction: Self::Correction) -> Self;

    /// A small angle as a float, rad.
    fn angle_to_correction(angle: Self::Angle) -> Self::Correction;

    /// The nearest angle to a small one in rad.
    fn angle_from_correction(rad: Self::Correction) -> Self::Angle;

    /// The nearest number to `length`, which is at most 1.
    fn length_from_f64(length: f64) -> Self;

    /// The nearest angle to `rad`, which is at most half a turn.
    fn angle_from_f64(rad: f64) -> Self::Angle;
}
