//! What a bench or a debugger reads by symbol: `TRACE`, written by the tick, by the command interface and at start.
//!
//! What the command interface sends depends on the bytes and the snapshot that it has at hand, and how long it takes
//! depends on the chip. With a record of both, whoever repeats the run elsewhere can give its own command interface the
//! same.

use crate::reset_cause::ResetCause;
use core::sync::atomic::{AtomicU32, Ordering};
use firmware::recorder::{RunningHash, Sample, TickObserver};

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
    /// How often the command interface has run; written behind the entry in `services` that it counts.
    served: AtomicU32,
    /// The latest of these, each in the place of its number: bytes taken so far, and the tick of the snapshot at hand.
    services: [[AtomicU32; 2]; SERVICES],
}

/// Runs of the command interface that are remembered: more than there are interrupts to wake it in a control period.
const SERVICES: usize = 16;

/// The record.
#[unsafe(no_mangle)]
pub static TRACE: Trace = Trace {
    ticks: AtomicU32::new(0),
    hash: AtomicU32::new(0),
    commands: AtomicU32::new(0),
    reset_cause: AtomicU32::new(0),
    served: AtomicU32::new(0),
    services: [const { [const { AtomicU32::new(0) }; 2] }; SERVICES],
};

impl Trace {
    /// Keeps why the chip started.
    pub fn set_reset_cause(&self, cause: ResetCause) {
        self.reset_cause.store(cause as u32, Ordering::Relaxed);
    }

    /// Keeps a run of the command interface: bytes taken since start, the last ones right before it, and the tick of
    /// the snapshot it has had. To be called by the command interface alone.
    pub fn record_service(&self, bytes: u32, tick: u32) {
        let served = self.served.load(Ordering::Relaxed);
        let [bytes_place, tick_place] = &self.services[served as usize % SERVICES];
        bytes_place.store(bytes, Ordering::Relaxed);
        tick_place.store(tick, Ordering::Relaxed);
        self.served.store(served.wrapping_add(1), Ordering::Release);
    }
}

/// What the samples go to at last: keeps [`TRACE`] up to date.
#[derive(Default)]
pub struct TraceWriter(RunningHash);

impl TickObserver for TraceWriter {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        self.0.observe(sample);
        TRACE.hash.store(self.0.0, Ordering::Relaxed);
        TRACE.commands.store(sample.commands, Ordering::Relaxed);
        TRACE.ticks.store(sample.tick as u32, Ordering::Relaxed);
    }
}

/// Puts a symbol here, and no instruction.
// A numbered label, which the lint asks for, is no symbol. No `nomem`: the stores before it stay in front of the label.
macro_rules! mark {
    ($symbol:literal) => {
        // SAFETY: a label does nothing. Were it compiled in two places, the assembler would refuse the second.
        unsafe {
            core::arch::asm!(
                concat!(".global ", $symbol),
                concat!($symbol, ":"),
                options(nostack, preserves_flags)
            );
        }
    };
}

/// Where a bench stops counting a tick's cost, its duties written.
#[allow(named_asm_labels)]
#[inline(always)]
pub fn mark_end_of_tick() {
    mark!("stage_tick_end");
}

/// Where all that a tick does has ended.
#[allow(named_asm_labels)]
#[inline(always)]
pub fn mark_end_of_handler() {
    mark!("stage_handler_end");
}
