//! What lines about the recorder ask for.

use super::channel::Channel;
use super::trigger::Trigger;
use crate::recorder::RECORDER_TABLES;

/// Tables that a line names, counted from 0, in its order; none stands for all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableList {
    tables: [u8; RECORDER_TABLES],
    count: u8,
}

impl TableList {
    pub(super) fn of(tables: impl Iterator<Item = u8>) -> Self {
        let mut list = Self::default();
        for (place, table) in list.tables.iter_mut().zip(tables) {
            *place = table;
            list.count += 1;
        }
        list
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Those named, or all.
    pub(super) fn iter(&self) -> impl Iterator<Item = usize> {
        let all = if self.is_empty() { RECORDER_TABLES } else { 0 };
        let named = self.tables.into_iter().take(self.count.into());
        named.map(usize::from).chain(0..all)
    }
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
    Channels([Option<(u8, Option<Channel>)>; RECORDER_TABLES]),
    /// `DRT`: tables, counted from 0, and what triggers them.
    Triggers([Option<(u8, Trigger)>; RECORDER_TABLES]),
    /// `RTR`: ticks from row to row.
    Rate(f64),
}
