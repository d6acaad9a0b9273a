//! What a record is to be.

use super::signal::Word;
use crate::parameters::RECORD_ROWS;
use heapless::Vec;

/// Signals that a record can hold for its reader.
pub const TABLES: usize = 8;
/// Words of the widest row: some signals are worked out of several words.
pub const WIDEST: usize = 11;
/// Words of the data recorder.
pub const RECORD_WORDS: usize = RECORD_ROWS * WIDEST;

const _: () = assert!(RECORD_ROWS * TABLES >= 16_384);

/// Most ticks from row to row. A pivot at 10 rad/s makes 5.2 turns in them, inside the 8 by which turns are put back.
pub const MOST_BETWEEN: u32 = 65_536;

/// A record to be made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Setup {
    /// Which record this is; the reader finds it under this number.
    pub number: u32,
    /// What stands in a row.
    pub words: Vec<Word, WIDEST>,
    /// Ticks from row to row, 1 to [`MOST_BETWEEN`].
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
    pub watches: Vec<Watch, TABLES>,
}

/// A signal that is watched for crossing a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Watch {
    pub(super) word: Word,
    pub(super) level: i64,
    pub(super) rising: bool,
}

impl Watch {
    /// For a value in the word's own unit. Rising is from below to at or above, falling the other way.
    pub fn new(word: Word, value: f64, rising: bool) -> Self {
        let level = match word.kind() {
            super::Kind::Float => super::signal::ordered((value as f32 + 0.0).to_bits()),
            // From here up the integer is at or above the value.
            _ => libm::ceil(value) as i64,
        };
        Self {
            word,
            level,
            rising,
        }
    }
}

/// What the panel asks of the tick's end.
#[derive(Clone, Debug, PartialEq)]
// There are three slots of it, and no heap to box the setup in.
#[allow(clippy::large_enum_variant)]
pub(super) enum Order {
    /// Make this record, whatever is being recorded.
    Record(Setup),
    /// Trigger when the tick has taken so many commands; `None` takes that back.
    Expect(Option<u32>),
    /// Stop waiting for a trigger, or recording. What is recorded stays.
    Stop,
}
