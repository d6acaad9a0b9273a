//! Drives the emulator through a run of the image `cost`: writes the order, then looks at the table now and then.

use super::part::{Part, ROW_WORDS};
use crate::chip::board::ChipBoard;
use drawing::Progress;
use rigless::emulator::{Driver, Host, Stop};
use rigless::session::Session;
use rigless::soc::Width;
use rigless::time::VirtualNanos;

/// What is to be counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// States, each a call of every part, or ten where calls are short.
    pub states: u32,
    /// Seed of the random arguments.
    pub seed: u32,
    /// Only parts whose name has this in it; all if it is empty.
    pub only: String,
}

/// Longest [`Order::only`], bytes.
pub const LONGEST_NAME: usize = 64;
const WRITTEN: u32 = 0x434F_5354;

/// Between two looks, virtual time.
const LOOK_NS: u64 = 100_000_000;
/// Looks at a table that stands still before the run is given up: 240 million instructions.
const PATIENCE: u32 = 300;

/// How the run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// The table says so.
    Done,
    /// A part panicked or faulted.
    Failed,
    /// A call did not come back.
    #[default]
    Stuck,
    /// Image and program do not mean the same table.
    Strange,
}

/// The driver.
pub struct CostDriver {
    pub order: Order,
    pub order_at: u64,
    pub table_at: u64,
    pub progress: Progress,
    pub ordered: bool,
    pub parts: Vec<Part>,
    pub end: End,
    pub calls: u32,
    pub still: u32,
}

const HEAD_WORDS: u64 = 3;

impl CostDriver {
    fn write_order(&self, host: &mut dyn Host) {
        let name = self.order.only.as_bytes();
        let words = [
            WRITTEN,
            self.order.states,
            self.order.seed,
            name.len() as u32,
        ];
        for (word, at) in words.into_iter().zip((self.order_at..).step_by(4)) {
            // The symbol lies in RAM, which can be written; if not, the default order counts and the row calls tell.
            let _ = host.write(at, Width::W32, u64::from(word));
        }
        for (byte, at) in name.iter().zip(self.order_at + 16..) {
            let _ = host.write(at, Width::W8, u64::from(*byte));
        }
    }

    fn word(&self, host: &mut dyn Host, index: u64) -> u32 {
        host.read(self.table_at + 4 * index, Width::W32)
            .map_or(0, |word| word as u32)
    }

    fn part(&self, host: &mut dyn Host, index: u64) -> Part {
        let mut row = [0; ROW_WORDS];
        for (word, k) in row.iter_mut().zip(0..) {
            *word = self.word(host, HEAD_WORDS + index * ROW_WORDS as u64 + k);
        }
        let name = (u64::from(row[0])..)
            .take(row[1] as usize)
            .map(|at| host.read(at, Width::W8).map_or(b'?', |byte| byte as u8))
            .collect();
        let name = String::from_utf8(name).unwrap_or_default();
        Part::from_row(name, &row)
    }

    /// Reads the table; `Some` at the end.
    fn look(&mut self, host: &mut dyn Host) -> Option<End> {
        let [state, row_words, rows] = [0, 1, 2].map(|index| self.word(host, index));
        // Before the start-up code has filled the memory everything is zero.
        if row_words == 0 {
            return self.wait(0);
        }
        if row_words as usize != ROW_WORDS {
            return Some(End::Strange);
        }
        let last = u64::from(rows).checked_sub(1);
        match state {
            0 => {
                let calls = last.map_or(0, |last| self.part(host, last).calls);
                self.wait(calls.wrapping_add(rows << 24))
            }
            state => {
                self.parts = (0..u64::from(rows))
                    .map(|index| self.part(host, index))
                    .collect();
                Some(if state == 1 { End::Done } else { End::Failed })
            }
        }
    }

    fn wait(&mut self, calls: u32) -> Option<End> {
        self.still = if calls == self.calls {
            self.still + 1
        } else {
            0
        };
        self.calls = calls;
        (self.still > PATIENCE).then_some(End::Stuck)
    }
}

impl Driver<ChipBoard> for CostDriver {
    fn on_stop(
        &mut self,
        _session: &mut Session<ChipBoard>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        if !self.ordered {
            self.ordered = true;
            self.write_order(host);
        } else if let Some(end) = self.look(host) {
            self.end = end;
            return None;
        }
        self.progress.update(0, stop.at.0 as f64 * 1e-9);
        Some(VirtualNanos(stop.at.0 + LOOK_NS))
    }
}
