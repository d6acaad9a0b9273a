//! The three curves of a pivot as the corrected kinematics ask for them: exact series, or for a control loop what the
//! series are near one place.

use crate::corrected_scalar::CorrectedScalar;
use crate::scalar::{Real, Scalar};

/// A curve at one place.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct CurvePoint<R> {
    /// Its value.
    pub value: R,
    /// Its derivative by the place.
    pub slope: R,
}

impl<R: Real> CurvePoint<R> {
    /// No error.
    pub const ZERO: Self = Self {
        value: R::ZERO,
        slope: R::ZERO,
    };

    /// So much further on, along the tangent.
    #[inline]
    fn after(self, way: R) -> Self {
        Self {
            value: self.value + self.slope * way,
            slope: self.slope,
        }
    }
}

/// What goes with the ring's angle.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct RingErrors<R> {
    /// E, rad; slope in rad per rad.
    pub encoder: CurvePoint<R>,
    /// r, track radii; slope per rad.
    pub runout: CurvePoint<R>,
}

/// Encoder, runout and straightness of one pivot; see [`PivotCoefficients`](crate::PivotCoefficients).
pub trait Curves<T: CorrectedScalar> {
    /// Whether all three are zero everywhere.
    fn are_zero(&self) -> bool;

    /// E and r at an angle of the ring.
    fn ring_errors(&self, ring: T::Angle) -> RingErrors<T::Correction>;

    /// S at a place rho on the guide, both in track radii.
    fn straightness(&self, rho: T::Correction) -> CurvePoint<T::Correction>;
}

/// The curves of a pivot near one place: as straight lines. A control loop evaluates the series of a pivot once in some
/// periods, when it has time, and goes on along these in between.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Tangents<T: CorrectedScalar> {
    ring: T::Angle,
    errors: RingErrors<T::Correction>,
    rho: T::Correction,
    straightness: CurvePoint<T::Correction>,
}

impl<T: CorrectedScalar> Tangents<T> {
    /// No errors.
    pub const ZERO: Self = Self {
        ring: T::ANGLE_ZERO,
        errors: RingErrors {
            encoder: CurvePoint::ZERO,
            runout: CurvePoint::ZERO,
        },
        rho: T::Correction::ZERO,
        straightness: CurvePoint::ZERO,
    };

    /// Encoder and runout from an angle of the ring on, without straightness.
    pub fn of_ring<C: Curves<T>>(curves: &C, ring: T::Angle) -> Self {
        Self {
            ring,
            errors: curves.ring_errors(ring),
            ..Self::ZERO
        }
    }

    /// The same with the straightness from a place on the guide on.
    #[must_use]
    pub fn with_guide<C: Curves<T>>(self, curves: &C, rho: T::Correction) -> Self {
        Self {
            rho,
            straightness: curves.straightness(rho),
            ..self
        }
    }
}

impl<T: CorrectedScalar> Curves<T> for Tangents<T> {
    fn are_zero(&self) -> bool {
        let RingErrors { encoder, runout } = self.errors;
        [encoder, runout, self.straightness] == [CurvePoint::ZERO; 3]
    }

    #[inline]
    fn ring_errors(&self, ring: T::Angle) -> RingErrors<T::Correction> {
        // Curves have the same values in every turn.
        let way = T::angle_to_correction(T::near(ring, self.ring) - self.ring);
        RingErrors {
            encoder: self.errors.encoder.after(way),
            runout: self.errors.runout.after(way),
        }
    }

    #[inline]
    fn straightness(&self, rho: T::Correction) -> CurvePoint<T::Correction> {
        self.straightness.after(rho - self.rho)
    }
}
