//! The recorder's end in the tick.

use super::memory::{Head, ORDERS};
use super::sample::Sample;
use super::setup::{Order, Setup};
use core::sync::atomic::{AtomicU32, Ordering};
use heapless::spsc::Consumer;

/// Takes orders, looks for the trigger and writes rows. Costs a look at two flags while there is nothing to do; otherwise, each
/// tick, a comparison for each value that is watched, and each row a few instructions for each word in it.
pub struct TickRecorder<'a> {
    words: &'a [AtomicU32],
    head: &'a Head,
    orders: Consumer<'a, Order>,
    setup: Setup,
    state: State,
    /// Row of the ring that is written next.
    at: u32,
    /// Rows that the ring holds from before the trigger, or of the record.
    rows: u32,
    /// Ticks until the next row.
    left: u32,
    /// Of each watch, whether its signal was at or above its value; bit i for the i-th.
    above: u8,
    /// A tick has been looked at: `above` and `faulted` hold.
    looked: bool,
    faulted: bool,
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

impl<'a> TickRecorder<'a> {
    pub(super) fn new(words: &'a [AtomicU32], head: &'a Head, orders: Consumer<'a, Order>) -> Self {
        Self {
            words,
            head,
            orders,
            setup: Setup::default(),
            state: State::Idle,
            at: 0,
            rows: 0,
            left: 0,
            above: 0,
            looked: false,
            faulted: false,
        }
    }

    /// Whether [`record`](Self::record) would do something: the sample need not be made otherwise.
    #[inline]
    pub fn is_wanted(&self) -> bool {
        self.state != State::Idle || self.orders.ready()
    }

    /// Takes the sample of a tick.
    #[inline(never)]
    pub fn record(&mut self, sample: &Sample) {
        // As many as fit into the queue.
        for _ in 1..ORDERS {
            match self.orders.dequeue() {
                Some(order) => self.obey(order),
                None => break,
            }
        }
        if self.state == State::Waiting && self.is_triggered(sample) {
            self.state = State::Triggered;
            if self.setup.before == 0 {
                // The record begins at the trigger, not at the next row of a ring that nobody asked for.
                self.left = 0;
                self.publish();
            }
        }
        match self.state {
            State::Idle => {}
            State::Waiting if self.setup.before == 0 => {}
            _ if self.left > 0 => self.left -= 1,
            _ => self.keep(sample),
        }
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Record(setup) => {
                self.setup = setup;
                self.state = State::Waiting;
                self.at = 0;
                self.rows = 0;
                self.left = 0;
                self.looked = false;
                if self.setup.before > 0 {
                    // The ring overwrites what was there.
                    self.publish();
                }
            }
            Order::Expect(commands) => self.setup.commands = commands,
            Order::Stop => self.state = State::Idle,
        }
    }

    /// From here on the memory is this record's.
    fn publish(&self) {
        self.head.rows.store(0, Ordering::Relaxed);
        // Whoever sees the number sees no rows of the record before it.
        self.head.number.store(self.setup.number, Ordering::Release);
    }

    fn is_triggered(&mut self, sample: &Sample) -> bool {
        let setup = &self.setup;
        let taken = |commands: u32| sample.commands.wrapping_sub(commands) as i32 >= 0;
        let mut triggered = setup.now || setup.commands.is_some_and(taken);
        let faulted = sample.fault.is_some();
        triggered |= setup.fault && self.looked && faulted && !self.faulted;
        let mut above = 0;
        for (i, watch) in setup.watches.iter().enumerate() {
            let bit = 1 << i;
            if watch.word.level(sample) >= watch.level {
                above |= bit;
            }
            let crossed = self.looked && (above ^ self.above) & bit != 0;
            triggered |= crossed && (above & bit != 0) == watch.rising;
        }
        self.above = above;
        self.faulted = faulted;
        self.looked = true;
        triggered
    }

    /// Writes a row; the record's own are told to the reader.
    fn keep(&mut self, sample: &Sample) {
        self.left = self.setup.every.saturating_sub(1);
        let width = self.setup.words.len();
        let start = self.at as usize * width;
        if let Some(row) = self.words.get(start..start + width) {
            for (cell, word) in row.iter().zip(&self.setup.words) {
                cell.store(word.take(sample) as u32, Ordering::Relaxed);
            }
        }
        if self.state == State::Triggered {
            self.begin(sample);
        }
        self.at += 1;
        if self.at >= self.setup.rows {
            self.at = 0;
        }
        if self.state == State::Recording {
            self.rows += 1;
            self.head.rows.store(self.rows, Ordering::Release);
            if self.rows >= self.setup.rows {
                self.state = State::Idle;
            }
        } else if self.rows < self.setup.before {
            self.rows += 1;
        }
    }

    /// The row just written is the trigger's.
    fn begin(&mut self, sample: &Sample) {
        let before = self.rows;
        let first = if self.at >= before {
            self.at - before
        } else {
            self.at + self.setup.rows - before
        };
        for (upper, word) in self.head.upper.iter().zip(&self.setup.words) {
            upper.store((word.take(sample) >> 32) as i32, Ordering::Relaxed);
        }
        self.head.first.store(first, Ordering::Relaxed);
        self.head.before.store(before, Ordering::Relaxed);
        self.state = State::Recording;
    }
}
