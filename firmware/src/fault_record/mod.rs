//! The fault record and the events: what is still there after a reset. They lie in memory that the start-up code leaves
//! alone.
//!
//! The events are those that `EVT?` lists. The fault record is what the loop did in the last ticks before a fault and
//! the first after it. The fault record is always on, whatever the user records; a reset in motion ends it as a fault
//! does.
//!
//! Whoever writes may be stopped between any two words, and after a power-up there is anything in the memory. So each
//! entry carries its own check and its own number or tick, from which its place follows: nothing else has to be right.
//! An entry whose writing a reset has cut fails its check and is left out; the others stay. All words are atomics: one side
//! writes while the other reads, and nobody waits.
//!
//! | file | idea |
//! |---|---|
//! | `memory` | the retained memory |
//! | `checked_words` | entries of some words, with a check |
//! | `row` | a tick of the fault record |
//! | `writer` | its end that takes the samples of the ticks |
//! | `reader` | its other end |

mod checked_words;
mod memory;
mod reader;
mod row;
mod writer;

pub use memory::{
    FAULT_RECORD_ROWS, RETAINED_EVENTS, RETAINED_FAULTS, ROWS_AFTER_FAULT, RetainedMemory,
};
pub use reader::FaultRecord;
pub use row::FaultRecordRow;
pub use writer::FaultRecordWriter;

#[cfg(test)]
mod tests;
