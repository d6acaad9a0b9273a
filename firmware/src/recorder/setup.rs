//! What a record is to be.

use super::signal::{RawSignal, SignalFormat, total_order_key};
use crate::parameters::MAX_RECORD_ROWS;
use heapless::Vec;

/// Signals that a record can hold for its reader.
pub const RECORDER_TABLES: usize = 8;
/// Words of the widest row: some signals are worked out of several words.
pub const MAX_ROW_WORDS: usize = 11;
/// Words of the data recorder. The widest rows, of 11 words, are fewer: 1,582.
pub const RECORDER_WORDS: usize = MAX_RECORD_ROWS * 17 / 2;

const _: () = assert!(MAX_RECORD_ROWS * RECORDER_TABLES >= 16_384);

/// Most ticks from row to row. A pivot at 10 rad/s makes 5.2 turns in them, inside the 8 by which turns are put back.
pub const MAX_ROW_PERIOD_TICKS: u32 = 65_536;

/// A record to be made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordSetup {
    /// Which record this is; the reader finds it under this number.
    pub number: u32,
    /// What stands in a row.
    pub signals: Vec<RawSignal, MAX_ROW_WORDS>,
    /// Ticks from row to row, 1 to [`MAX_ROW_PERIOD_TICKS`].
    pub every: u32,
    /// Rows of the record, those before the trigger included.
    pub rows: u32,
    /// Rows that are kept from before the trigger, fewer than `rows`; fewer are kept when it comes earlier.
    pub before: u32,
    /// Triggered at once.
    pub now: bool,
    /// Triggered by a fault.
    pub fault: bool,
    /// Triggered when the tick has taken so many commands.
    pub commands: Option<u32>,
    /// Triggered by signals that cross a value.
    pub level_triggers: Vec<LevelTrigger, RECORDER_TABLES>,
}

/// A signal that is watched for crossing a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelTrigger {
    pub(super) signal: RawSignal,
    pub(super) level: i64,
    pub(super) rising: bool,
}

impl LevelTrigger {
    /// For a value in the signal's own unit. Rising is from below to at or above, falling the other way.
    pub fn new(signal: RawSignal, value: f64, rising: bool) -> Self {
        let level = match signal.format() {
            SignalFormat::Float => total_order_key((value as f32 + 0.0).to_bits()),
            // From here up the integer is at or above the value.
            _ => libm::ceil(value) as i64,
        };
        Self {
            signal,
            level,
            rising,
        }
    }
}

/// What the reader orders of the tick's end.
#[derive(Clone, Debug, PartialEq)]
// There are three slots of it, and no heap to box the setup in.
#[allow(clippy::large_enum_variant)]
pub(super) enum Order {
    /// Make this record, whatever is being recorded.
    Start(RecordSetup),
    /// Trigger when the tick has taken so many commands; `None` takes that back.
    TriggerAt(Option<u32>),
    /// Stop waiting for a trigger, or recording. What is recorded stays.
    Stop,
}

/// The queue to the tick is full: nothing was queued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueueFull;

/// Slots of the queue of orders (one is lost to the ring).
pub(super) const ORDER_SLOTS: usize = 4;
