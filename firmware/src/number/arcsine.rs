//! Arcsine, with the cosine that belongs to it.
//!
//! For d^2 <= 1/2, asin(d) = d P(d^2); beyond, asin(d) = +-(90 deg - c P(c^2)) with c = sqrt(1 - d^2), which the
//! velocity equations need anyway. P gives turns; it is a minimax polynomial of degree 9 on [0, 1/2], found with the Remez
//! exchange in 50-digit arithmetic (largest error of P 5.2e-11 turns).

use super::trigonometric::horner;
use super::{Fixed, root};
use kinematics::Angle;

/// P(z), coefficients times 2^33 (z carries 32 fraction bits: the point stays).
const TURNS: [i32; 10] = [
    1_367_130_551,
    227_855_262,
    102_524_146,
    61_289_855,
    38_402_854,
    52_234_860,
    -65_479_107,
    238_438_762,
    -287_229_214,
    204_584_506,
];

const ONE_SQUARED: i64 = 1 << 58;
const HALF_SQUARED: i64 = 1 << 57;
const QUARTER_TURN: i64 = 1 << 30;

/// s P(s^2) in 2^-32 turns, for 0 <= `square` <= 1/2 (58 fraction bits).
#[inline]
fn small(s: Fixed, square: i64) -> i64 {
    let z = ((square >> 26) as u32).min(i32::MAX as u32) as i32;
    (i64::from(s.bits()) * i64::from(horner(&TURNS, z)) + (1 << 29)) >> 30
}

/// asin(d) and sqrt(1 - d^2); `None` unless |d| < 1. Error of the angle under 4e-9 rad, the conditioning of the second form
/// near |d| = 1 aside.
#[inline]
pub(super) fn asin_cos(d: Fixed) -> Option<(Angle, Fixed)> {
    let square = i64::from(d.bits()) * i64::from(d.bits());
    let rest = ONE_SQUARED - square;
    if rest <= 0 {
        return None;
    }
    let cosine = root::sqrt_fixed(rest);
    let angle = if square <= HALF_SQUARED {
        small(d, square)
    } else {
        let complement = QUARTER_TURN - small(cosine, rest);
        if d.bits() < 0 {
            -complement
        } else {
            complement
        }
    };
    Some((Angle::from_units(angle), cosine))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_within_4e_9_of_the_exact_functions() {
        let mut worst = (0f64, 0f64);
        let one = 1i64 << Fixed::FRACTION_BITS;
        let mut bits = -(one as f64 * 0.96) as i64;
        while bits < (one as f64 * 0.96) as i64 {
            let d = Fixed::from_bits(bits as i32);
            let (angle, cosine) = asin_cos(d).unwrap();
            let exact = d.to_f64();
            worst.0 = worst.0.max((angle.radians() - exact.asin()).abs());
            worst.1 = worst
                .1
                .max((cosine.to_f64() - (1.0 - exact * exact).sqrt()).abs());
            bits += 997;
        }
        assert!(worst.0 < 4e-9 && worst.1 < 2e-9, "worst {worst:?}");
    }

    #[test]
    fn has_no_answer_at_one_and_beyond() {
        for bits in [1 << 29, -(1 << 29), (1 << 29) + 1, i32::MAX, i32::MIN] {
            assert_eq!(asin_cos(Fixed::from_bits(bits)), None, "{bits}");
        }
        assert!(asin_cos(Fixed::from_bits((1 << 29) - 1)).is_some());
    }
}
