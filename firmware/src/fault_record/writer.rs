//! The fault record's end in the tick.

use super::row::words;
use super::{AFTER, BlackBox};
use crate::mode::Mode;
use crate::recorder::{Record, Sample};
use core::sync::atomic::Ordering;

/// Writes every tick into the fault record, until some ticks after a fault. From then on the record rests until the servo is on
/// again; the same after a start that finds a record.
pub struct History<'a> {
    memory: &'a BlackBox,
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

impl<'a> History<'a> {
    pub(super) fn new(memory: &'a BlackBox, start: u32, is_frozen: bool) -> Self {
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
    pub fn start_again(&mut self) {
        *self = self.memory.begin();
    }

    fn go_on(&mut self, mode: Mode) -> bool {
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
            (State::Running, Mode::Fault | Mode::Stopping) => self.state = State::Ending(AFTER - 1),
            (State::Running, _) => {}
        }
        true
    }
}

impl Record for History<'_> {
    #[inline]
    fn record(&mut self, sample: &Sample) {
        if self.go_on(sample.mode) {
            let words = words(sample, self.start);
            self.memory.rows.write(sample.tick as u32, &words);
        }
    }
}
