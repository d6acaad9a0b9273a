//! Sine and cosine of a fraction of a turn, to the last bit or so of [`Fixed`].
//!
//! The turn is cut into quadrants centred on 0, 90, 180 and 270 deg; with y in [-1, 1) standing for the offset from the
//! centre in units of 45 deg and z = y^2,
//!
//! ```text
//! sin(pi/4 y) = y S(z),  cos(pi/4 y) = C(z)
//! ```
//!
//! S and C are minimax polynomials of degree 4 in z, found with the Remez exchange in 50-digit arithmetic (largest
//! error 3.4e-12 and 4.7e-11). Coefficient k is stored times 2^(s0 + 2k): z carries 30 fraction bits and a
//! multiplication keeps the upper 32 of 64, so each Horner step moves the point by two.

use super::fixed::Fixed;
use super::multiply;
use kinematics::Angle;

/// S(z), coefficient k times 2^(31 + 2k).
const SINE: [i32; 5] = [1_686_629_713, -693_598_667, 85_569_259, -5_026_472, 169_873];
/// C(z), coefficient k times 2^(30 + 2k).
const COSINE: [i32; 5] = [
    1_073_741_824,
    -1_324_675_869,
    272_375_234,
    -22_398_331,
    970_267,
];

/// Coefficients times powers of z, highest first (a chain of SMMLA on the chip).
#[inline]
pub(super) fn horner<const N: usize>(coefficients: &[i32; N], z: i32) -> i32 {
    let mut sum = coefficients[N - 1];
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = multiply::add_high(coefficients[k], sum, z);
    }
    sum
}

/// Sine and cosine of an angle as floats: for planning, a call, where the tick has it written out.
#[inline(never)]
pub fn sin_cos_f32(angle: Angle) -> (f32, f32) {
    let (sin, cos) = sin_cos(angle.fraction());
    (sin.to_f32(), cos.to_f32())
}

/// Sine and cosine of `fraction` / 2^32 turns. Error under 1.7e-9, checked in the tests.
#[inline]
pub(super) fn sin_cos(fraction: u32) -> (Fixed, Fixed) {
    const EIGHTH: u32 = 1 << 29;
    let shifted = fraction.wrapping_add(EIGHTH);
    let quadrant = shifted >> 30;
    // Offset from the quadrant's centre: 45 deg is 2^29 units of angle, here 2^31.
    let y = (fraction.wrapping_sub(quadrant << 30) << 2) as i32;
    let z = multiply::add_high(0, y, y);
    let sine = multiply::add_product(1 << 32, horner(&SINE, z), y) >> 33;
    let cosine = horner(&COSINE, z).wrapping_add(1) >> 1;
    let (sine, cosine) = if quadrant & 1 == 0 {
        (sine as i32, cosine)
    } else {
        (cosine, (sine as i32).wrapping_neg())
    };
    if quadrant & 2 == 0 {
        (Fixed::from_bits(sine), Fixed::from_bits(cosine))
    } else {
        (
            Fixed::from_bits(sine.wrapping_neg()),
            Fixed::from_bits(cosine.wrapping_neg()),
        )
    }
}

/// Sine over y and cosine of y quarter turns, in powers of y^2: minimax, as above (largest error 1.2e-6 and 6.7e-6).
const SHORT_SINE: [f32; 4] = [1.570_795_2, -0.645_925_94, 0.079_500_65, -0.004_371_015];
const SHORT_COSINE: [f32; 4] = [0.999_993_3, -1.233_484_5, 0.252_580_23, -0.019_095_736];

/// Sine and cosine of `fraction` / 2^32 turns to 7e-6: for voltages, which a count of the PWM rounds more. From half turn to half
/// turn in floats it takes two thirds of the cycles of the one to the last bit.
#[inline]
pub fn sin_cos_short(fraction: u32) -> (f32, f32) {
    const PER_QUARTER: f32 = 1.0 / 2_147_483_648.0;
    let y = (fraction << 1) as i32 as f32 * PER_QUARTER;
    let z = y * y;
    let [s0, s1, s2, s3] = SHORT_SINE;
    let [c0, c1, c2, c3] = SHORT_COSINE;
    let sine = y * (s0 + z * (s1 + z * (s2 + z * s3)));
    let cosine = c0 + z * (c1 + z * (c2 + z * c3));
    // Nearer to half a turn than to none.
    if fraction.wrapping_add(1 << 30) >> 31 == 0 {
        (sine, cosine)
    } else {
        (-sine, -cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far sine and cosine are off the exact ones at most, all round.
    fn worst(sin_cos: impl Fn(u32) -> (f64, f64)) -> f64 {
        let mut worst = 0f64;
        // A step coprime to 2^32 visits every region and every low bit.
        let mut fraction = 0u32;
        for _ in 0..2_000_000 {
            fraction = fraction.wrapping_add(2_654_435_769);
            let (sine, cosine) = sin_cos(fraction);
            let exact = f64::from(fraction) / 4_294_967_296.0 * core::f64::consts::TAU;
            worst = worst
                .max((sine - exact.sin()).abs())
                .max((cosine - exact.cos()).abs());
        }
        worst
    }

    #[test]
    fn the_short_ones_are_within_7e_6_all_round() {
        let worst = worst(|fraction| {
            let (sine, cosine) = sin_cos_short(fraction);
            (sine.into(), cosine.into())
        });
        assert!(worst < 7.0e-6, "worst {worst:e}");
    }

    #[test]
    fn is_within_1_7e_9_of_the_exact_functions_all_round() {
        let worst = worst(|fraction| {
            let (sine, cosine) = sin_cos(fraction);
            (sine.to_f64(), cosine.to_f64())
        });
        assert!(worst < 1.7e-9, "worst {worst:e}");
    }

    #[test]
    fn is_exact_at_the_quarter_turns() {
        let one = 1 << Fixed::FRACTION_BITS;
        let expected = [(0, one), (one, 0), (0, -one), (-one, 0)];
        for (quarter, (sine, cosine)) in expected.into_iter().enumerate() {
            let got = sin_cos((quarter as u32) << 30);
            assert_eq!(
                (got.0.bits(), got.1.bits()),
                (sine, cosine),
                "quarter {quarter}"
            );
        }
    }
}
