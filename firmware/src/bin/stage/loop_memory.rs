//! Puts the control loop's code and constants into RAM, where the core fetches them without a wait.
//!
//! The flash takes six cycles for a line of 16 bytes, and its cache holds a seventh of a tick. SRAM1 takes one for a word, if
//! the core fetches it over its instruction bus: so it is mapped to address 0 (`SYSCFG_MEMRMP`; RM0090, 2.3.1 and 9.2.1), and the loop
//! is linked to run there (`control-loop.x`). At its own address the core would fetch over the system bus, a word every other cycle.
//! A reset gives address 0 back to the flash.
//!
//! Before anything else of the program, once the RAM has been tried (`ram_test`): `memcpy` is there too.

use crate::ram_test::{CCM_BASE, CCM_END, SRAM_BASE, SRAM_END};

/// `RCC_APB2ENR`, and the clock of the system configuration in it.
const RCC_APB2ENR: u32 = 0x4002_3844;
const SYSCFGEN: u32 = 1 << 14;
/// `SYSCFG_MEMRMP`, its bits that say what answers at address 0, and SRAM1 in them.
const SYSCFG_MEMRMP: u32 = 0x4001_3800;
const MEM_MODE: u32 = 0b111;
const SRAM1: u32 = 0b011;
/// SRAM1 at its own address.
pub const SRAM1_BASE: u32 = SRAM_BASE;

core::arch::global_asm!(
    ".section .text.loop_memory, \"ax\"",
    ".global __pre_init",
    ".type __pre_init, %function",
    ".thumb_func",
    "__pre_init:",
    // The test has the link register and keeps this one, in which the start-up code has nothing.
    "mov  r4, lr",
    "movw r0, #:lower16:{sram_base}",
    "movt r0, #:upper16:{sram_base}",
    "movw r1, #:lower16:{sram_end}",
    "movt r1, #:upper16:{sram_end}",
    "bl   tripivot_ram_test",
    "movw r0, #:lower16:{ccm_base}",
    "movt r0, #:upper16:{ccm_base}",
    "movw r1, #:lower16:{ccm_end}",
    "movt r1, #:upper16:{ccm_end}",
    "bl   tripivot_ram_test",
    "movw r0, #:lower16:{apb2enr}",
    "movt r0, #:upper16:{apb2enr}",
    "ldr  r1, [r0]",
    "orr  r1, r1, #{syscfgen}",
    "str  r1, [r0]",
    // The clock runs two cycles after (erratum 2.2.7).
    "dsb",
    "movw r0, #:lower16:__siloop",
    "movt r0, #:upper16:__siloop",
    "movw r1, #:lower16:__sloop",
    "movt r1, #:upper16:__sloop",
    "movw r2, #:lower16:__eloop",
    "movt r2, #:upper16:__eloop",
    "add  r1, r1, #{sram1_base}",
    "add  r2, r2, #{sram1_base}",
    "1:",
    "cmp  r1, r2",
    "bhs  2f",
    "ldr  r3, [r0], #4",
    "str  r3, [r1], #4",
    "b    1b",
    "2:",
    "movw r0, #:lower16:{memrmp}",
    "movt r0, #:upper16:{memrmp}",
    "ldr  r1, [r0]",
    "bic  r1, r1, #{mem_mode}",
    "orr  r1, r1, #{sram1}",
    "str  r1, [r0]",
    // What is fetched from now on comes from there.
    "dsb",
    "isb",
    "bx   r4",
    ".size __pre_init, . - __pre_init",
    sram_base = const SRAM_BASE,
    sram_end = const SRAM_END,
    ccm_base = const CCM_BASE,
    ccm_end = const CCM_END,
    apb2enr = const RCC_APB2ENR,
    syscfgen = const SYSCFGEN,
    sram1_base = const SRAM1_BASE,
    memrmp = const SYSCFG_MEMRMP,
    mem_mode = const MEM_MODE,
    sram1 = const SRAM1,
);
