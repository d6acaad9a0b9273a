//! What a bench or a debugger reads by symbol: `TRACE`, written by the tick and at start.

use crate::watchdog::ResetCause;
use core::sync::atomic::{AtomicU32, Ordering};
use firmware::recorder::{Record, RunningHash, Sample};

/// The record.
#[repr(C)]
pub struct Trace {
    /// Ticks since start; written last, so that the other words belong to it.
    ticks: AtomicU32,
    /// Running hash over all ticks ([`RunningHash`]).
    hash: AtomicU32,
    /// Commands that the tick has taken.
    commands: AtomicU32,
    /// Why the chip started: [`ResetCause`] as a number.
    reset_cause: AtomicU32,
}

/// The record.
#[unsafe(no_mangle)]
pub static TRACE: Trace = Trace {
    ticks: AtomicU32::new(0),
    hash: AtomicU32::new(0),
    commands: AtomicU32::new(0),
    reset_cause: AtomicU32::new(0),
};

impl Trace {
    /// Ticks since start.
    pub fn ticks(&self) -> u32 {
        self.ticks.load(Ordering::Relaxed)
    }

    /// Notes why the chip started.
    pub fn set_reset_cause(&self, cause: ResetCause) {
        self.reset_cause.store(cause as u32, Ordering::Relaxed);
    }
}

/// The tick's recorder: keeps [`TRACE`] up to date.
#[derive(Default)]
pub struct Tracer(RunningHash);

impl Record for Tracer {
    #[inline]
    fn record(&mut self, sample: &Sample) {
        self.0.record(sample);
        TRACE.hash.store(self.0.0, Ordering::Relaxed);
        TRACE.commands.store(sample.commands, Ordering::Relaxed);
        TRACE.ticks.store(sample.tick as u32, Ordering::Relaxed);
    }
}

/// Puts the symbol `stage_tick_end` here, and no instruction: where a bench stops counting a tick's cost.
// A numbered label, which the lint asks for, is no symbol. No `nomem`: the tick's stores stay in front of the label.
#[allow(named_asm_labels)]
#[inline(always)]
pub fn mark_end_of_tick() {
    // SAFETY: a label does nothing. Were the call compiled in two places, the assembler would refuse the second.
    unsafe {
        core::arch::asm!(
            ".global stage_tick_end",
            "stage_tick_end:",
            options(nostack, preserves_flags)
        );
    }
}
