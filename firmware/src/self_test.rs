//! What a board can be asked about itself while its bridges sleep.
//!
//! The library asks and judges; what a reading is and where it comes from is the board's to know.

use core::ops::RangeInclusive;

/// A board, as it describes itself.
pub trait Board: Sync {
    /// What it is, in words.
    fn name(&self) -> &'static str;

    /// Tells every reading that it can take with the bridges asleep, at once: some milliseconds are all that may be waited here.
    fn readings(&self, tell: &mut dyn FnMut(&Reading));

    /// Cycles that a tick may take until its duties are written, where somebody counts them.
    fn deadline_cycles(&self) -> Option<u32> {
        None
    }

    /// Whether a debugger is attached: it can halt the processor, and with it the loop, at any time.
    fn has_debugger(&self) -> bool {
        false
    }
}

/// Something that a board has read about itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// What it is, one word in capitals.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Unit of the value; empty where it has none.
    pub unit: &'static str,
    /// What it has to be.
    pub good: RangeInclusive<f64>,
}

impl Reading {
    /// Whether it is what it has to be.
    pub fn is_good(&self) -> bool {
        self.good.contains(&self.value)
    }
}
