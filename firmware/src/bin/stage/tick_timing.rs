//! What a tick costs and whether it comes and ends in time, by the core's cycle counter.

use crate::clocks;
use cortex_m::peripheral::{DCB, DWT};

/// From the tick's interrupt to the PWM period in which its duty acts: 25 us.
const DEADLINE_CYCLES: u32 = clocks::CORE_HZ / 40_000;
// Told to who models the tick's cycles: a symbol whose value is the number.
core::arch::global_asm!(
    ".global stage_deadline_cycles",
    ".set stage_deadline_cycles, {}",
    const DEADLINE_CYCLES
);

/// More than this between two ticks, and one has been missed: one and a half times 50 us.
const MISSED_CYCLES: u32 = clocks::CORE_HZ / 20_000 * 3 / 2;

/// See the module.
#[derive(Default)]
pub struct TickTiming {
    /// When the last tick began.
    began: Option<u32>,
    cycles: u32,
}

impl TickTiming {
    /// Starts the counter.
    pub fn new(dcb: &mut DCB, dwt: &mut DWT) -> Self {
        dcb.enable_trace();
        dwt.enable_cycle_counter();
        Self::default()
    }

    /// A tick begins: what the last one cost, and whether it was late or this one is.
    #[inline]
    pub fn begin(&mut self) -> (u32, bool) {
        let now = DWT::cycle_count();
        let missed = self
            .began
            .is_some_and(|began| now.wrapping_sub(began) > MISSED_CYCLES);
        self.began = Some(now);
        (self.cycles, missed || self.cycles > DEADLINE_CYCLES)
    }

    /// The tick ends.
    #[inline]
    pub fn end(&mut self) {
        if let Some(began) = self.began {
            self.cycles = DWT::cycle_count().wrapping_sub(began);
        }
    }
}
