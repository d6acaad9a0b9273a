//! Products and quotients of numbers of up to 128 bits.
//!
//! The quotient does without the library's division, which goes bit by bit: some 3,000 instructions on the chip. A
//! float's guess has 22 of its bits; what they leave is divided in turn. By a short divisor 64 bits are divided in digits of
//! 16, three instructions of the chip.

use super::float::{i64_to_f32_fast, i128_to_f32_fast};
use core::num::{NonZeroU16, NonZeroU32};

/// Guesses that 64 bits take.
const ROUNDS: usize = 4;
/// Exponent field of a float of 2^23, whose mantissa is the number; and the mantissa's bits, the first of which is not
/// kept.
const WHOLE: i32 = 150;
const MANTISSA: u32 = (1 << 23) - 1;

/// `numerator` / `divisor` (positive), off by less than 2, and what it leaves. `None` if it has more than 62 bits.
pub fn quotient(numerator: i128, divisor: i128) -> Option<(i64, i128)> {
    const MOST: f32 = (1_u64 << 62) as f32;
    let over = 1.0 / any_i128_to_f32_fast(divisor);
    let (mut quotient, mut rest) = (0_i64, numerator);
    for _ in 0..ROUNDS {
        let guess = any_i128_to_f32_fast(rest) * over;
        // Nor is a NaN below it.
        if !(guess.abs() < MOST) {
            return None;
        }
        let (part, shift) = split(guess.abs());
        if part == 0 {
            break;
        }
        let taken = mul_i128_u32(divisor, part) << shift;
        let part = i64::from(part) << shift;
        if guess < 0.0 {
            rest += taken;
            quotient -= part;
        } else {
            rest -= taken;
            quotient += part;
        }
    }
    Some((quotient, rest))
}

/// `value` / `divisor` rounded towards zero, exactly; zero over zero.
#[inline(never)]
pub fn divide(value: i64, divisor: i64) -> i64 {
    let Some(short) = u16::try_from(divisor).ok().and_then(NonZeroU16::new) else {
        return value.checked_div(divisor).unwrap_or(0);
    };
    let short = NonZeroU32::from(short);
    let size = value.unsigned_abs();
    let (high, low) = ((size >> 32) as u32, size as u32);
    let (first, rest) = (high / short, high % short);
    let upper = rest << 16 | low >> 16;
    let (second, rest) = (upper / short, upper % short);
    let third = (rest << 16 | low & 0xFFFF) / short;
    // The first two digits have 16 bits and more, the third one has no more than 16.
    let quotient = (i64::from(first) << 32) + (i64::from(second) << 16) + i64::from(third);
    if value < 0 {
        quotient.wrapping_neg()
    } else {
        quotient
    }
}

/// The product.
#[inline]
pub fn mul_i64_u32(value: i64, factor: u32) -> i128 {
    let low = u64::from(value as u32) * u64::from(factor);
    let high = (value >> 32) * i64::from(factor) + (low >> 32) as i64;
    (i128::from(high) << 32) | i128::from(low as u32)
}

/// The product modulo 2^128.
#[inline]
pub fn mul_i128_u32(value: i128, factor: u32) -> i128 {
    let factor = u64::from(factor);
    let (low, high) = (value as u64, (value >> 64) as u64);
    let first = u64::from(low as u32) * factor;
    let second = (low >> 32) * factor + (first >> 32);
    let third = high.wrapping_mul(factor).wrapping_add(second >> 32);
    (i128::from(third as i64) << 64) | i128::from(second << 32 | first & 0xFFFF_FFFF)
}

/// Any number as a float, to 22 bits.
fn any_i128_to_f32_fast(value: i128) -> f32 {
    const UPPER: f32 = 18_446_744_073_709_551_616.0;
    if (value >> 103) == (value >> 127) {
        i128_to_f32_fast(value)
    } else {
        i64_to_f32_fast((value >> 64) as i64) * UPPER
    }
}

/// A number below 2^63, rounded down, as 24 bits and a shift.
fn split(value: f32) -> (u32, u32) {
    let bits = value.to_bits();
    let exponent = (bits >> 23) as i32 - WHOLE;
    if exponent < 0 {
        (value as u32, 0)
    } else {
        (bits & MANTISSA | (MANTISSA + 1), exponent as u32)
    }
}

#[cfg(test)]
mod tests {
    use crate::wide_integer::*;

    /// Numbers of all lengths, with bits all over.
    fn numbers(most: u32) -> impl Iterator<Item = i128> {
        const BITS: i128 = 0x5A17_93C4_E86B_2D0F_71A5_3C9E_48B6_D2F3;
        (1..=most).flat_map(|bits| [BITS >> (127 - bits), (1 << bits) - 1, 1 << (bits - 1)])
    }

    #[test]
    fn it_is_the_quotient_within_two_and_the_rest_is_exact() {
        for numerator in numbers(120).flat_map(|n| [n, -n]) {
            for divisor in numbers(120) {
                let right = numerator / divisor;
                match quotient(numerator, divisor) {
                    Some((near, rest)) => {
                        assert_eq!(i128::from(near) * divisor + rest, numerator);
                        assert!(
                            (i128::from(near) - right).abs() < 2,
                            "{numerator} / {divisor}: {near}"
                        );
                    }
                    None => assert!(right.abs() >= (1 << 62) - (1 << 40), "{right}"),
                }
            }
        }
    }

    #[test]
    fn a_short_divisor_divides_as_any_other() {
        let values = numbers(63).map(|value| value as i64);
        for value in values
            .flat_map(|value| [value, -value])
            .chain([0, i64::MIN])
        {
            for divisor in [1, 2, 3, 7, 6_000, 40_001, 65_535, 65_536, 1 << 40, -5] {
                assert_eq!(
                    divide(value, divisor),
                    value / divisor,
                    "{value} / {divisor}"
                );
            }
            assert_eq!(divide(value, 0), 0);
        }
    }
}
