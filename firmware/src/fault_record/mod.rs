//! The black box: what is still there after a reset. It lies in memory that the start-up code leaves alone.
//!
//! It holds the events that `EVT?` tells, and the fault record: what the loop did in the last ticks before a fault and the first
//! after it. The fault record is always on, whatever the user records; a reset in motion ends it as a fault does.
//!
//! Whoever writes may be stopped between any two words, and after a power-up there is anything in the memory. So each entry
//! carries its own check and its own number or tick, from which its place follows: nothing else has to be right. An entry whose
//! writing a reset has cut fails its check and is left out; the others stay. All words are atomics: the tick writes while the
//! command side reads, and nobody waits.
//!
//! | file | idea |
//! |---|---|
//! | `entry` | words with a check |
//! | `history` | the fault record's end in the tick |
//! | `row` | a tick of it |
//! | `reading` | its other end |

mod checked_words;
mod reader;
mod row;
mod writer;

pub use reader::FaultRecord;
pub use row::FaultRecordRow;
pub use writer::FaultRecordWriter;

use checked_words::CheckedEntries;
use core::sync::atomic::{AtomicU32, Ordering};

/// Ticks that the fault record holds, those after the fault included: 12.8 ms.
pub const FAULT_RECORD_ROWS: usize = 256;
/// How many of them come after the fault.
pub const ROWS_AFTER_FAULT: u32 = 64;
/// Events that are kept.
pub const RETAINED_EVENTS: usize = 64;

/// Another one for each layout of the memory.
const LAYOUT_MAGIC: u32 = 0x5458_0001;

/// The memory. All zero at first, and any content at all is a valid one.
pub struct RetainedMemory {
    layout: AtomicU32,
    /// Number of the start; its low byte is in every row.
    start: AtomicU32,
    /// The fault record is complete and not overwritten before the servo is on.
    frozen: AtomicU32,
    pub(crate) events: CheckedEntries<RETAINED_EVENTS, { checked_words::EVENT_WORDS }>,
    rows: CheckedEntries<FAULT_RECORD_ROWS, { row::WORDS }>,
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
            rows: CheckedEntries::new(),
        }
    }

    /// The controller starts: what is there from before is kept, as far as it is whole. Gives the end in the tick.
    pub fn begin(&self) -> FaultRecordWriter<'_> {
        if self.layout.load(Ordering::Relaxed) != LAYOUT_MAGIC {
            self.events.clear();
            self.rows.clear();
            self.start.store(0, Ordering::Relaxed);
            self.layout.store(LAYOUT_MAGIC, Ordering::Relaxed);
        }
        let start = self.start.load(Ordering::Relaxed).wrapping_add(1);
        self.start.store(start, Ordering::Relaxed);
        let is_record = self.newest_row().is_some();
        self.frozen.store(u32::from(is_record), Ordering::Relaxed);
        FaultRecordWriter::new(self, start, is_record)
    }
}

#[cfg(test)]
mod tests;
