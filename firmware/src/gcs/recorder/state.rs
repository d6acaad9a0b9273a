//! What the command side keeps of the recorder.

use super::channel::{self, Channel};
use super::scales::Scales;
use super::trigger::Trigger;
use crate::recorder::{RECORDER_TABLES, RecordSetup};

/// A table: what it records, and what triggers it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Table {
    pub(super) channel: Option<Channel>,
    pub(super) trigger: Trigger,
}

/// A record that was ordered: what it is made of, and how it is to be read.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub(super) setup: RecordSetup,
    pub(super) channels: [Option<Channel>; RECORDER_TABLES],
    pub(super) scales: Scales,
}

/// What is to be sent to the tick when there is room in the queue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum PendingOrder {
    #[default]
    Nothing,
    Record,
    Stop,
}

/// What the command side knows of the recorder.
pub(in crate::gcs) struct RecorderState {
    pub(super) tables: [Table; RECORDER_TABLES],
    pub(super) every: u32,
    /// The record that was ordered last, and the one before, in case that is taken back.
    pub(super) record: Option<Record>,
    pub(super) before: Option<Record>,
    /// Whether it was stopped while it was waiting for its trigger.
    pub(super) stopped: bool,
    pub(super) pending_order: PendingOrder,
}

impl RecorderState {
    /// The pose, commanded and real, a motor, and the supervisor's state.
    pub fn new() -> Self {
        Self {
            tables: channel::DEFAULT_CHANNELS.map(|channel| Table {
                channel: Some(channel),
                trigger: Trigger::Never,
            }),
            every: 1,
            record: None,
            before: None,
            stopped: false,
            pending_order: PendingOrder::Nothing,
        }
    }

    /// Rows that fit into so many words.
    pub fn most_rows(&self, words: usize) -> u32 {
        let width = channel::words(&self.channels()).len().max(1);
        (words / width) as u32
    }

    pub(super) fn channels(&self) -> [Option<Channel>; RECORDER_TABLES] {
        self.tables.map(|table| table.channel)
    }
}
