//! What the loop counts between two snapshots: always on, a few instructions a tick.

/// Since the snapshot before. Sums and worst values of longer times are the command side's to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopCounters {
    /// Ticks.
    pub ticks: u32,
    /// Cost of the last tick but one, processor cycles; 0 where nobody counts them.
    pub cycles: u32,
    /// Sum of the ticks' costs.
    pub cycles_sum: u32,
    /// Largest of them.
    pub cycles_worst: u32,
    /// Least time from whole encoder frames to the tick, processor cycles; [`u32::MAX`] where nobody counts them.
    pub frame_margin_least: u32,
    /// Ticks that ended after their deadline or did not come at all.
    pub late: u32,
    /// Largest following error of a pivot, 2^-32 turns.
    pub peak_error: u32,
}

impl Default for LoopCounters {
    fn default() -> Self {
        Self {
            ticks: 0,
            cycles: 0,
            cycles_sum: 0,
            cycles_worst: 0,
            frame_margin_least: u32::MAX,
            late: 0,
            peak_error: 0,
        }
    }
}

impl LoopCounters {
    /// Takes what is known of the tick before, and of the frames of this one.
    #[inline]
    pub fn count_tick(&mut self, cycles: u32, frame_margin: u32, late: bool) {
        self.ticks = self.ticks.wrapping_add(1);
        self.cycles = cycles;
        self.cycles_sum = self.cycles_sum.wrapping_add(cycles);
        self.cycles_worst = self.cycles_worst.max(cycles);
        self.frame_margin_least = self.frame_margin_least.min(frame_margin);
        self.late = self.late.wrapping_add(u32::from(late));
    }

    /// Takes the largest following error of a tick.
    #[inline]
    pub fn observe_error(&mut self, error: u32) {
        self.peak_error = self.peak_error.max(error);
    }
}
