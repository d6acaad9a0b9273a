//! The fault record's end that takes the samples of the ticks.

use super::memory::{LAYOUT_MAGIC, ROWS_AFTER_FAULT, RetainedMemory};
use super::row::words;
use crate::mode::Mode;
use crate::recorder::{Sample, TickObserver};
use core::sync::atomic::Ordering;

/// Writes every tick into the fault record, until some ticks after a fault. From then on the record rests until the
/// servo is on again; the same after a start that finds a record.
pub struct FaultRecordWriter<'a> {
    memory: &'a RetainedMemory,
    start: u32,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Running,
    /// A fault: so many ticks are still written.
    Ending(u32),
    Frozen,
}

impl<'a> FaultRecordWriter<'a> {
    pub(super) fn new(memory: &'a RetainedMemory, start: u32, is_frozen: bool) -> Self {
        let state = if is_frozen {
            State::Frozen
        } else {
            State::Running
        };
        Self {
            memory,
            start,
            state,
        }
    }

    /// The controller starts again, without a reset.
    pub fn restart(&mut self) {
        *self = self.memory.begin();
    }

    fn advance(&mut self, mode: Mode) -> bool {
        match (self.state, mode) {
            (State::Frozen, Mode::Holding | Mode::Moving) => {
                self.memory.frozen.store(0, Ordering::Relaxed);
                self.state = State::Running;
            }
            (State::Frozen, _) => return false,
            (State::Ending(0), _) => {
                self.state = State::Frozen;
                self.memory.frozen.store(1, Ordering::Release);
                return false;
            }
            (State::Ending(left), _) => self.state = State::Ending(left - 1),
            (State::Running, Mode::Fault | Mode::Stopping) => {
                self.state = State::Ending(ROWS_AFTER_FAULT - 1)
            }
            (State::Running, _) => {}
        }
        true
    }
}

impl RetainedMemory {
    /// The controller starts: what is there from before is kept, as far as it is whole. Gives the end that takes samples.
    pub fn begin(&self) -> FaultRecordWriter<'_> {
        if self.layout.load(Ordering::Relaxed) != LAYOUT_MAGIC {
            self.events.clear();
            self.faults.clear();
            self.motor_heat.clear();
            self.rows.clear();
            self.start.store(0, Ordering::Relaxed);
            self.layout.store(LAYOUT_MAGIC, Ordering::Relaxed);
        }
        let start = self.start.load(Ordering::Relaxed).wrapping_add(1);
        self.start.store(start, Ordering::Relaxed);
        let is_record = self.newest_row().is_some();
        self.frozen.store(u32::from(is_record), Ordering::Relaxed);
        FaultRecordWriter::new(self, start, is_record)
    }
}

impl TickObserver for FaultRecordWriter<'_> {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        if self.advance(sample.mode) {
            let words = words(sample, self.start);
            self.memory.rows.write(sample.tick as u32, &words);
        }
    }
}
