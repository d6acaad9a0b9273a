//! When the encoders are latched after their timer's event, and what that leaves until the tick, in counts of the latch's timer.

use crate::timeline::LEAD_COUNTS;
use core::sync::atomic::{AtomicU32, Ordering};

/// Of all latches so far.
static EARLIEST: AtomicU32 = AtomicU32::new(u32::MAX);
static LATEST: AtomicU32 = AtomicU32::new(0);

/// Counts of a frame: 64 bits of 16 counts.
const FRAME_COUNTS: i32 = 64 * 16;

/// What is left until the tick with no delay at all.
pub const MOST_MARGIN: i32 = LEAD_COUNTS as i32 - FRAME_COUNTS;

/// The encoders have latched, so many counts after the event.
#[inline(always)]
pub fn record(counts: u32) {
    if counts < EARLIEST.load(Ordering::Relaxed) {
        EARLIEST.store(counts, Ordering::Relaxed);
    }
    if counts > LATEST.load(Ordering::Relaxed) {
        LATEST.store(counts, Ordering::Relaxed);
    }
}

/// From the earliest latch since the start to the latest.
pub fn jitter() -> u32 {
    (LATEST.load(Ordering::Relaxed)).saturating_sub(EARLIEST.load(Ordering::Relaxed))
}

/// From the last bit of the latest frame to the tick: what is left before an encoder counts as missing.
pub fn frame_margin() -> i32 {
    MOST_MARGIN - LATEST.load(Ordering::Relaxed) as i32
}
