//! What a guide is off the drawing: a small angle and a distance.

use crate::scalar::Scalar;

/// A guide's small angle e off its drawn direction, and its line's distance from the platform's centre. What is turned
/// by the angle is changed by products with its sine and versine, which are exactly zero where they are: an ideal
/// machine keeps its bits.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct GuideError<T> {
    /// sin e.
    pub sine: T,
    /// 1 - cos e.
    pub versine: T,
    /// d0, track radii, to the guide's left.
    pub offset: T,
}

impl<T: Scalar> GuideError<T> {
    /// As drawn.
    pub const ZERO: Self = Self {
        sine: T::ZERO,
        versine: T::ZERO,
        offset: T::ZERO,
    };

    /// The vector turned by e: `(a cos e - b sin e, b cos e + a sin e)`.
    #[inline]
    #[must_use]
    pub fn turned(&self, [a, b]: [T; 2]) -> [T; 2] {
        [
            a - T::sum_of_products((self.versine, a), (self.sine, b)),
            b + T::sum_of_products((self.sine, a), (-self.versine, b)),
        ]
    }
}

impl GuideError<f64> {
    /// Of an angle in rad and a distance in track radii.
    #[must_use]
    pub fn new(error_rad: f64, offset: f64) -> Self {
        let half_sine = libm::sin(0.5 * error_rad);
        Self {
            sine: libm::sin(error_rad),
            versine: 2.0 * half_sine * half_sine,
            offset,
        }
    }
}

impl<T> GuideError<T> {
    /// The same in another number type: positions may be solved in one type and rates in another.
    #[must_use]
    pub fn map<U>(self, cast: impl Fn(T) -> U) -> GuideError<U> {
        GuideError {
            sine: cast(self.sine),
            versine: cast(self.versine),
            offset: cast(self.offset),
        }
    }
}
