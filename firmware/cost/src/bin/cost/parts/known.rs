//! A part whose instructions are known: if it comes out otherwise, no count can be believed.

use crate::bench::{Bench, no_result};

/// Turns of the loop: two instructions each, and one to load their number.
const TURNS: u32 = 1_000;

/// Counts it.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    bench.part(
        "known: 2,001 instructions",
        1,
        |_| (),
        |_| two_thousand(),
        no_result,
    );
}

#[inline(always)]
fn two_thousand() {
    // SAFETY: counts a register of its own down.
    unsafe {
        core::arch::asm!(
            "movw {turns}, #{number}",
            "2:",
            "subs {turns}, #1",
            "bne 2b",
            turns = out(reg) _,
            number = const TURNS,
            options(nomem, nostack)
        );
    }
}
