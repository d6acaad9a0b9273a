//! What the ticks cost, in instructions, exactly: from the first instruction of the interrupt handler to the symbol
//! `stage_tick_end`, where the duties are written: the deadline is theirs. Exception entry and return, and what the handler
//! does after that for the recorders and the command side, come on top.

/// Cost of the ticks of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickCost {
    /// Ticks counted.
    pub ticks: u64,
    /// Instructions of all of them.
    pub total: u64,
    /// Instructions of the worst.
    pub worst: u64,
    /// The worst one, counted from the start of the run.
    pub worst_tick: u64,
    /// Instructions of the last.
    pub last: u64,
    /// Earliest and latest start of a tick, ns after its interrupt was due.
    pub start_ns: Option<(i64, i64)>,
    /// Latest end of a tick, ns after its interrupt was due.
    pub latest_end_ns: u64,
}

impl TickCost {
    /// Instructions of a tick on average.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.total as f64 / self.ticks.max(1) as f64
    }

    pub(super) fn begin(&mut self, start_ns: i64) {
        let (first, last) = self.start_ns.unwrap_or((start_ns, start_ns));
        self.start_ns = Some((first.min(start_ns), last.max(start_ns)));
    }

    pub(super) fn add(&mut self, instructions: u64, end_ns: u64) {
        self.last = instructions;
        self.total += instructions;
        if instructions > self.worst {
            self.worst = instructions;
            self.worst_tick = self.ticks;
        }
        self.latest_end_ns = self.latest_end_ns.max(end_ns);
        self.ticks += 1;
    }
}
