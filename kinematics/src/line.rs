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
//! ideal machine has the bits of [`inverse`](crate::inverse()), in every number type. With `d` and `q` across and along
//! the drawn direction, and b for the ring's centre a turned back by e:
//!
//! ```text
//! n . (C - a) = d - ((1 - cos e) d + sin e q + b_y cos - b_x sin)
//! u . (C - a) = q + (sin e d - (1 - cos e) q - b_x cos - b_y sin)
//! ```

use crate::coefficients::PivotCoefficients;
use crate::corrected_scalar::CorrectedScalar;
use crate::guide_error::GuideError;
use crate::inverse::GuideSeen;
use crate::scalar::{Real, Scalar};

/// The six numbers of a pivot, as the formulas take them. Lengths are in track radii.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line<T: CorrectedScalar> {
    /// z.
    pub encoder_zero: T::Angle,
    /// e.
    pub guide_angle: T::Angle,
    /// Sine and versine of e, and d0.
    pub guide: GuideError<T>,
    /// The same for rates.
    pub guide_for_rates: GuideError<T::Correction>,
    /// b: the ring's centre, turned by -e.
    pub ring_centre: [T; 2],
    /// R.
    pub radius: T::Correction,
    /// 1/R - 1.
    pub inverse_radius_error: T,
}

/// A guide's line as seen from its ring's centre.
#[derive(Clone, Copy)]
pub(crate) struct Sight<T> {
    /// Cosine and sine of the drawn direction.
    pub(crate) direction: (T, T),
    /// `n . (C - a) + d0` and `u . (C - a)`.
    pub(crate) offset: T,
    pub(crate) projection: T,
    /// D.
    pub(crate) sine: T,
}

impl<T: CorrectedScalar> Line<T> {
    /// As drawn.
    pub const IDEAL: Self = Self {
        encoder_zero: T::ANGLE_ZERO,
        guide_angle: T::ANGLE_ZERO,
        guide: GuideError::ZERO,
        guide_for_rates: GuideError::ZERO,
        ring_centre: [T::ZERO; 2],
        radius: T::Correction::ONE,
        inverse_radius_error: T::ZERO,
    };

    /// The nearest to these coefficients, which are within their limits
    /// ([`check_coefficients`](crate::check_coefficients)).
    #[must_use]
    pub fn new(coefficients: &PivotCoefficients) -> Self {
        let error_rad = coefficients.guide_error_rad;
        let radius_error = coefficients.radius_error;
        let guide = GuideError::new(error_rad, coefficients.guide_offset);
        let back = GuideError::new(-error_rad, 0.0);
        Self {
            encoder_zero: T::angle_from_f64(coefficients.encoder_zero_rad),
            guide_angle: T::angle_from_f64(error_rad),
            guide: guide.map(T::length_from_f64),
            guide_for_rates: guide.map(T::Correction::from_f64),
            ring_centre: back
                .turned(coefficients.ring_centre)
                .map(T::length_from_f64),
            radius: T::Correction::from_f64(1.0 + radius_error),
            inverse_radius_error: T::length_from_f64(-radius_error / (1.0 + radius_error)),
        }
    }

    /// From the drawn guide's direction, and what the track's centre sees of it.
    #[inline]
    pub(crate) fn sight(&self, seen: &GuideSeen<T>) -> Sight<T> {
        let GuideError { sine, versine, .. } = self.guide;
        let ([b_x, b_y], (cos, sin)) = (self.ring_centre, seen.direction);
        let (d, q) = (seen.offset, seen.projection);
        let across = T::sum_of_four_products([(versine, d), (sine, q), (b_y, cos), (-b_x, sin)]);
        let along = T::sum_of_four_products([(sine, d), (-versine, q), (-b_x, cos), (-b_y, sin)]);
        let offset = d - across + self.guide.offset;
        Sight {
            direction: seen.direction,
            offset,
            projection: q + along,
            sine: offset + self.inverse_radius_error * offset,
        }
    }
}
