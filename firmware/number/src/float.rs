//! Single precision without the library's detours: conversions, roundings and comparisons that the chip does in a few
//! instructions, the same bits on a desktop.

use super::root::sqrt_f32;

/// 2^32.
const UPPER: f32 = 4_294_967_296.0;

/// A count of ticks as a float: hardware, unless it is longer than 32 bits.
#[inline]
pub fn ticks_to_f32(ticks: u64) -> f32 {
    match u32::try_from(ticks) {
        Ok(ticks) => ticks as f32,
        Err(_) => long_ticks_to_f32(ticks),
    }
}

/// A whole number as a float, 1.5 units in the last place off at most: two conversions in hardware, where the correctly
/// rounded one is a call.
#[inline]
pub fn i64_to_f32_fast(value: i64) -> f32 {
    let (high, low) = ((value >> 32) as i32, value as i32);
    // Small numbers are small whatever their sign: what is negative below is one more above.
    let carry = low as u32 >> 31;
    (high as f32 + carry as f32) * UPPER + low as f32
}

/// The same of one of up to 103 bits, a thousand million turns; beyond 63 the last forty do not count.
#[inline(never)]
pub fn i128_to_f32_fast(value: i128) -> f32 {
    const CUT: u32 = 40;
    match i64::try_from(value) {
        Ok(value) => i64_to_f32_fast(value),
        Err(_) => i64_to_f32_fast((value >> CUT) as i64) * (1_u64 << CUT) as f32,
    }
}

/// A float rounded up to a count of ticks; zero for what is not positive.
#[inline]
pub fn ceil_ticks(duration: f32) -> u64 {
    if duration < UPPER {
        let down = duration as u32;
        u64::from(down) + u64::from(duration > down as f32)
    } else {
        long_f32_to_ticks(duration)
    }
}

/// A duration rounded up to a whole one; zero for what is not positive.
#[inline]
pub fn ceil(duration: f32) -> f32 {
    let whole = floor(duration);
    if duration > whole { whole + 1.0 } else { whole }
}

/// The same rounded down.
#[inline]
pub fn floor(duration: f32) -> f32 {
    // Beyond 2^23 there are whole numbers only.
    if duration < UPPER {
        (duration as u32) as f32
    } else {
        duration
    }
}

/// The same beyond 32 bits, days long, where the chip has no instruction for it.
#[cold]
#[inline(never)]
fn long_ticks_to_f32(ticks: u64) -> f32 {
    ticks as f32
}

#[cold]
#[inline(never)]
fn long_f32_to_ticks(duration: f32) -> u64 {
    duration as u64
}

/// A float without its fraction; it has to be within 63 bits.
#[inline]
pub fn truncate(value: f32) -> i64 {
    const MOST: f32 = UPPER / 2.0;
    if value.abs() < MOST {
        i64::from(value as i32)
    } else {
        value as i64
    }
}

/// A double without its fraction, a number; beyond 63 bits the largest. The compiler's conversion is made of four calls.
pub fn truncate_f64(value: f64) -> i64 {
    const MANTISSA: u32 = 52;
    let bits = value.to_bits();
    let exponent = (bits >> MANTISSA & 0x7FF) as i32 - 0x3FF;
    let mantissa = (bits & ((1 << MANTISSA) - 1) | 1 << MANTISSA) as i64;
    let size = match exponent {
        ..0 => 0,
        0..52 => mantissa >> (52 - exponent),
        52..63 => mantissa << (exponent - 52),
        _ => i64::MAX,
    };
    if value.is_sign_negative() {
        size.wrapping_neg()
    } else {
        size
    }
}

/// A float rounded to a whole number within 31 bits, which is hardware.
#[inline]
pub fn round_i32(value: f32) -> i32 {
    if value.abs() < 8_388_608.0 {
        (value + if value < 0.0 { -0.5 } else { 0.5 }) as i32
    } else {
        value as i32
    }
}

/// A float rounded up, within 31 bits.
#[inline]
pub fn ceil_i32(value: f32) -> i32 {
    let down = value as i32;
    down + i32::from(value > down as f32)
}

/// The greater and the smaller of two numbers in four instructions: `f32::max` is a call on the chip, which has no
/// instruction for what the standard asks of it. What is not a number stays what it is on the left, and counts for
/// nothing on the right.
pub trait FloatMinMax: PartialOrd + Sized {
    #[inline]
    /// The greater of two.
    fn fmax(self, other: Self) -> Self {
        if self < other { other } else { self }
    }

    #[inline]
    /// The smaller of two.
    fn fmin(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
}

impl FloatMinMax for f32 {}

/// Length of a vector.
#[inline]
pub fn hypot(x: f32, y: f32) -> f32 {
    sqrt_f32(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use crate::float::*;

    #[test]
    fn fast_conversions_are_near_the_right_ones() {
        for bits in 0..64 {
            for value in [
                1_i64 << bits,
                (1_i64 << bits).wrapping_sub(1),
                (5 << bits) / 7,
                0x5A5A_5A5A_5A5A_5A5A >> bits,
            ] {
                for value in [value, -value.wrapping_add(3), i64::MAX, i64::MIN] {
                    let (near, right) = (f64::from(i64_to_f32_fast(value)), value as f64);
                    assert!(
                        (near - right).abs() <= right.abs() * 1.0e-7,
                        "{value} {near}"
                    );
                    let long = i128::from(value) << 38;
                    let (near, right) = (f64::from(i128_to_f32_fast(long)), long as f64);
                    assert!(
                        (near - right).abs() <= right.abs() * 1.0e-7,
                        "{long} {near}"
                    );
                }
            }
        }
    }

    #[test]
    fn short_numbers_are_rounded_as_they_say() {
        for value in [0.0_f32, 0.25, 0.75, 1.0, 2.6, 4_194_303.4, 8_388_609.0, 2e9] {
            for value in [value, -value] {
                let near = round_i32(value);
                assert_eq!(f64::from(near), f64::from(value).round(), "{value}");
                assert_eq!(
                    f64::from(ceil_i32(value)),
                    f64::from(value).ceil(),
                    "{value}"
                );
            }
        }
        assert_eq!(ceil_i32(f32::NAN), 0);
    }

    #[test]
    fn a_double_is_cut_as_the_compiler_does() {
        let mut random = crate::random::Random::new(3);
        for _ in 0..100_000 {
            let value = random.bits(64) as f64 * 2.0_f64.powi(-(random.bits(8).abs() as i32));
            assert_eq!(truncate_f64(value), value as i64, "{value:e}");
        }
        for value in [0.0, -0.0, 0.5, -0.5, 1.0, -1.0, 2.0_f64.powi(53) + 2.0] {
            assert_eq!(truncate_f64(value), value as i64, "{value:e}");
        }
        assert_eq!(truncate_f64(1e300), i64::MAX);
    }
}
