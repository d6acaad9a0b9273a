//! Square roots: one instruction in f32 on the chip, and a corrected one in fixed point.

use super::fixed::Fixed;
use super::multiply;

#[cfg(target_arch = "arm")]
mod chip {
    // `core` has no square root on stable Rust, and libm's takes 60 instructions. Inline assembly can not name the
    // FPU's single registers on this target, so the instruction stands in a function of its own.
    core::arch::global_asm!(
        ".fpu fpv4-sp-d16",
        ".section .text.tripivot_sqrt_f32,\"ax\",%progbits",
        ".global tripivot_sqrt_f32",
        ".type tripivot_sqrt_f32,%function",
        ".thumb_func",
        "tripivot_sqrt_f32:",
        "vsqrt.f32 s0, s0",
        "bx lr",
        ".size tripivot_sqrt_f32, . - tripivot_sqrt_f32",
    );
    unsafe extern "C" {
        pub fn tripivot_sqrt_f32(value: f32) -> f32;
    }
}

/// Square root, correctly rounded (as IEEE 754 asks, hence the same everywhere).
#[inline]
pub fn sqrt_f32(value: f32) -> f32 {
    #[cfg(target_arch = "arm")]
    // SAFETY: one FPU instruction on the argument register; touches nothing else.
    unsafe {
        chip::tripivot_sqrt_f32(value)
    }
    #[cfg(not(target_arch = "arm"))]
    libm::sqrtf(value)
}

/// Cube root of a positive normal number, to two of its last bits: libm's f32 version computes in f64.
#[inline]
pub fn cbrt_f32(value: f32) -> f32 {
    // A third of the exponent, and of what the mantissa makes of it: within 4 %. Each Newton step squares that.
    let mut root = f32::from_bits(value.to_bits() / 3 + 709_921_077);
    for _ in 0..3 {
        root = (2.0 * root + value / (root * root)) * (1.0 / 3.0);
    }
    root
}

/// Square root of `square` / 2^58, for 2^28 <= `square` <= 2^58: a float's root and one Newton step, to about one LSB
/// of [`Fixed`] for results over 0.05.
#[inline]
pub(super) fn sqrt_fixed(square: i64) -> Fixed {
    const UP_TO_FIXED: f32 = (1u32 << 14) as f32;
    // 2^30 times the square fits a float's exponent and an i32; its root is 2^15 times the root.
    let rough = sqrt_f32((square >> 28) as i32 as f32) * UP_TO_FIXED;
    let root = rough as i32;
    let residue = multiply::add_product(square, -root, root);
    let correction = (residue >> 8) as i32 as f32 * 128.0 / rough;
    Fixed::from_bits(root.wrapping_add(round_ties_even(correction).0))
}

/// Nearest integer (of two, the even one), as an integer and as a float, for values within +-2^21.
///
/// So far up the floats are the integers: adding the offset rounds, and the low bits of the sum are the result.
#[inline]
pub fn round_ties_even(value: f32) -> (i32, f32) {
    const OFFSET: f32 = 12_582_912.0; // 1.5 times 2^23
    const SPARE_BITS: u32 = 10;
    let sum = value + OFFSET;
    (
        (sum.to_bits() << SPARE_BITS) as i32 >> SPARE_BITS,
        sum - OFFSET,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_to_the_nearest_even_up_to_its_range() {
        for k in -2_097_151..2_097_151 {
            let value = k as f32 + 0.25;
            assert_eq!(round_ties_even(value), (k, k as f32), "{value}");
        }
        assert_eq!(
            [0.5, 1.5, -0.5, -1.5].map(|v| round_ties_even(v).0),
            [0, 2, 0, -2]
        );
    }

    #[test]
    fn cube_root_is_good_to_its_last_bits() {
        for k in 0..200_000 {
            let value = 1e-30 * 1.0007_f32.powi(k);
            if value > 1e30 {
                return;
            }
            let exact = f64::from(value).cbrt();
            let error = (f64::from(cbrt_f32(value)) / exact - 1.0).abs();
            assert!(error < 2e-7, "{value}: {error:e}");
        }
        unreachable!("the range is covered");
    }

    #[test]
    fn fixed_root_is_within_one_lsb() {
        let mut worst = 0f64;
        for k in 0..1_000_000u64 {
            let square = (k.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 6).max(1 << 50) as i64;
            let exact = (square as f64).sqrt();
            worst = worst.max((f64::from(sqrt_fixed(square).bits()) - exact).abs());
        }
        assert!(worst < 1.0, "worst {worst} LSB");
    }
}
