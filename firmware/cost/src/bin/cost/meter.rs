//! The cycle counter, and what reading it costs.

use core::arch::asm;
use cortex_m::peripheral::{DCB, DWT};

/// Counts calls.
pub struct Meter {
    /// Counts of a call of nothing.
    empty: u32,
}

impl Meter {
    /// Starts the counter.
    pub fn new(dcb: &mut DCB, dwt: &mut DWT) -> Self {
        dcb.enable_trace();
        dwt.set_cycle_count(0);
        dwt.enable_cycle_counter();
        let mut meter = Self { empty: 0 };
        (meter.empty, ()) = meter.count(&mut (), &(), |(), ()| ());
        meter
    }

    /// Counts of one call, and what it returned. Exact to an instruction or two: where the compiler keeps an address
    /// over the call is not the same in every part.
    #[inline(always)]
    pub fn count<M, A, R>(
        &self,
        memory: &mut M,
        arguments: &A,
        call: impl FnOnce(&mut M, &A) -> R,
    ) -> (u32, R) {
        let mut memory: *mut M = memory;
        let mut arguments: *const A = arguments;
        let counter = DWT::PTR.cast::<u32>().wrapping_add(1);
        let (begin, end): (u32, u32);
        // SAFETY: reads the counter. The pointers go through it as they are; the compiler does not know that, so that
        // nothing of the call can come before it.
        unsafe {
            asm!(
                "ldr {begin}, [{counter}]",
                begin = out(reg) begin,
                counter = in(reg) counter,
                inout("r0") memory,
                inout("r1") arguments,
                options(nostack, preserves_flags)
            );
        }
        // SAFETY: they come from references that outlast the call.
        let result = unsafe { call(&mut *memory, &*arguments) };
        // SAFETY: reads the counter. The result might be looked at, for all the compiler knows, so that nothing of the
        // call can come after it.
        unsafe {
            asm!(
                "ldr {end}, [{counter}]",
                end = out(reg) end,
                counter = in(reg) counter,
                in("r0") &raw const result,
                in("r1") memory,
                options(nostack, preserves_flags)
            );
        }
        (end.wrapping_sub(begin).wrapping_sub(self.empty), result)
    }
}
