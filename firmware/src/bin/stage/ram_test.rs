//! Tries every bit of the RAM at each start, before anything of the program uses it: whether a word holds the inverse of what it
//! held, and that again. What outlasts a reset is there afterwards.
//!
//! A chip with a bit that does not hold both ends here: its pins are as the reset has left them, which is no motor driven. The lamps stay
//! as they are, and nobody answers. A debugger finds it at `tripivot_ram_fault`, with the word's address in r0, what was written in r2 or
//! r3, and what was read in r12.
//!
//! 14 cycles a word at the 16 MHz of the start: 57 ms.

/// SRAM and core-coupled memory, as `memory.x` has them, bytes.
pub const SRAM_BASE: u32 = 0x2000_0000;
pub const SRAM_END: u32 = SRAM_BASE + (192 << 10);
pub const CCM_BASE: u32 = 0x1000_0000;
pub const CCM_END: u32 = CCM_BASE + (64 << 10);

// Words from r0 to before r1. No stack, and no register that a function keeps.
core::arch::global_asm!(
    ".section .text.ram_test, \"ax\"",
    ".global tripivot_ram_test",
    ".type tripivot_ram_test, %function",
    ".thumb_func",
    "tripivot_ram_test:",
    "1:",
    "cmp  r0, r1",
    "bhs  2f",
    "ldr  r2, [r0]",
    "mvn  r3, r2",
    "str  r3, [r0]",
    "ldr  r12, [r0]",
    "cmp  r12, r3",
    "bne  tripivot_ram_fault",
    "str  r2, [r0]",
    "ldr  r12, [r0]",
    "cmp  r12, r2",
    "bne  tripivot_ram_fault",
    "adds r0, #4",
    "b    1b",
    "2:",
    "bx   lr",
    ".size tripivot_ram_test, . - tripivot_ram_test",
    ".global tripivot_ram_fault",
    ".type tripivot_ram_fault, %function",
    ".thumb_func",
    "tripivot_ram_fault:",
    "b    tripivot_ram_fault",
    ".size tripivot_ram_fault, . - tripivot_ram_fault",
);
