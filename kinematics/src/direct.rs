//! Direct position: the pose that three pivots set, and its rates.

use core::fmt;

use crate::guide::Guide;
use crate::inverse::InverseError;
use crate::jacobian::jacobian_inverse;
use crate::pose::{Pose, Twist};
use crate::scalar::{Real, Scalar};

/// Why three pivots set no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DirectError {
    /// A pivot's angle is NaN or infinite.
    NotFinite,
    /// `S1 = 0`: the pivots coincide, or stand evenly spaced in the wrong order. Any orientation would do.
    Singular,
    /// This guide (1 to 3) would have to reach backwards, `rho_i <= 0`: the triangle of pivots has an angle of 120 deg
    /// or more at this pivot, or the pivots stand in the wrong order.
    ReversedGuide {
        /// The guide, 1 to 3; the first if there are several.
        guide: usize,
    },
    /// The pose of a built machine's encoders lies on or outside the track.
    OutsideTrack,
}

impl fmt::Display for DirectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a pivot angle is not finite"),
            Self::Singular => f.write_str("the pivots set no orientation"),
            Self::ReversedGuide { guide } => write!(
                f,
                "the triangle of pivots is too wide at pivot {guide} (120 deg or more), or the pivots are out of order"
            ),
            Self::OutsideTrack => InverseError::OutsideTrack.fmt(f),
        }
    }
}

impl core::error::Error for DirectError {}

impl From<InverseError> for DirectError {
    fn from(error: InverseError) -> Self {
        match error {
            InverseError::NotFinite => Self::NotFinite,
            InverseError::OutsideTrack => Self::OutsideTrack,
        }
    }
}

/// A complex number: the pivots as points, and their transform.
#[derive(Clone, Copy)]
struct Complex<T> {
    re: T,
    im: T,
}

impl<T: Scalar> Complex<T> {
    fn on_track(angle: T::Angle) -> Self {
        let (im, re) = T::sin_cos(angle);
        Self { re, im }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }

    fn minus(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }

    fn times(self, other: Self) -> Self {
        Self {
            re: T::sum_of_products((self.re, other.re), (-self.im, other.im)),
            im: T::sum_of_products((self.re, other.im), (self.im, other.re)),
        }
    }

    fn scaled(self, factor: T) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }

    fn half(self) -> Self {
        Self {
            re: self.re.half(),
            im: self.im.half(),
        }
    }

    fn conjugate(self) -> Self {
        Self {
            re: self.re,
            im: -self.im,
        }
    }
}

/// The pose that the pivots phi_1 to phi_3 (multi-turn) set.
///
/// # Errors
/// [`DirectError`] for pivots that are not finite or that no platform inside the track can hold.
pub fn direct<T: Scalar>(pivots: &[T::Angle; 3]) -> Result<Pose<T>, DirectError> {
    if !pivots.iter().all(|&pivot| T::angle_is_finite(pivot)) {
        return Err(DirectError::NotFinite);
    }
    let [z1, z2, z3] = pivots.map(Complex::<T>::on_track);
    // S1 and S2 differ only in the sign of the part across z2 - z3.
    let along = z1.minus(z2.plus(z3).half());
    let across = Complex {
        re: z2.im - z3.im,
        im: z3.re - z2.re,
    }
    .scaled(T::SIN_60);
    let s0 = z1.plus(z2).plus(z3);
    let s1 = along.plus(across);
    let s2 = along.minus(across);

    let (direction_1, re, im) = T::polar(s1.re, s1.im).ok_or(DirectError::Singular)?;
    let u = Complex { re, im };
    // rho_1 + w rho_2 + conj(w) rho_3, the guides' lengths without their mean.
    let imbalance = u.times(s2.conjugate());
    check_lengths(T::sum_of_products((s1.re, u.re), (s1.im, u.im)), imbalance)?;

    // 3 C: with every length positive the centre is inside the track, so this is below 3.
    let centre = s0.minus(u.times(imbalance)).scaled(T::THIRD);
    // phi_1 is within 90 deg of theta_1 whatever the pose, so it alone settles the turn; no mean, no division.
    let theta = T::near(direction_1 + T::ANGLE_30, pivots[0] + T::ANGLE_30);
    Ok(Pose {
        x: centre.re,
        y: centre.im,
        theta,
    })
}

/// Every guide's length is positive. `total` is their sum |S1|, and `3 rho_i = total + 2 Re(conj(w)^(i-1) imbalance)`;
/// compared, not summed, since the sum may leave the range of a fixed-point number.
fn check_lengths<T: Scalar>(total: T, imbalance: Complex<T>) -> Result<(), DirectError> {
    let half_total = total.half();
    let (half_re, wide_im) = (imbalance.re.half(), imbalance.im * T::SIN_60);
    let lacking = [-imbalance.re, half_re - wide_im, half_re + wide_im];
    match lacking.iter().position(|&lack| lack >= half_total) {
        Some(index) => Err(DirectError::ReversedGuide { guide: index + 1 }),
        None => Ok(()),
    }
}

/// The platform's velocity from the pivots' `rates` in rad/s, with the guides of the present pose.
pub fn direct_rates<T: Real>(guides: &[Guide<T>; 3], rates: &[T; 3]) -> Twist<T> {
    let inverse = jacobian_inverse(guides);
    let row = |index: usize| {
        inverse[(index, 0)] * rates[0]
            + inverse[(index, 1)] * rates[1]
            + inverse[(index, 2)] * rates[2]
    };
    Twist {
        x: row(0),
        y: row(1),
        theta: row(2),
    }
}
