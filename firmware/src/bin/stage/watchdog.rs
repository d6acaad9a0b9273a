//! The independent watchdog, fed only while the control loop ticks.

use crate::trace::TRACE;
use core::sync::atomic::{AtomicU32, Ordering};
use stm32f4xx_hal::{pac, prelude::*, watchdog::IndependentWatchdog};

/// How long the loop may stand still, ms. The oscillator behind it is good to -30 and +50 %.
const TIMEOUT_MS: u32 = 20;

/// The tick at which the watchdog was last fed.
static FED_AT: AtomicU32 = AtomicU32::new(0);

const RELOAD: u16 = 0xAAAA;

/// Starts the watchdog; nothing but a reset stops it again.
pub fn start(iwdg: pac::IWDG) {
    IndependentWatchdog::new(iwdg).start(TIMEOUT_MS.millis());
}

/// Feeds the watchdog if the tick has run since the last time. Only the command side calls this, so both have to live.
pub fn feed() {
    let ticks = TRACE.ticks();
    if ticks == FED_AT.load(Ordering::Relaxed) {
        return;
    }
    FED_AT.store(ticks, Ordering::Relaxed);
    // SAFETY: the key register is only written, and this key only reloads the counter.
    unsafe { (*pac::IWDG::ptr()).kr().write(|w| w.key().bits(RELOAD)) };
}
