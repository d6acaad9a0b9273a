//! The data recorder at the front panel: what is recorded, when it begins, and reading it.
//!
//! There are eight tables. `DRC` says what a table records, `RTR` how often, `DRT` what triggers; tables share the rate, and
//! recording begins in all of them as soon as the trigger of any comes. `DRT` arms: it orders a record from the tick, and the
//! one before is gone once the new one begins to be written. What is read is the last record that was ordered.
//!
//! | file | idea |
//! |---|---|
//! | here | requests, and what the recorder_state keeps |
//! | `option` | what can be recorded, and of what words it is worked out |
//! | `trigger` | what can begin a record |
//! | `arm` | from tables and triggers to an order, and the commands that trigger |
//! | `parse` | lines |
//! | `tell` | answers of a few lines |
//! | `dump` | `DRR?`: an answer of any length, written as the output has room |
//! | `history` | `FLR?`: the fault record, the same way |

mod execute;
mod fault_record_readout;
mod options;
mod parse;
mod readout;
mod replies;
mod trigger;

pub(super) use fault_record_readout::FaultRecordReadout;
pub use options::{Channel, SignalSource};
pub(super) use parse::{
    channels, count, data, fault_record, help, lengths, rate, set_channels, set_rate, set_triggers,
    triggers,
};
pub(super) use readout::RecordReadout;
pub use trigger::Trigger;

use super::error::ErrorCode;
use crate::parameters::Parameters;
use crate::recorder::{MOST_BETWEEN, PanelRecorder, Setup, TABLES};
use options::Scales;

/// Tables that a line names, counted from 0, in its order; none stands for all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableList {
    tables: [u8; TABLES],
    count: u8,
}

/// A question about the recorder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordQuery {
    /// `DRC?`: what tables record.
    Channels(TableList),
    /// `DRT?`: what triggers them.
    Triggers(TableList),
    /// `RTR?`: ticks from row to row.
    Rate,
    /// `DRL?`: rows that can be read.
    Lengths(TableList),
    /// `HDR?`: options and triggers.
    Help,
    /// `TNR?`: number of tables.
    Count,
    /// `DRR?`: rows, counted from 1, and how many; all without them.
    Data(Option<[u32; 2]>, TableList),
    /// `FLR?`: the fault record.
    FaultRecord,
}

/// Something to be done to the recorder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecordAction {
    /// `DRC`: tables, counted from 0, and what they record; `None` switches one off.
    Channels([Option<(u8, Option<Channel>)>; TABLES]),
    /// `DRT`: tables, counted from 0, and what triggers them.
    Triggers([Option<(u8, Trigger)>; TABLES]),
    /// `RTR`: ticks from row to row.
    Rate(f64),
}

impl TableList {
    fn of(tables: impl Iterator<Item = u8>) -> Self {
        let mut list = Self::default();
        for (place, table) in list.tables.iter_mut().zip(tables) {
            *place = table;
            list.count += 1;
        }
        list
    }

    fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Those named, or all.
    fn iter(&self) -> impl Iterator<Item = usize> {
        let all = if self.is_empty() { TABLES } else { 0 };
        let named = self.tables.into_iter().take(self.count.into());
        named.map(usize::from).chain(0..all)
    }
}

/// A table: what it records, and what triggers it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Table {
    channel: Option<Channel>,
    trigger: Trigger,
}

/// A record that was ordered: what it is made of, and how it is to be read.
#[derive(Clone, Debug)]
struct Record {
    setup: Setup,
    channels: [Option<Channel>; TABLES],
    scales: Scales,
}

/// What is to be told to the tick when there is room in the queue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PendingOrder {
    #[default]
    Nothing,
    Record,
    Stop,
}

/// What the panel keeps of the recorder.
pub(super) struct RecorderState {
    tables: [Table; TABLES],
    every: u32,
    /// The record that was ordered last, and the one before, in case that is taken back.
    record: Option<Record>,
    before: Option<Record>,
    /// Whether it was stopped while it was waiting for its trigger.
    stopped: bool,
    pending_order: PendingOrder,
}

impl RecorderState {
    /// The pose, commanded and real, a motor, and the supervisor's state.
    pub fn new() -> Self {
        Self {
            tables: options::DEFAULT_CHANNELS.map(|channel| Table {
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
        let width = options::words(&self.channels()).len().max(1);
        (words / width) as u32
    }

    /// Carries out a change; an error means that nothing has changed. Points that fit no longer are fewer then.
    pub fn change(
        &mut self,
        action: &RecordAction,
        parameters: &mut Parameters,
        recorder: &PanelRecorder<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            RecordAction::Channels(changes) => {
                for &(table, channel) in changes.iter().flatten() {
                    self.set_channel(usize::from(table), channel);
                }
                let tuning = &mut parameters.recorder;
                tuning.points = tuning.points.min(self.most_rows(recorder.capacity()));
                tuning.before = tuning.before.min(tuning.points - 1);
                self.rearm(recorder);
            }
            RecordAction::Triggers(changes) => self.set_triggers(changes, recorder)?,
            RecordAction::Rate(ticks) => {
                if !(1.0..=f64::from(MOST_BETWEEN)).contains(ticks) || libm::trunc(*ticks) != *ticks
                {
                    return Err(ErrorCode::OutOfRange);
                }
                self.every = *ticks as u32;
                self.rearm(recorder);
            }
        }
        Ok(())
    }

    fn channels(&self) -> [Option<Channel>; TABLES] {
        self.tables.map(|table| table.channel)
    }

    /// A value that is trigger_word is one of the signal that was there: it goes with it.
    fn set_channel(&mut self, table: usize, channel: Option<Channel>) {
        let table = &mut self.tables[table];
        if table.channel != channel && matches!(table.trigger, Trigger::Crosses { .. }) {
            table.trigger = Trigger::Never;
        }
        table.channel = channel;
    }

    fn set_triggers(
        &mut self,
        changes: &[Option<(u8, Trigger)>; TABLES],
        recorder: &PanelRecorder<'_>,
    ) -> Result<(), ErrorCode> {
        let mut tables = self.tables;
        for &(table, trigger) in changes.iter().flatten() {
            let table = &mut tables[usize::from(table)];
            if matches!(trigger, Trigger::Crosses { .. }) {
                let channel = table.channel.ok_or(ErrorCode::TableOff)?;
                channel.trigger_word().ok_or(ErrorCode::OutOfRange)?;
            }
            table.trigger = trigger;
        }
        let armed = tables.iter().any(|table| table.trigger != Trigger::Never);
        if armed && tables.iter().all(|table| table.channel.is_none()) {
            return Err(ErrorCode::TableOff);
        }
        self.tables = tables;
        if armed {
            self.pending_order = PendingOrder::Record;
        } else if self.is_waiting(recorder) {
            self.pending_order = PendingOrder::Stop;
        }
        Ok(())
    }
}
