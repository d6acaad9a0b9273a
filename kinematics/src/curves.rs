//! The three curves of a pivot as the corrected kinematics ask for them: exact series on a host, tables in a control
//! loop.

use crate::corrected_scalar::CorrectedScalar;

/// A curve at one place.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct CurvePoint<R> {
    /// Its value.
    pub value: R,
    /// Its derivative by the place.
    pub slope: R,
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
