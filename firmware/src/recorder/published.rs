//! What the tick publishes of a record, for the reader.

use super::setup::MAX_ROW_WORDS;
use core::sync::atomic::{AtomicI32, AtomicU32};

/// What is known of the record outside the tick, which alone writes here.
pub(super) struct Published {
    /// The record that the rest is about.
    pub number: AtomicU32,
    /// Its complete rows.
    pub rows: AtomicU32,
    /// Where in the ring its first row lies.
    pub first: AtomicU32,
    /// Its rows before the trigger.
    pub before: AtomicU32,
    /// Upper halves of the row of the trigger, from which turns are put back.
    pub upper: [AtomicI32; MAX_ROW_WORDS],
}
