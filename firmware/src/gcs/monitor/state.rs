//! What a connection has not been told yet.

use crate::queues::Snapshot;

/// The lowest and highest of one quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Range {
    pub lowest: i32,
    pub highest: i32,
}

impl Range {
    fn widen(&mut self, value: i32, first: bool) {
        if first || value < self.lowest {
            self.lowest = value;
        }
        if first || value > self.highest {
            self.highest = value;
        }
    }
}

/// What a connection has not been told yet.
#[derive(Clone, Debug, Default)]
pub(in crate::gcs) struct Monitor {
    /// The tick looked at last.
    pub(super) tick: u64,
    /// The next tick begins new ranges.
    pub(super) starts_anew: bool,
    pub(super) errors: [Range; 3],
    pub(super) duties: [Range; 3],
}

impl Monitor {
    /// Takes what is known at a tick; the same one again changes nothing.
    pub fn update(&mut self, snapshot: &Snapshot) {
        if snapshot.tick == self.tick {
            return;
        }
        let first = self.starts_anew || self.tick == 0;
        self.tick = snapshot.tick;
        self.starts_anew = false;
        for i in 0..3 {
            self.errors[i].widen(snapshot.pivot_errors[i], first);
            self.duties[i].widen(snapshot.duty[i].0.into(), first);
        }
    }
}
