//! The memory of a recorder, and its two ends.

use super::published::Published;
use super::reader::RecorderReader;
use super::setup::{MAX_ROW_WORDS, ORDER_SLOTS, Order};
use super::writer::RecorderWriter;
use core::sync::atomic::{AtomicI32, AtomicU32};
use heapless::spsc::Queue;

/// A recorder of so many words. All zero at first: as a static it costs no flash.
pub struct Recorder<const WORDS: usize> {
    words: [AtomicU32; WORDS],
    published: Published,
    orders: Queue<Order, ORDER_SLOTS>,
}

impl<const WORDS: usize> Recorder<WORDS> {
    /// An empty recorder.
    #[allow(clippy::new_without_default)] // A default of 90 KB is nothing to be made in passing.
    pub const fn new() -> Self {
        Self {
            words: [const { AtomicU32::new(0) }; WORDS],
            published: Published {
                number: AtomicU32::new(0),
                rows: AtomicU32::new(0),
                first: AtomicU32::new(0),
                before: AtomicU32::new(0),
                upper: [const { AtomicI32::new(0) }; MAX_ROW_WORDS],
            },
            orders: Queue::new(),
        }
    }

    /// The tick's end, and the command side's.
    pub fn split(&mut self) -> (RecorderWriter<'_>, RecorderReader<'_>) {
        let (order_in, order_out) = self.orders.split();
        (
            RecorderWriter::new(&self.words, &self.published, order_out),
            RecorderReader::new(&self.words, &self.published, order_in),
        )
    }
}
