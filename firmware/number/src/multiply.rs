//! Products of 32-bit integers, one instruction each on the chip.
//!
//! Rust has an expression for each, and the compiler knows the instructions. But where it can tell that a factor is not
//! negative, as a square, it takes the product for one of 64 by 64 bits, which is three instructions. So they are named
//! here.

/// `sum` plus the upper half of the product (SMMLA).
#[inline(always)]
pub(super) fn add_high(sum: i32, a: i32, b: i32) -> i32 {
    #[cfg(target_arch = "arm")]
    {
        let result;
        // SAFETY: one instruction, from registers to a register.
        unsafe {
            core::arch::asm!(
                "smmla {result}, {a}, {b}, {sum}",
                a = in(reg) a,
                b = in(reg) b,
                sum = in(reg) sum,
                result = lateout(reg) result,
                options(pure, nomem, nostack, preserves_flags)
            );
        }
        result
    }
    #[cfg(not(target_arch = "arm"))]
    sum.wrapping_add(((i64::from(a) * i64::from(b)) >> 32) as i32)
}

/// The same, rounded to nearest (SMMLAR).
#[inline(always)]
pub(super) fn add_high_rounded(sum: i32, a: i32, b: i32) -> i32 {
    #[cfg(target_arch = "arm")]
    {
        let result;
        // SAFETY: one instruction, from registers to a register.
        unsafe {
            core::arch::asm!(
                "smmlar {result}, {a}, {b}, {sum}",
                a = in(reg) a,
                b = in(reg) b,
                sum = in(reg) sum,
                result = lateout(reg) result,
                options(pure, nomem, nostack, preserves_flags)
            );
        }
        result
    }
    #[cfg(not(target_arch = "arm"))]
    sum.wrapping_add(((i64::from(a) * i64::from(b) + (1 << 31)) >> 32) as i32)
}

/// `sum` plus the product (SMLAL).
#[inline(always)]
pub(super) fn add_product(sum: i64, a: i32, b: i32) -> i64 {
    #[cfg(target_arch = "arm")]
    {
        let (mut low, mut high) = (sum as u32, (sum >> 32) as i32);
        // SAFETY: one instruction, from registers to registers.
        unsafe {
            core::arch::asm!(
                "smlal {low}, {high}, {a}, {b}",
                a = in(reg) a,
                b = in(reg) b,
                low = inout(reg) low,
                high = inout(reg) high,
                options(pure, nomem, nostack, preserves_flags)
            );
        }
        i64::from(high) << 32 | i64::from(low)
    }
    #[cfg(not(target_arch = "arm"))]
    sum.wrapping_add(i64::from(a) * i64::from(b))
}
