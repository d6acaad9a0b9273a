//! `RBT`: the chip starts again, and knows afterwards that it was asked to.

use crate::pwm;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::SCB;

/// What [`ASKED`] holds over a restart that was asked for; a power-up hardly leaves it by chance, and is no software
/// reset.
const ASKED_MAGIC: u32 = 0x5242_5421;

/// Keeps its value over a reset: the start-up code leaves this section alone.
#[unsafe(link_section = ".uninit.RESTART")]
static ASKED: AtomicU32 = AtomicU32::new(0);

/// Cuts the motors and starts the chip again.
pub fn now() -> ! {
    ASKED.store(ASKED_MAGIC, Ordering::Relaxed);
    pwm::cut();
    SCB::sys_reset()
}

/// Whether the software reset that has just happened was asked for; answered once.
pub fn was_asked_for() -> bool {
    ASKED.swap(0, Ordering::Relaxed) == ASKED_MAGIC
}
