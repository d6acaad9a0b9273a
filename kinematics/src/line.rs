//! The six numbers of a pivot that have a closed form: ring's centre and radius, guide's direction and offset,
//! encoder's zero.
//!
//! With `u` and `n` along and across the guide's true direction `t = theta + g + e`:
//!
//! ```text
//! D = (n . (C - a) + d0) / R,    psi = t + asin D,    rho = R cos(psi - t) - u . (C - a)
//! ```
//!
//! Nothing is computed anew: every error enters as a sum of products that is exactly zero where the error is. So an
//! ideal machine has the bits of [`inverse`](crate::inverse()), in every number type.

use crate::coefficients::PivotCoefficients;
use crate::corrected_scalar::CorrectedScalar;
use crate::guide_error::GuideError;
use crate::scalar::Scalar;

/// The six numbers of a pivot, as the formulas take them. Lengths are in track radii.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line<T: Scalar> {
    /// z.
    pub encoder_zero: T::Angle,
    /// e.
    pub guide_angle: T::Angle,
    /// Sine and versine of e, and d0.
    pub guide: GuideError<T>,
    /// a.
    pub ring_centre: [T; 2],
    /// R - 1.
    pub radius_error: T,
    /// 1/R - 1.
    pub inverse_radius_error: T,
}

/// A guide's line as seen from its ring's centre.
#[derive(Clone, Copy)]
pub(crate) struct Sight<T> {
    /// Cosine and sine of its direction.
    pub(crate) direction: [T; 2],
    /// `n . (C - a) + d0` and `u . (C - a)`.
    pub(crate) offset: T,
    pub(crate) projection: T,
    /// D.
    pub(crate) sine: T,
}

impl<T: Scalar> Line<T> {
    /// As drawn.
    pub const IDEAL: Self = Self {
        encoder_zero: T::ANGLE_ZERO,
        guide_angle: T::ANGLE_ZERO,
        guide: GuideError::ZERO,
        ring_centre: [T::ZERO; 2],
        radius_error: T::ZERO,
        inverse_radius_error: T::ZERO,
    };

    /// From the drawn guide's direction, and what the track's centre sees of it.
    #[inline]
    pub(crate) fn sight(&self, (cos, sin): (T, T), offset: T, projection: T) -> Sight<T> {
        let [a_x, a_y] = self.ring_centre;
        let from_ring = [
            offset - T::sum_of_products((a_y, cos), (-a_x, sin)),
            projection - T::sum_of_products((a_x, cos), (a_y, sin)),
        ];
        let [offset, projection] = self.guide.turned(from_ring);
        let offset = offset + self.guide.offset;
        Sight {
            direction: self.guide.turned([cos, sin]),
            offset,
            projection,
            sine: offset + self.inverse_radius_error * offset,
        }
    }

    /// A part of the unit circle on the ring's.
    #[inline]
    pub(crate) fn on_ring(&self, length: T) -> T {
        length + self.radius_error * length
    }
}

impl<T: CorrectedScalar> Line<T> {
    /// The nearest to these coefficients, which are within their limits
    /// ([`check_coefficients`](crate::check_coefficients)).
    #[must_use]
    pub fn new(coefficients: &PivotCoefficients) -> Self {
        let radius_error = coefficients.radius_error;
        Self {
            encoder_zero: T::angle_from_f64(coefficients.encoder_zero_rad),
            guide_angle: T::angle_from_f64(coefficients.guide_error_rad),
            guide: GuideError::new(coefficients.guide_error_rad, coefficients.guide_offset),
            ring_centre: coefficients.ring_centre.map(T::length_from_f64),
            radius_error: T::length_from_f64(radius_error),
            inverse_radius_error: T::length_from_f64(-radius_error / (1.0 + radius_error)),
        }
    }
}
