//! `f64` and `f32` as scalars, with angles in radians.
//!
//! The elementary functions are `libm`'s on every platform, so that host and target agree to the bit.

use crate::corrected_scalar::CorrectedScalar;
use crate::scalar::{Real, Scalar};

macro_rules! impl_float {
    ($float:ident, $sincos:path, $asin:path, $atan2:path, $sqrt:path, $round:path) => {
        impl Scalar for $float {
            type Angle = $float;

            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const THIRD: Self = 1.0 / 3.0;
            #[allow(clippy::excessive_precision, reason = "the digits are those of f64")]
            const SIN_60: Self = 0.866_025_403_784_438_6;
            const ANGLE_ZERO: Self = 0.0;
            const ANGLE_30: Self = core::$float::consts::FRAC_PI_6;
            const ANGLE_120: Self = 2.0 * core::$float::consts::FRAC_PI_3;

            fn sin_cos(angle: Self) -> (Self, Self) {
                $sincos(angle)
            }

            fn asin_cos(sines: [Self; 3]) -> Option<[(Self, Self); 3]> {
                // The product keeps its digits near the ends, where 1 - sine^2 loses them.
                (sines.iter().all(|&sine| -1.0 < sine && sine < 1.0))
                    .then(|| sines.map(|sine| ($asin(sine), $sqrt((1.0 - sine) * (1.0 + sine)))))
            }

            fn polar(re: Self, im: Self) -> Option<(Self, Self, Self)> {
                let squared = re * re + im * im;
                // Shorter than the square root of epsilon, a sum of unit vectors keeps less than half its digits.
                if !(Self::EPSILON..=Self::MAX).contains(&squared) {
                    return None;
                }
                let scale = 1.0 / $sqrt(squared);
                let angle = $atan2(im, re);
                let half_turn = core::$float::consts::PI;
                let angle = if angle <= -half_turn {
                    half_turn
                } else {
                    angle
                };
                Some((angle, re * scale, im * scale))
            }

            fn near(angle: Self, reference: Self) -> Self {
                let turn = core::$float::consts::TAU;
                angle + turn * $round((reference - angle) / turn)
            }

            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }

            fn angle_is_finite(angle: Self) -> bool {
                angle.is_finite()
            }
        }

        impl CorrectedScalar for $float {
            type Correction = Self;

            fn to_correction(self) -> Self {
                self
            }

            fn from_correction(correction: Self) -> Self {
                correction
            }

            fn angle_to_correction(angle: Self) -> Self {
                angle
            }

            fn angle_from_correction(rad: Self) -> Self {
                rad
            }

            fn length_from_f64(length: f64) -> Self {
                length as $float
            }

            fn angle_from_f64(rad: f64) -> Self {
                rad as $float
            }
        }

        impl Real for $float {
            const EPSILON: Self = $float::EPSILON;

            fn from_f64(value: f64) -> Self {
                value as $float
            }

            fn to_f64(self) -> f64 {
                self as f64
            }

            fn sqrt(self) -> Self {
                $sqrt(self)
            }
        }
    };
}

impl_float!(
    f64,
    libm::sincos,
    libm::asin,
    libm::atan2,
    libm::sqrt,
    libm::rint
);
impl_float!(
    f32,
    libm::sincosf,
    libm::asinf,
    libm::atan2f,
    libm::sqrtf,
    libm::rintf
);
