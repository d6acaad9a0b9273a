//! The three curves of a pivot as exact series: Fourier over the ring's angle, Legendre over the guide.

use crate::coefficients::PivotCoefficients;
use crate::corrected_scalar::CorrectedScalar;
use crate::curves::{CurvePoint, Curves, RingErrors};
use crate::scalar::{Real, Scalar};

/// The straightness is a sum of Legendre polynomials of (rho - 1) over this.
const STRAIGHTNESS_SPAN: f64 = 0.8;
/// As far from 1 the polynomials are taken, some beyond a guide's mechanical ends: it goes on straight further out,
/// where they would grow without bounds.
const STRAIGHTNESS_REACH: f64 = 0.85;
/// Order of the runout's first pair.
const FIRST_RUNOUT: usize = 2;

/// Coefficients of the three curves, in the units of [`PivotCoefficients`].
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Series<T> {
    encoder_rad: [[T; 2]; 12],
    runout: [[T; 2]; 5],
    straightness: [T; 8],
}

impl<T: Real> Series<T> {
    /// No errors.
    pub const ZERO: Self = Self {
        encoder_rad: [[T::ZERO; 2]; 12],
        runout: [[T::ZERO; 2]; 5],
        straightness: [T::ZERO; 8],
    };

    /// The series of a pivot.
    #[must_use]
    pub fn new(coefficients: &PivotCoefficients) -> Self {
        let pair = |pair: [f64; 2]| pair.map(T::from_f64);
        Self {
            encoder_rad: coefficients.encoder_rad.map(pair),
            runout: coefficients.runout.map(pair),
            straightness: coefficients.straightness.map(T::from_f64),
        }
    }
}

impl<T: CorrectedScalar> Curves<T> for Series<T::Correction> {
    fn are_zero(&self) -> bool {
        let pairs = self.encoder_rad.iter().chain(&self.runout);
        (pairs.flatten().chain(&self.straightness)).all(|&number| number == T::Correction::ZERO)
    }

    #[inline(always)]
    fn ring_errors(&self, ring: T::Angle) -> RingErrors<T::Correction> {
        let (sine, cosine) = T::sin_cos(ring);
        let [cosine, sine] = [cosine, sine].map(T::to_correction);
        RingErrors {
            encoder: fourier(&self.encoder_rad, 1, [cosine, sine]),
            runout: fourier(&self.runout, FIRST_RUNOUT, [cosine, sine]),
        }
    }

    #[inline(always)]
    fn straightness(&self, rho: T::Correction) -> CurvePoint<T::Correction> {
        let per_radius = T::Correction::from_f64(1.0 / STRAIGHTNESS_SPAN);
        let reach = T::Correction::from_f64(STRAIGHTNESS_REACH);
        let place = rho - T::Correction::ONE;
        let inside = if place > reach {
            reach
        } else if place < -reach {
            -reach
        } else {
            place
        };
        let point = legendre(&self.straightness, inside * per_radius);
        let slope = point.slope * per_radius;
        CurvePoint {
            value: point.value + slope * (place - inside),
            slope,
        }
    }
}

/// The sum of `pair . (cos k psi, sin k psi)` from k = `first` on, from the cosine and sine of psi.
#[inline(always)]
fn fourier<T: Real>(pairs: &[[T; 2]], first: usize, [cosine, sine]: [T; 2]) -> CurvePoint<T> {
    let turned = |[c, s]: [T; 2]| [c * cosine - s * sine, s * cosine + c * sine];
    let (mut harmonic, mut order) = ([cosine, sine], T::ONE);
    for _ in 1..first {
        (harmonic, order) = (turned(harmonic), order + T::ONE);
    }
    let (mut value, mut slope) = (T::ZERO, T::ZERO);
    for &[a, b] in pairs {
        let [c, s] = harmonic;
        value = value + (a * c + b * s);
        slope = slope + order * (b * c - a * s);
        (harmonic, order) = (turned(harmonic), order + T::ONE);
    }
    CurvePoint { value, slope }
}

/// The sum of `sizes[k]` times the Legendre polynomial of order k + 2 at `x`, by Bonnet's recursion
/// `(n + 1) P(n+1) = (2 n + 1) x P(n) - n P(n-1)` and `P'(n+1) = P'(n-1) + (2 n + 1) P(n)`.
#[inline(always)]
fn legendre<T: Real>(sizes: &[T], x: T) -> CurvePoint<T> {
    let mut last = CurvePoint {
        value: T::ONE,
        slope: T::ZERO,
    };
    let mut this = CurvePoint {
        value: x,
        slope: T::ONE,
    };
    let (mut value, mut slope, mut n) = (T::ZERO, T::ZERO, T::ONE);
    for &size in sizes {
        let odd = n + n + T::ONE;
        let next = CurvePoint {
            value: (odd * x * this.value - n * last.value) / (n + T::ONE),
            slope: last.slope + odd * this.value,
        };
        value = value + size * next.value;
        slope = slope + size * next.slope;
        (last, this, n) = (this, next, n + T::ONE);
    }
    CurvePoint { value, slope }
}
