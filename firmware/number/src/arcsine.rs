//! Arcsine, with the cosine that belongs to it.
//!
//! For d^2 <= 1/2, asin(d) = d P(d^2); beyond, asin(d) = +-(90 deg - c P(c^2)) with c = sqrt(1 - d^2), which the
//! velocity equations need anyway. P gives turns; it is a minimax polynomial of degree 9 on [0, 1/2], found with the
//! Remez exchange in 50-digit arithmetic (largest error of P 5.2e-11 turns).
//!
//! Three at a time: a coefficient takes two instructions to load and one to use.

use super::fixed::Fixed;
use super::{multiply, root};
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

const ONE: u32 = 1 << 29;
const ONE_SQUARED: i64 = 1 << 58;
/// The last number under sqrt(1/2): its square and that of its complement, under a half, fit 32 fraction bits.
const ROOT_OF_HALF: u32 = 379_625_062;
const QUARTER_TURN: i32 = 1 << 30;

/// asin(d) and sqrt(1 - d^2) of three; `None` unless every |d| < 1. Error of the angles under 4e-9 rad, the
/// conditioning of the second form near |d| = 1 aside.
// Inlined into the loop's two inverse kinematics: calls and results through memory would cost both.
#[inline(always)]
pub(super) fn asin_cos(d: [Fixed; 3]) -> Option<[(Angle, Fixed); 3]> {
    let [d_1, d_2, d_3] = d;
    let one = Argument::new(d_1)?;
    let two = Argument::new(d_2)?;
    let three = Argument::new(d_3)?;
    let arguments = [one, two, three];
    let turns = horner(arguments.map(|argument| argument.square));
    Some([0, 1, 2].map(|i| {
        let Argument { s, offset, .. } = arguments[i];
        // With the sign of `s` in the second form, 90 deg less the angle for one and more for the other is one
        // difference. The two bits that `s` has to spare bring the product to where its upper half is the angle.
        let angle = multiply::add_high_rounded(offset, s << 2, turns[i]);
        (Angle::from_units(i64::from(angle)), arguments[i].cosine)
    }))
}

/// What one arcsine is computed from.
#[derive(Clone, Copy)]
struct Argument {
    /// What the polynomial is multiplied by, and what is added to the product.
    s: i32,
    offset: i32,
    /// Argument of the polynomial, 32 fraction bits.
    square: i32,
    cosine: Fixed,
}

impl Argument {
    #[inline]
    fn new(d: Fixed) -> Option<Self> {
        let size = d.bits().unsigned_abs();
        if size >= ONE {
            return None;
        }
        let square = Fixed::add_product(0, d, d);
        let rest = ONE_SQUARED - square;
        let cosine = root::sqrt_fixed(rest);
        let (s, offset, square) = if size <= ROOT_OF_HALF {
            (d.bits(), 0, square)
        } else {
            across(d, cosine, rest)
        };
        let square = (square >> 26) as i32;
        Some(Self {
            s,
            offset,
            square,
            cosine,
        })
    }
}

/// The second form's part. In the outer third of the disk, and there for one pivot at a time as a rule: so it is
/// branched to.
#[cold]
fn across(d: Fixed, cosine: Fixed, rest: i64) -> (i32, i32, i64) {
    if d.bits() < 0 {
        (cosine.bits(), -QUARTER_TURN, rest)
    } else {
        (-cosine.bits(), QUARTER_TURN, rest)
    }
}

/// P of three arguments, step by step.
#[inline]
fn horner(z: [i32; 3]) -> [i32; 3] {
    let mut sums = [TURNS[TURNS.len() - 1]; 3];
    let mut k = TURNS.len() - 1;
    while k > 0 {
        k -= 1;
        sums = [0, 1, 2].map(|i| multiply::add_high(TURNS[k], sums[i], z[i]));
    }
    sums
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
            let [(angle, cosine), ..] = asin_cos([d; 3]).unwrap();
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
            for place in 0..3 {
                let mut d = [Fixed::from_bits(0); 3];
                d[place] = Fixed::from_bits(bits);
                assert_eq!(asin_cos(d), None, "{bits}");
            }
        }
        assert!(asin_cos([Fixed::from_bits((1 << 29) - 1); 3]).is_some());
    }
}
