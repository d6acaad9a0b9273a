//! Reading the fault record.

use super::memory::{FAULT_RECORD_ROWS, RetainedMemory};
use super::row::{FaultRecordRow, row, start_number};
use core::sync::atomic::Ordering;

/// Which rows of the memory are the record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultRecord {
    start: u8,
    /// Ticks of the first and the last row, low 32 bits.
    first: u32,
    last: u32,
    /// Rows that are whole.
    pub rows: u32,
}

impl RetainedMemory {
    /// The fault record, if there is one: not while the loop still writes it.
    pub fn fault_record(&self) -> Option<FaultRecord> {
        if self.frozen.load(Ordering::Acquire) == 0 {
            return None;
        }
        let (start, last) = self.newest_row()?;
        let first = last.wrapping_sub(FAULT_RECORD_ROWS as u32 - 1);
        let mut span = FaultRecord {
            start,
            first,
            last,
            rows: 0,
        };
        let mut at = span.first_row();
        while self.next(&span, &mut at).is_some() {
            span.rows += 1;
        }
        Some(span)
    }

    /// The next row of the record that is whole, from a cursor that [`FaultRecord::first_row`] has made; `None` at its
    /// end.
    pub fn next(&self, span: &FaultRecord, cursor: &mut u32) -> Option<FaultRecordRow> {
        while *cursor < FAULT_RECORD_ROWS as u32 {
            let tick = span.first.wrapping_add(*cursor);
            *cursor += 1;
            if let Some(words) = self.rows.read(tick)
                && words[0] == tick
                && start_number(&words) == span.start
            {
                return Some(row(&words));
            }
        }
        None
    }

    /// The last row that was written, by start and tick: that of the latest start that has any.
    pub(super) fn newest_row(&self) -> Option<(u8, u32)> {
        let now = self.start.load(Ordering::Relaxed) as u8;
        let mut newest: Option<(u8, u32)> = None;
        for words in (0..FAULT_RECORD_ROWS as u32).filter_map(|place| self.rows.read(place)) {
            let (start, tick) = (start_number(&words), words[0]);
            let is_newer = newest.is_none_or(|(latest, last)| {
                let (age, least) = (now.wrapping_sub(start), now.wrapping_sub(latest));
                age < least || (age == least && tick.wrapping_sub(last) as i32 > 0)
            });
            if is_newer {
                newest = Some((start, tick));
            }
        }
        newest
    }
}

impl FaultRecord {
    /// A cursor at its first row.
    pub const fn first_row(&self) -> u32 {
        0
    }
}
