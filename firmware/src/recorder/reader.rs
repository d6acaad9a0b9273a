//! The recorder's end outside the tick: orders, and reading.

use super::published::Published;
use super::setup::{MAX_ROW_WORDS, Order, QueueFull, RecordSetup};
use super::signal::{RawSignal, SignalFormat};
use core::sync::atomic::{AtomicU32, Ordering};
use heapless::spsc::Producer;

/// Orders records and reads them.
pub struct RecorderReader<'a> {
    words: &'a [AtomicU32],
    published: &'a Published,
    orders: Producer<'a, Order>,
}

/// How far a record is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Rows that can be read. None before the trigger.
    pub rows: u32,
    /// How many of them come before the trigger's.
    pub before: u32,
}

/// A place in a record from which it is read on, with the full value of each signal there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cursor {
    /// Row, from 0.
    row: u32,
    values: [i64; MAX_ROW_WORDS],
}

impl<'a> RecorderReader<'a> {
    pub(super) fn new(
        words: &'a [AtomicU32],
        head: &'a Published,
        orders: Producer<'a, Order>,
    ) -> Self {
        Self {
            words,
            published: head,
            orders,
        }
    }

    /// Words that there is memory for.
    pub fn capacity(&self) -> usize {
        self.words.len()
    }

    /// Orders a record, in place of whatever is being recorded. Rows times words must not be more than the
    /// [`capacity`](Self::capacity): rows that find no room are not written.
    ///
    /// # Errors
    /// [`QueueFull`]: the tick has not taken the last orders yet. Nothing was ordered.
    pub fn start(&mut self, setup: &RecordSetup) -> Result<(), QueueFull> {
        self.order(Order::Start(setup.clone()))
    }

    /// Triggers the record when the tick has taken so many commands; `None` takes that back.
    ///
    /// # Errors
    /// [`QueueFull`].
    pub fn trigger_at(&mut self, commands: Option<u32>) -> Result<(), QueueFull> {
        self.order(Order::TriggerAt(commands))
    }

    /// Ends waiting for a trigger, or recording. What is recorded stays.
    ///
    /// # Errors
    /// [`QueueFull`].
    pub fn stop(&mut self) -> Result<(), QueueFull> {
        self.order(Order::Stop)
    }

    fn order(&mut self, order: Order) -> Result<(), QueueFull> {
        self.orders.enqueue(order).map_err(|_| QueueFull)
    }

    /// How far the record of this number is.
    pub fn progress(&self, number: u32) -> Progress {
        if self.published.number.load(Ordering::Acquire) != number {
            return Progress::default();
        }
        // The rows first: what they come with was written before them.
        let rows = self.published.rows.load(Ordering::Acquire);
        Progress {
            rows,
            before: self.published.before.load(Ordering::Relaxed),
        }
    }

    /// A place in the record, which must have rows: its angles are unwrapped from the row of the trigger to there.
    pub fn seek(&self, setup: &RecordSetup, row: u32) -> Cursor {
        let mut cursor = self.at_trigger(setup);
        while cursor.row < row {
            self.step(setup, &mut cursor, 1);
        }
        while cursor.row > row {
            self.step(setup, &mut cursor, -1);
        }
        cursor
    }

    /// The signals at the cursor, which goes on to the next row. Integers as they are, of floats the bits.
    pub fn next(&self, setup: &RecordSetup, cursor: &mut Cursor) -> [i64; MAX_ROW_WORDS] {
        let values = cursor.values;
        self.step(setup, cursor, 1);
        values
    }

    fn at_trigger(&self, setup: &RecordSetup) -> Cursor {
        let row = self.published.before.load(Ordering::Relaxed);
        let mut values = [0; MAX_ROW_WORDS];
        for (i, value) in values.iter_mut().enumerate().take(setup.signals.len()) {
            let upper = i64::from(self.published.upper[i].load(Ordering::Relaxed));
            *value = upper << 32 | i64::from(self.word(setup, row, i));
        }
        let mut cursor = Cursor { row, values };
        for (value, signal) in cursor.values.iter_mut().zip(&setup.signals) {
            if signal.format() != SignalFormat::Angle {
                *value = unwrap_value(*signal, 0, *value as u32);
            }
        }
        cursor
    }

    fn step(&self, setup: &RecordSetup, cursor: &mut Cursor, rows: i32) {
        cursor.row = cursor.row.wrapping_add_signed(rows);
        for (i, signal) in setup.signals.iter().enumerate() {
            let bits = self.word(setup, cursor.row, i);
            cursor.values[i] = unwrap_value(*signal, cursor.values[i], bits);
        }
    }

    /// 0 for a row that is not there: one further than the last is read and thrown away.
    fn word(&self, setup: &RecordSetup, row: u32, i: usize) -> u32 {
        let first = self.published.first.load(Ordering::Relaxed);
        let place = (first.wrapping_add(row) % setup.rows.max(1)) as usize;
        let cell = self.words.get(place * setup.signals.len() + i);
        cell.map_or(0, |cell| cell.load(Ordering::Relaxed))
    }
}

/// The value of a signal: that with these low 32 bits which is nearest to the one before, where 32 bits do not hold it.
fn unwrap_value(signal: RawSignal, last: i64, bits: u32) -> i64 {
    match signal.format() {
        SignalFormat::Angle => last.wrapping_add(i64::from(bits.wrapping_sub(last as u32) as i32)),
        SignalFormat::Length | SignalFormat::AngleError | SignalFormat::Count => {
            i64::from(bits as i32)
        }
        SignalFormat::Float => i64::from(bits),
    }
}
