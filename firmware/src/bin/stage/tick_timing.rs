//! What a tick costs and whether it comes and ends in time, by the core's cycle counter.

use crate::timeline::{DEADLINE_CYCLES, PERIOD_CYCLES};
use cortex_m::peripheral::{DCB, DWT};

// Told to who models the tick's cycles: symbols whose values are the numbers.
core::arch::global_asm!(
    ".global stage_deadline_cycles",
    ".set stage_deadline_cycles, {}",
    ".global stage_period_cycles",
    ".set stage_period_cycles, {}",
    const DEADLINE_CYCLES,
    const PERIOD_CYCLES
);

/// More than this between two ticks, and one has been missed: one and a half periods.
const MISSED_CYCLES: u32 = PERIOD_CYCLES * 3 / 2;

/// See the module.
#[derive(Default)]
pub struct TickTiming {
    /// When the last tick began.
    began: Option<u32>,
    /// What it cost.
    cycles: u32,
    /// How late it began, cycles after its event.
    delay: u32,
}

impl TickTiming {
    /// Starts the counter.
    pub fn new(dcb: &mut DCB, dwt: &mut DWT) -> Self {
        dcb.enable_trace();
        dwt.enable_cycle_counter();
        Self::default()
    }

    /// A tick begins, so many cycles after its event: what the last one cost, and whether its duty missed its period or
    /// there should have been one more since.
    #[inline]
    pub fn begin(&mut self, delay: u32) -> (u32, bool) {
        let now = DWT::cycle_count();
        let missed = self
            .began
            .is_some_and(|began| now.wrapping_sub(began) > MISSED_CYCLES);
        let was_late = self.delay + self.cycles > DEADLINE_CYCLES;
        self.began = Some(now);
        self.delay = delay;
        (self.cycles, missed || was_late)
    }

    /// The tick ends.
    #[inline]
    pub fn end(&mut self) {
        if let Some(began) = self.began {
            self.cycles = DWT::cycle_count().wrapping_sub(began);
        }
    }
}
