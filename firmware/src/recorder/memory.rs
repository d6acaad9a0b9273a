//! The memory of a recorder, and its two ends.

use super::reader::PanelRecorder;
use super::setup::{Order, WIDEST};
use super::writer::TickRecorder;
use core::sync::atomic::{AtomicI32, AtomicU32};
use heapless::spsc::Queue;

/// Slots of the queue of orders (one is lost to the ring).
pub(super) const ORDERS: usize = 4;

/// A recorder of so many words. All zero at first: as a static it costs no flash.
pub struct Recorder<const WORDS: usize> {
    words: [AtomicU32; WORDS],
    head: Head,
    orders: Queue<Order, ORDERS>,
}

/// What the tick tells of the record. It alone writes here.
pub(super) struct Head {
    /// The record that the rest is about.
    pub number: AtomicU32,
    /// Its complete rows.
    pub rows: AtomicU32,
    /// Where in the ring its first row lies.
    pub first: AtomicU32,
    /// Its rows before the trigger.
    pub before: AtomicU32,
    /// Upper halves of the row of the trigger, from which turns are put back.
    pub upper: [AtomicI32; WIDEST],
}

impl<const WORDS: usize> Recorder<WORDS> {
    /// An empty recorder.
    #[allow(clippy::new_without_default)] // A default of 90 KB is nothing to be made in passing.
    pub const fn new() -> Self {
        Self {
            words: [const { AtomicU32::new(0) }; WORDS],
            head: Head {
                number: AtomicU32::new(0),
                rows: AtomicU32::new(0),
                first: AtomicU32::new(0),
                before: AtomicU32::new(0),
                upper: [const { AtomicI32::new(0) }; WIDEST],
            },
            orders: Queue::new(),
        }
    }

    /// The end in the tick, and the one outside of it.
    pub fn split(&mut self) -> (TickRecorder<'_>, PanelRecorder<'_>) {
        let (order_in, order_out) = self.orders.split();
        (
            TickRecorder::new(&self.words, &self.head, order_out),
            PanelRecorder::new(&self.words, &self.head, order_in),
        )
    }
}
