//! What a tick costs, whether it comes and ends in time, and whether it leaves any for the command side, by the core's cycle
//! counter.

use crate::timeline::{DEADLINE_CYCLES, PERIOD_CYCLES};
use core::sync::atomic::{AtomicU32, Ordering};
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

/// Latches so far, and those that a tick has seen. Ticks are counted by them: the cycle counter may stand while the core sleeps.
static LATCHES: AtomicU32 = AtomicU32::new(0);
static SEEN_LATCHES: AtomicU32 = AtomicU32::new(0);
/// Of a period, in the mean, for tick and recorders together. With more the command side, which answers and plans, would come to a
/// standstill while duties are still in time: the loop counts as late, and stops the stage before the watchdog does.
const MOST_LOAD_CYCLES: u32 = PERIOD_CYCLES / 100 * 97;
/// The mean is over so many ticks, a power of two: 3 ms.
const LOAD_TICKS: u32 = 64;

/// When the recorders were last done.
static RECORDED: AtomicU32 = AtomicU32::new(0);

/// A latch has come, and its tick has to.
#[inline(always)]
pub fn count_latch() {
    // Nobody else writes it.
    LATCHES.store(
        LATCHES.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}

/// Whether there have been latches since this was asked last whose tick has not come.
#[inline(always)]
fn has_lost_a_tick() -> bool {
    let latches = LATCHES.load(Ordering::Relaxed);
    let before = SEEN_LATCHES.load(Ordering::Relaxed);
    SEEN_LATCHES.store(latches, Ordering::Relaxed);
    latches.wrapping_sub(before) > 1
}

/// The recorders are done, and the rest of the period is the command side's.
#[inline]
pub fn mark_recorded() {
    RECORDED.store(DWT::cycle_count(), Ordering::Relaxed);
}

/// See the module.
#[derive(Default)]
pub struct TickTiming {
    /// When the last tick began.
    began: Option<u32>,
    /// What it cost.
    cycles: u32,
    /// How late it began, cycles after its event.
    delay: u32,
    /// Cycles until the recorders were done, of [`LOAD_TICKS`] ticks, smoothed.
    load: u32,
}

impl TickTiming {
    /// Starts the counter.
    pub fn new(dcb: &mut DCB, dwt: &mut DWT) -> Self {
        dcb.enable_trace();
        dwt.enable_cycle_counter();
        Self::default()
    }

    /// A tick begins, so many cycles after its event: what the last one cost, and whether its duty missed its period, there
    /// should have been one more since, or ticks leave no time for anything else.
    #[inline]
    pub fn begin(&mut self, delay: u32) -> (u32, bool) {
        let now = DWT::cycle_count();
        let missed = has_lost_a_tick();
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
