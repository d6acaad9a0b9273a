//! The retained memory: events and the rows of the fault record.

use super::checked_words::{CheckedEntries, EVENT_WORDS};
use super::row;
use core::sync::atomic::AtomicU32;

/// Ticks that the fault record holds, those after the fault included: 12.8 ms.
pub const FAULT_RECORD_ROWS: usize = 256;
/// How many of them come after the fault.
pub const ROWS_AFTER_FAULT: u32 = 64;
/// Events that are kept.
pub const RETAINED_EVENTS: usize = 64;
/// Faults that are kept besides, however much else happens after them.
pub const RETAINED_FAULTS: usize = 8;

/// Motors whose heat is kept.
const MOTORS: usize = 3;

/// Another one for each layout of the memory.
pub(super) const LAYOUT_MAGIC: u32 = 0x5458_0002;

/// The memory. All zero at first, and any content at all is a valid one.
pub struct RetainedMemory {
    pub(super) layout: AtomicU32,
    /// Number of the start; its low byte is in every row.
    pub(super) start: AtomicU32,
    /// The fault record is complete and not overwritten before the servo is on.
    pub(super) frozen: AtomicU32,
    pub(crate) events: CheckedEntries<RETAINED_EVENTS, { EVENT_WORDS }>,
    pub(crate) faults: CheckedEntries<RETAINED_FAULTS, { EVENT_WORDS }>,
    /// What the motors have borne: they do not cool with a restart.
    pub(super) motor_heat: CheckedEntries<1, { MOTORS + 1 }>,
    pub(super) rows: CheckedEntries<FAULT_RECORD_ROWS, { row::WORDS }>,
}

impl RetainedMemory {
    /// Empty.
    #[allow(clippy::new_without_default)] // A default of 14 KB is nothing to be made in passing.
    pub const fn new() -> Self {
        Self {
            layout: AtomicU32::new(0),
            start: AtomicU32::new(0),
            frozen: AtomicU32::new(0),
            events: CheckedEntries::new(),
            faults: CheckedEntries::new(),
            motor_heat: CheckedEntries::new(),
            rows: CheckedEntries::new(),
        }
    }

    /// Keeps the motors' heat: square of the current, ADC counts, smoothed.
    pub(crate) fn keep_motor_heat(&self, heat: &[f32; MOTORS]) {
        let [one, two, three] = heat.map(f32::to_bits);
        self.motor_heat.write(0, &[one, two, three, 0]);
    }

    /// The motors' heat as it was kept last: cold where nothing was.
    pub fn motor_heat(&self) -> [f32; MOTORS] {
        let [one, two, three, _] = self.motor_heat.read(0).unwrap_or_default();
        let is_heat = |heat: &f32| heat.is_finite() && *heat >= 0.0;
        [one, two, three].map(|bits| Some(f32::from_bits(bits)).filter(is_heat).unwrap_or(0.0))
    }
}
