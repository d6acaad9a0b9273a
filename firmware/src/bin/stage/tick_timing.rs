//! What a tick costs, whether it comes and ends in time, and whether it leaves any for the command side, by the core's cycle
//! counter. That one stands still while the core sleeps, unless a debugger is attached: whether a tick has come at all is told
//! by TIM2, which counts on.

use crate::clocks;
use crate::timeline::{DEADLINE_CYCLES, LATCH_DEADLINE_CYCLES, PERIOD_CYCLES};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::{DCB, DWT};
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

// Told to who models the tick's cycles: symbols whose values are the numbers.
core::arch::global_asm!(
    ".global stage_deadline_cycles",
    ".set stage_deadline_cycles, {}",
    ".global stage_period_cycles",
    ".set stage_period_cycles, {}",
    ".global stage_latch_deadline_cycles",
    ".set stage_latch_deadline_cycles, {}",
    const DEADLINE_CYCLES,
    const PERIOD_CYCLES,
    const LATCH_DEADLINE_CYCLES
);

/// More than this between two ticks, and one has been missed: one and a half periods, in counts of TIM2, on the bus of TIM3.
const MISSED_COUNTS: u32 = clocks::TIM3_HZ / (clocks::CORE_HZ / PERIOD_CYCLES) * 3 / 2;
/// Of a period, in the mean, for tick and recorders together. With more the command side, which answers, plans and feeds the watchdog,
/// would come to a standstill while duties are still in time: the loop counts as late, and stops the stage before the watchdog does.
const MOST_LOAD_CYCLES: u32 = PERIOD_CYCLES / 100 * 97;
/// The mean is over so many ticks, a power of two: 3 ms.
const LOAD_TICKS: u32 = 64;

/// When the recorders were last done.
static RECORDED: AtomicU32 = AtomicU32::new(0);

/// The recorders are done, and the rest of the period is the command side's.
#[inline]
pub fn mark_recorded() {
    RECORDED.store(DWT::cycle_count(), Ordering::Relaxed);
}

/// TIM2: all its 32 bits, and nothing to be woken by.
fn clock() -> &'static pac::tim2::RegisterBlock {
    // SAFETY: this module has it to itself.
    unsafe { &*pac::TIM2::ptr() }
}

/// See the module.
#[derive(Default)]
pub struct TickTiming {
    /// When the last tick began, in cycles, and counts of TIM2.
    began: Option<u32>,
    began_at: u32,
    /// What it cost.
    cycles: u32,
    /// How late it began, cycles after its event.
    delay: u32,
    /// Cycles until the recorders were done, of [`LOAD_TICKS`] ticks, smoothed.
    load: u32,
}

impl TickTiming {
    /// Starts the counters.
    pub fn new(dcb: &mut DCB, dwt: &mut DWT, rcc: &mut Rcc) -> Self {
        dcb.enable_trace();
        dwt.enable_cycle_counter();
        pac::TIM2::enable(rcc);
        let clock = clock();
        clock.arr().write(|w| w.arr().set(u32::MAX));
        clock.egr().write(|w| w.ug().set_bit());
        clock.cr1().write(|w| w.cen().enabled());
        Self::default()
    }

    /// A tick begins, so many cycles after its event: what the last one cost, and whether its duty missed its period, there
    /// should have been one more since, or ticks leave no time for anything else.
    #[inline]
    pub fn begin(&mut self, delay: u32) -> (u32, bool) {
        let now = DWT::cycle_count();
        let at = clock().cnt().read().bits();
        let missed = self.began.is_some() && at.wrapping_sub(self.began_at) > MISSED_COUNTS;
        self.began_at = at;
        let was_late = self.delay + self.cycles > DEADLINE_CYCLES;
        if let Some(began) = self.began {
            let busy = RECORDED.load(Ordering::Relaxed).wrapping_sub(began);
            // Not done yet: it was done before that tick, an age ago.
            self.load = self.load - self.load / LOAD_TICKS + busy.min(PERIOD_CYCLES);
        }
        let is_overloaded = self.load > MOST_LOAD_CYCLES * LOAD_TICKS;
        self.began = Some(now);
        self.delay = delay;
        (self.cycles, missed || was_late || is_overloaded)
    }

    /// The tick ends.
    #[inline]
    pub fn end(&mut self) {
        if let Some(began) = self.began {
            self.cycles = DWT::cycle_count().wrapping_sub(began);
        }
    }
}
