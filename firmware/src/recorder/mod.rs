//! The data recorder: what a tick computed, offered at its end, and how it is stored and read.
//!
//! A [`Recorder`] is a store of 32-bit words with two ends. The [`RecorderWriter`] takes every tick's sample, on the chip right behind the tick; the
//! [`RecorderReader`] orders records and reads them at low priority. Neither waits for the other, and there is no lock:
//!
//! - Orders go to the tick by value, through a queue. A [`RecordSetup`] is copied out of it once, so that the tick
//!   works on its own.
//! - The words are atomics, each written and read in one access. The tick publishes how many rows of the record are
//!   complete with release, the reader loads that with acquire, so it sees those rows whole; and they stay as they are
//!   until the reader itself orders another record, since rows are overwritten only before the trigger.
//!
//! What is written are [`RawSignal`]s, integers or floats as the tick has them, finer than the encoder; what they are
//! in mm and deg is worked out by whoever reads them.
//!
//! | file | idea |
//! |---|---|
//! | `sample` | what a tick offers at its end, and the trait of those that observe it |
//! | `signal` | what can be recorded |
//! | `setup` | what a record is to be, and the orders to the tick |
//! | `memory` | the memory, split into its two ends |
//! | `published` | what the tick publishes of a record |
//! | `writer` | the tick's end: triggers, rows |
//! | `reader` | the end outside of it: orders, reading, turns put back |
//! | `running_hash` | a hash of every tick |

mod memory;
mod published;
mod reader;
mod running_hash;
mod sample;
mod setup;
mod signal;
mod writer;

pub use memory::Recorder;
pub use reader::{Cursor, Progress, RecorderReader};
pub use running_hash::RunningHash;
pub use sample::{Sample, ServoSample, ServoSamples, TickObserver};
pub use setup::{
    LevelTrigger, MAX_ROW_PERIOD_TICKS, MAX_ROW_WORDS, QueueFull, RECORDER_TABLES, RECORDER_WORDS,
    RecordSetup,
};
pub use signal::{RawSignal, SignalFormat};
pub use writer::RecorderWriter;
