//! What the loop counts between two snapshots: always on, a few instructions a tick.

/// Since the snapshot before. Sums and worst values of longer times are the command side's to make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoopCounters {
    /// Ticks.
    pub ticks: u32,
    /// Cost of the last tick but one, processor cycles; 0 where nobody counts them.
    pub cycles: u32,
    /// Sum of the ticks' costs.
    pub cycles_sum: u32,
    /// Largest of them.
    pub cycles_worst: u32,
    /// Ticks that ended after their deadline or did not come at all.
    pub late: u32,
    /// Largest following error of a pivot, 2^-32 turns.
    pub peak_error: u32,
}

impl LoopCounters {
    /// Takes what is known of the tick before.
    #[inline]
    pub fn count_tick(&mut self, cycles: u32, late: bool) {
        self.ticks = self.ticks.wrapping_add(1);
        self.cycles = cycles;
        self.cycles_sum = self.cycles_sum.wrapping_add(cycles);
        self.cycles_worst = self.cycles_worst.max(cycles);
        self.late = self.late.wrapping_add(u32::from(late));
    }

    /// Takes the largest following error of a tick.
    #[inline]
    pub fn observe_error(&mut self, error: u32) {
        self.peak_error = self.peak_error.max(error);
    }
}
