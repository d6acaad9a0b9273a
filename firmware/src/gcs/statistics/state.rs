//! What the loop has counted, snapshot after snapshot.

use crate::control::loop_counters::LoopCounters;
use crate::queues::Snapshot;

/// Since the start or since `LST`; the peak of the following error since it was told.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct Statistics {
    pub ticks: u64,
    pub cycles: u32,
    pub cycles_sum: u64,
    pub cycles_worst: u32,
    /// `None` where nobody counts.
    pub frame_margin_least: Option<u32>,
    pub late: u32,
    pub peak_error: u32,
    pub commands: u32,
    pub refused: u32,
    /// Commands taken and refused up to the latest snapshot.
    pub counted: (u32, u32),
}

impl Statistics {
    /// Takes the next snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        let LoopCounters {
            ticks,
            cycles,
            cycles_sum,
            cycles_worst,
            frame_margin_least,
            late,
            peak_error,
        } = snapshot.loop_counters;
        self.ticks += u64::from(ticks);
        self.cycles = cycles;
        self.cycles_sum += u64::from(cycles_sum);
        self.cycles_worst = self.cycles_worst.max(cycles_worst);
        if frame_margin_least != u32::MAX {
            let before = self.frame_margin_least.unwrap_or(u32::MAX);
            self.frame_margin_least = Some(before.min(frame_margin_least));
        }
        self.late = self.late.saturating_add(late);
        self.peak_error = self.peak_error.max(peak_error);
        let (commands, refused) = self.counted;
        self.commands = (self.commands).wrapping_add(snapshot.commands.wrapping_sub(commands));
        self.refused = (self.refused).wrapping_add(snapshot.refused.wrapping_sub(refused));
        self.counted = (snapshot.commands, snapshot.refused);
    }

    pub fn restart(&mut self) {
        *self = Self {
            counted: self.counted,
            ..Self::default()
        };
    }
}
