//! Exceptions that nobody expects: the outputs are cut, what is known is kept, and the chip starts again.
//!
//! One piece of assembly stands behind every vector that has no handler of its own: processor faults, the failure of the
//! crystal (non-maskable interrupt), the window watchdog's early warning, interrupts that nobody has enabled. It uses no
//! stack, since that may be what is broken: a fault while a fault is handled stops the core with the outputs on. The
//! first two stores let all motors coast.

use crate::{
    board::SLEEP_PINS_LOW,
    crash::{CRASH, EXCEPTION_MAGIC},
};

/// `TIM1_BDTR`, and its bit that connects the outputs.
const TIM1_BDTR: u32 = 0x4001_0044;
const MOE: u32 = 1 << 15;
/// Fault status and addresses of the system control block, from `CFSR` on.
const SCB_CFSR: u32 = 0xE000_ED28;
const SCB_AIRCR: u32 = 0xE000_ED0C;
const AIRCR_RESET: u32 = 0x05FA_0004;
/// Bytes of the words that the processor pushes first, the program counter among them.
const FRAME_BYTES: u32 = 32;

core::arch::global_asm!(
    ".section .text.fault_handlers, \"ax\"",
    ".global HardFault",
    ".global DefaultHandler",
    ".type HardFault, %function",
    ".type DefaultHandler, %function",
    ".balign 4",
    ".thumb_func",
    "HardFault:",
    ".thumb_func",
    "DefaultHandler:",
    // The outputs low, then the sleep pins: both whatever the rest comes to.
    "movw r0, #:lower16:{bdtr}",
    "movt r0, #:upper16:{bdtr}",
    "ldr  r1, [r0]",
    "bic  r1, r1, #{moe}",
    "str  r1, [r0]",
    "movw r0, #:lower16:{sleep_port}",
    "movt r0, #:upper16:{sleep_port}",
    "movw r1, #:lower16:{sleep_low}",
    "movt r1, #:upper16:{sleep_low}",
    "str  r1, [r0]",
    "dsb",
    // Number of the exception, and where the stack stood.
    "movw r0, #:lower16:{crash}",
    "movt r0, #:upper16:{crash}",
    "mrs  r1, ipsr",
    "mov  r2, sp",
    "str  r1, [r0, #4]",
    "str  r2, [r0, #8]",
    // Where it was, and who had called: read only where there is a stack.
    "movs r3, #0",
    "movs r4, #0",
    "movw r5, #:lower16:_stack_end",
    "movt r5, #:upper16:_stack_end",
    "movw r6, #:lower16:_stack_start",
    "movt r6, #:upper16:_stack_start",
    "sub  r6, r6, #{frame}",
    "cmp  r2, r5",
    "blo  1f",
    "cmp  r2, r6",
    "bhi  1f",
    "ldr  r3, [r2, #24]",
    "ldr  r4, [r2, #20]",
    "1:",
    "str  r3, [r0, #12]",
    "str  r4, [r0, #16]",
    // CFSR, HFSR, MMFAR, BFAR.
    "movw r2, #:lower16:{cfsr}",
    "movt r2, #:upper16:{cfsr}",
    "ldr  r1, [r2]",
    "str  r1, [r0, #20]",
    "ldr  r1, [r2, #4]",
    "str  r1, [r0, #24]",
    "ldr  r1, [r2, #12]",
    "str  r1, [r0, #28]",
    "ldr  r1, [r2, #16]",
    "str  r1, [r0, #32]",
    "movw r1, #:lower16:{magic}",
    "movt r1, #:upper16:{magic}",
    "str  r1, [r0]",
    "dsb",
    "movw r0, #:lower16:{aircr}",
    "movt r0, #:upper16:{aircr}",
    "movw r1, #:lower16:{reset}",
    "movt r1, #:upper16:{reset}",
    "str  r1, [r0]",
    "dsb",
    // The reset takes some cycles.
    "2:",
    "b    2b",
    ".size DefaultHandler, . - DefaultHandler",
    bdtr = const TIM1_BDTR,
    moe = const MOE,
    sleep_port = const SLEEP_PINS_LOW.0,
    sleep_low = const SLEEP_PINS_LOW.1,
    crash = sym CRASH,
    frame = const FRAME_BYTES,
    cfsr = const SCB_CFSR,
    magic = const EXCEPTION_MAGIC,
    aircr = const SCB_AIRCR,
    reset = const AIRCR_RESET,
);
