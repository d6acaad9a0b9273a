//! The recorder's end that takes the samples of the ticks.

use super::published::Published;
use super::sample::{Sample, ServoSamples};
use super::setup::{ORDER_SLOTS, Order, RecordSetup};
use core::sync::atomic::{AtomicU32, Ordering};
use heapless::spsc::Consumer;

/// Takes orders, looks for the trigger and writes rows. Costs two flags read while there is nothing to do; otherwise,
/// each tick, a comparison for each value that is watched, and each row a few instructions for each word in it.
pub struct RecorderWriter<'a> {
    words: &'a [AtomicU32],
    published: &'a Published,
    orders: Consumer<'a, Order>,
    setup: RecordSetup,
    state: State,
    /// Row of the ring that is written next.
    at: u32,
    /// Rows that the ring holds from before the trigger, or of the record.
    rows: u32,
    /// Ticks until the next row.
    ticks_left: u32,
    /// Of each level trigger, whether its signal was at or above its value; bit i for the i-th.
    were_above: u8,
    /// There was a tick before: `were_above` and `was_faulted` hold.
    has_previous: bool,
    was_faulted: bool,
    servos: ServoSamples,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    /// Waiting for the trigger; the ring fills if rows before it are wanted.
    Waiting,
    /// Triggered; its row is the next.
    Triggered,
    Recording,
}

impl<'a> RecorderWriter<'a> {
    pub(super) fn new(
        words: &'a [AtomicU32],
        head: &'a Published,
        orders: Consumer<'a, Order>,
    ) -> Self {
        Self {
            words,
            published: head,
            orders,
            setup: RecordSetup::default(),
            state: State::Idle,
            at: 0,
            rows: 0,
            ticks_left: 0,
            were_above: 0,
            has_previous: false,
            was_faulted: false,
            servos: ServoSamples::default(),
        }
    }

    /// Whether it records, waits for a trigger, or is to.
    #[inline]
    pub fn is_active(&self) -> bool {
        self.state != State::Idle || self.orders.ready()
    }

    /// Takes the sample of a tick. It tells of one servo: they are followed whether something is recorded or not.
    #[inline]
    pub fn observe(&mut self, sample: &Sample) {
        self.servos.update(sample);
        if self.is_active() {
            self.record(sample);
        }
    }

    #[inline(never)]
    fn record(&mut self, sample: &Sample) {
        // As many as fit into the queue.
        for _ in 1..ORDER_SLOTS {
            match self.orders.dequeue() {
                Some(order) => self.take_order(order),
                None => break,
            }
        }
        if self.state == State::Waiting && self.is_triggered(sample) {
            self.state = State::Triggered;
            if self.setup.before == 0 {
                // The record begins at the trigger, not at the next row of a ring that nobody asked for.
                self.ticks_left = 0;
                self.publish();
            }
        }
        match self.state {
            State::Idle => {}
            State::Waiting if self.setup.before == 0 => {}
            _ if self.ticks_left > 0 => self.ticks_left -= 1,
            _ => self.write_row(sample),
        }
    }

    fn take_order(&mut self, order: Order) {
        match order {
            Order::Start(setup) => {
                self.setup = setup;
                self.state = State::Waiting;
                self.at = 0;
                self.rows = 0;
                self.ticks_left = 0;
                self.has_previous = false;
                if self.setup.before > 0 {
                    // The ring overwrites what was there.
                    self.publish();
                }
            }
            Order::TriggerAt(commands) => self.setup.commands = commands,
            Order::Stop => self.state = State::Idle,
        }
    }

    /// From here on the memory is this record's.
    fn publish(&self) {
        self.published.rows.store(0, Ordering::Relaxed);
        // Whoever sees the number sees no rows of the record before it.
        self.published
            .number
            .store(self.setup.number, Ordering::Release);
    }

    fn is_triggered(&mut self, sample: &Sample) -> bool {
        let setup = &self.setup;
        let taken = |commands: u32| sample.commands.wrapping_sub(commands) as i32 >= 0;
        let mut triggered = setup.now || setup.commands.is_some_and(taken);
        let faulted = sample.fault.is_some();
        triggered |= setup.fault && self.has_previous && faulted && !self.was_faulted;
        let mut above = 0;
        for (i, trigger) in setup.level_triggers.iter().enumerate() {
            let bit = 1 << i;
            if trigger.signal.level(sample, &self.servos) >= trigger.level {
                above |= bit;
            }
            let crossed = self.has_previous && (above ^ self.were_above) & bit != 0;
            triggered |= crossed && (above & bit != 0) == trigger.rising;
        }
        self.were_above = above;
        self.was_faulted = faulted;
        self.has_previous = true;
        triggered
    }

    /// Writes a row; the record's own are published to the reader.
    fn write_row(&mut self, sample: &Sample) {
        self.ticks_left = self.setup.every.saturating_sub(1);
        let width = self.setup.signals.len();
        let start = self.at as usize * width;
        if let Some(row) = self.words.get(start..start + width) {
            for (cell, signal) in row.iter().zip(&self.setup.signals) {
                cell.store(signal.value(sample, &self.servos) as u32, Ordering::Relaxed);
            }
        }
        if self.state == State::Triggered {
            self.begin_at_trigger(sample);
        }
        self.at += 1;
        if self.at >= self.setup.rows {
            self.at = 0;
        }
        if self.state == State::Recording {
            self.rows += 1;
            self.published.rows.store(self.rows, Ordering::Release);
            if self.rows >= self.setup.rows {
                self.state = State::Idle;
            }
        } else if self.rows < self.setup.before {
            self.rows += 1;
        }
    }

    /// The row just written is the trigger's.
    fn begin_at_trigger(&mut self, sample: &Sample) {
        let before = self.rows;
        let first = if self.at >= before {
            self.at - before
        } else {
            self.at + self.setup.rows - before
        };
        for (upper, signal) in self.published.upper.iter().zip(&self.setup.signals) {
            upper.store(
                (signal.value(sample, &self.servos) >> 32) as i32,
                Ordering::Relaxed,
            );
        }
        self.published.first.store(first, Ordering::Relaxed);
        self.published.before.store(before, Ordering::Relaxed);
        self.state = State::Recording;
    }
}
