//! When latch, tick and duty come within a control period. The only place where these numbers stand; what hangs on them is
//! asserted here.

use crate::clocks;
use crate::encoders::{BIT_HZ, FRAME_BYTES};

/// Control ticks in a second.
pub const TICK_HZ: u32 = 20_000;
/// PWM periods in a second: a duty takes over with a whole one.
pub const PWM_HZ: u32 = 40_000;
/// From the encoders' latch to the tick, us: 64 bits at 5.25 MHz take 12.2 us, the rest is for interrupt and DMA.
pub const LEAD_US: u32 = 15;
/// From the tick to the PWM period in which its duty acts, us: the tick's deadline.
pub const DEADLINE_US: u32 = 32;

const PERIOD_US: u32 = 1_000_000 / TICK_HZ;
const PWM_PERIOD_US: u32 = 1_000_000 / PWM_HZ;
/// Longest time from latch to duty, us: the servo's phase margin pays for every one.
const MAX_LATENCY_US: u32 = 47;

const _: () = assert!(LEAD_US + DEADLINE_US <= MAX_LATENCY_US);
// The next latch comes after the deadline: it interrupts only what a tick does after its duties.
const _: () = assert!(DEADLINE_US < PERIOD_US - LEAD_US);
// The duty acts in the second PWM period that begins after the tick.
const _: () = assert!(DEADLINE_US > PWM_PERIOD_US && DEADLINE_US < 2 * PWM_PERIOD_US);
const _: () = assert!(PWM_HZ == 2 * TICK_HZ);

/// Counts of a PWM period, and so the full duty.
pub const PWM_COUNTS: u16 = (clocks::TIM1_HZ / PWM_HZ) as u16;
const _: () = assert!(PWM_COUNTS as u32 * PWM_HZ == clocks::TIM1_HZ);
/// Where in the PWM period the tick comes.
pub const TICK_COUNT: u16 = PWM_COUNTS * 2 - (clocks::TIM1_HZ / 1_000_000 * DEADLINE_US) as u16;

/// Counts of TIM3 in a control period, and from the latch to the tick.
pub const LATCH_COUNTS: u16 = (clocks::TIM3_HZ / TICK_HZ) as u16;
const _: () = assert!(LATCH_COUNTS as u32 * TICK_HZ == clocks::TIM3_HZ);
pub const LEAD_COUNTS: u16 = (clocks::TIM3_HZ / 1_000_000 * LEAD_US) as u16;

/// Cycles of the core from the latch's event to the tick's.
pub const LEAD_CYCLES: u32 = clocks::CORE_HZ / 1_000_000 * LEAD_US;
/// Cycles from an encoder's port being let go to its frame's last byte in memory: its bits, and what the first byte takes from memory to
/// the line and the last one back, by DMA over the slow bus.
pub const FRAME_CYCLES: u32 =
    FRAME_BYTES as u32 * 8 * (clocks::CORE_HZ / BIT_HZ) + FRAME_DMA_CYCLES;
const FRAME_DMA_CYCLES: u32 = 60;
/// The latch's interrupt has so many cycles until the ports are let go, or a frame is not whole when its tick comes.
pub const LATCH_DEADLINE_CYCLES: u32 = LEAD_CYCLES - FRAME_CYCLES;
// Half a microsecond beyond the microsecond and a half that it takes (`cargo chip-cycles`): the core may have a long instruction under way.
const _: () = assert!(LATCH_DEADLINE_CYCLES > 168 * 2);

/// Cycles that frames are whole before their tick, whose ports were let go so many counts of TIM3 after the latch's event.
#[inline(always)]
pub fn frame_margin_cycles(latch_counts: u16) -> u32 {
    LATCH_DEADLINE_CYCLES
        .saturating_sub(u32::from(latch_counts) * (clocks::CORE_HZ / clocks::TIM3_HZ))
}

/// Cycles of the core from the tick's event to its deadline; TIM1 counts the same clock.
pub const DEADLINE_CYCLES: u32 = clocks::CORE_HZ / 1_000_000 * DEADLINE_US;
/// Cycles of a control period.
pub const PERIOD_CYCLES: u32 = clocks::CORE_HZ / TICK_HZ;
