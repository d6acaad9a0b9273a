//! What was counted, for a bench or a debugger that reads [`COST`] by symbol.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

const ROWS: usize = 64;

/// One part's counts.
#[repr(C)]
pub struct Row {
    name_at: AtomicU32,
    name_bytes: AtomicU32,
    calls: AtomicU32,
    /// Calls that returned a refusal; they are counted with the others.
    refused: AtomicU32,
    total_low: AtomicU32,
    total_high: AtomicU32,
    worst: AtomicU32,
    worst_call: AtomicU32,
    /// How much came of the worst call: ticks of the plan.
    worst_ticks: AtomicU32,
    /// Most that came of a call.
    most_ticks: AtomicU32,
}

/// The rows, and how far they are.
#[repr(C)]
pub struct Table {
    /// 0: under way; 1: done; 2: a part has failed, the last of the rows.
    state: AtomicU32,
    /// Words of a row, for readers to see that they mean the same.
    row_words: u32,
    rows: AtomicU32,
    row: [Row; ROWS],
}

/// The table.
#[unsafe(no_mangle)]
pub static COST: Table = Table {
    state: AtomicU32::new(0),
    row_words: (size_of::<Row>() / size_of::<u32>()) as u32,
    rows: AtomicU32::new(0),
    row: [const { Row::new() }; ROWS],
};

const DONE: u32 = 1;
const FAILED: u32 = 2;

/// What one call left behind.
#[derive(Clone, Copy, Default)]
pub struct CallResult {
    /// Whether the answer was a refusal.
    pub refused: bool,
    /// Ticks of the plan, where it is one.
    pub ticks: u64,
}

impl Row {
    const fn new() -> Self {
        Self {
            name_at: AtomicU32::new(0),
            name_bytes: AtomicU32::new(0),
            calls: AtomicU32::new(0),
            refused: AtomicU32::new(0),
            total_low: AtomicU32::new(0),
            total_high: AtomicU32::new(0),
            worst: AtomicU32::new(0),
            worst_call: AtomicU32::new(0),
            worst_ticks: AtomicU32::new(0),
            most_ticks: AtomicU32::new(0),
        }
    }

    /// Adds one call.
    pub fn add(&self, counts: u32, came: CallResult) {
        let call = self.calls.load(Relaxed);
        let ticks = u32::try_from(came.ticks).unwrap_or(u32::MAX);
        if counts > self.worst.load(Relaxed) {
            self.worst.store(counts, Relaxed);
            self.worst_call.store(call, Relaxed);
            self.worst_ticks.store(ticks, Relaxed);
        }
        if ticks > self.most_ticks.load(Relaxed) {
            self.most_ticks.store(ticks, Relaxed);
        }
        let (low, carried) = self.total_low.load(Relaxed).overflowing_add(counts);
        self.total_low.store(low, Relaxed);
        let high = self.total_high.load(Relaxed);
        self.total_high.store(high + u32::from(carried), Relaxed);
        let refused = self.refused.load(Relaxed);
        self.refused
            .store(refused + u32::from(came.refused), Relaxed);
        self.calls.store(call + 1, Relaxed);
    }
}

impl Table {
    /// The next row, under its name. Panics when there is none left, which ends the run.
    pub fn row(&self, name: &'static str) -> &Row {
        let index = self.rows.load(Relaxed);
        let row = &self.row[index as usize];
        row.name_at.store(name.as_ptr() as u32, Relaxed);
        row.name_bytes.store(name.len() as u32, Relaxed);
        self.rows.store(index + 1, Relaxed);
        row
    }

    /// All parts are counted.
    pub fn end(&self) {
        self.state.store(DONE, Relaxed);
    }

    /// The last row's part has failed.
    pub fn fail(&self) {
        self.state.store(FAILED, Relaxed);
    }
}
