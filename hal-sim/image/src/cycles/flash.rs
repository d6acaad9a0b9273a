//! ST's flash accelerator (RM0090, 3.5.2): the flash is read by lines of 128 bits, each in `wait states + 1` cycles, one at a time.
//! The line that the core fetches from stands in a buffer; as it is entered, the next one is read ahead. A line that is in neither is
//! looked up in the cache of 64 lines, and goes there when it had to be read. Data have a cache of 8 lines of their own. Both replace
//! the line used longest ago.

use super::setting::Setting;
use std::collections::VecDeque;

/// Bytes of a line.
const LINE: u64 = 16;
const INSTRUCTION_LINES: usize = 64;
const DATA_LINES: usize = 8;

/// The lines that a cache holds, the one used last at the end.
#[derive(Clone, Debug, Default)]
struct Cache(VecDeque<u64>);

impl Cache {
    /// Whether a line is there, which is a use of it.
    fn has(&mut self, line: u64) -> bool {
        let Some(at) = self.0.iter().position(|it| *it == line) else {
            return false;
        };
        self.0.remove(at);
        self.0.push_back(line);
        true
    }

    fn put(&mut self, line: u64, size: usize) {
        if self.0.len() == size {
            self.0.pop_front();
        }
        self.0.push_back(line);
    }
}

/// The accelerator, and the flash behind it.
#[derive(Clone, Debug)]
pub struct Flash {
    setting: Setting,
    /// The line that the core fetches from.
    current: Option<u64>,
    /// The line that is read ahead, and the cycle from which a fetch of it does not wait.
    ahead: Option<(u64, u64)>,
    /// The first cycle in which another read can start.
    free_at: u64,
    instructions: Cache,
    data: Cache,
}

impl Flash {
    /// With its caches empty.
    #[must_use]
    pub fn new(setting: Setting) -> Self {
        Self {
            setting,
            current: None,
            ahead: None,
            free_at: 0,
            instructions: Cache::default(),
            data: Cache::default(),
        }
    }

    /// The flash rests, and time begins anew; its caches are as they were, if the setting has them so.
    pub fn rest(&mut self) {
        self.current = None;
        self.ahead = None;
        self.free_at = 0;
        if !self.setting.keeps_caches {
            self.instructions = Cache::default();
            self.data = Cache::default();
        }
    }

    /// Cycles that a fetch of an address, begun in a cycle, waits.
    pub fn fetch(&mut self, address: u64, now: u64) -> u64 {
        let line = address / LINE;
        if self.current == Some(line) {
            return 0;
        }
        let wait = match self.ahead.take_if(|(ahead, _)| *ahead == line) {
            Some((_, ready_at)) => ready_at.saturating_sub(now),
            None if self.instructions.has(line) => 0,
            None => {
                if self.setting.drops_reads {
                    self.free_at = self.free_at.min(now);
                }
                self.instructions.put(line, INSTRUCTION_LINES);
                self.read(now) - now
            }
        };
        self.current = Some(line);
        self.read_ahead(line + 1, now + wait);
        wait
    }

    fn read_ahead(&mut self, line: u64, now: u64) {
        if self.ahead.is_some_and(|(ahead, _)| ahead == line) || self.instructions.0.contains(&line)
        {
            return;
        }
        let ready_at = self.read(now);
        self.ahead = Some((line, ready_at));
    }

    /// Cycles that a load of a word, begun in a cycle, waits.
    pub fn load(&mut self, address: u64, now: u64) -> u64 {
        let line = address / LINE;
        if self.setting.data_cache && self.data.has(line) {
            return 0;
        }
        if self.setting.data_cache {
            self.data.put(line, DATA_LINES);
        }
        self.read(now) - now
    }

    /// Reads a line as soon as it can be: the cycle in which it is there.
    fn read(&mut self, now: u64) -> u64 {
        if self.setting.wait_states == 0 {
            return now;
        }
        let ready_at = now.max(self.free_at) + self.setting.wait_states;
        self.free_at = ready_at + 1;
        ready_at
    }
}

#[cfg(test)]
mod tests {
    use super::{Flash, Setting};

    const CASES: Setting = Setting::NOMINAL;

    #[test]
    fn the_first_fetch_waits_for_all_wait_states_and_the_rest_of_its_line_for_none() {
        let mut flash = Flash::new(CASES);
        assert_eq!(flash.fetch(0x100, 0), 5);
        assert_eq!(flash.fetch(0x104, 6), 0);
        assert_eq!(flash.fetch(0x10C, 8), 0);
    }

    #[test]
    fn the_next_line_is_read_ahead_from_the_cycle_in_which_a_line_is_there() {
        let mut flash = Flash::new(CASES);
        flash.fetch(0x100, 0);
        // There in cycle 5, when the flash is busy until 6: the next is there in 11.
        assert_eq!(flash.fetch(0x110, 9), 2);
        // Read from 12 on: there in 17.
        assert_eq!(flash.fetch(0x120, 20), 0);
    }

    #[test]
    fn a_jump_waits_for_the_read_under_way_unless_that_is_dropped() {
        let mut flash = Flash::new(CASES);
        flash.fetch(0x100, 0);
        // The read ahead lasts from 6 to 11.
        assert_eq!(flash.fetch(0x400, 8), 4 + 5);
        let mut flash = Flash::new(Setting {
            drops_reads: true,
            ..CASES
        });
        flash.fetch(0x100, 0);
        assert_eq!(flash.fetch(0x400, 8), 5);
    }

    #[test]
    fn a_line_that_was_jumped_to_is_kept_and_one_that_was_read_ahead_is_not() {
        let mut flash = Flash::new(CASES);
        flash.fetch(0x100, 0);
        flash.fetch(0x110, 20);
        flash.fetch(0x400, 40);
        assert_eq!(flash.fetch(0x100, 60), 0);
        flash.fetch(0x400, 80);
        assert_eq!(flash.fetch(0x110, 100), 5);
    }

    #[test]
    fn the_line_used_longest_ago_goes_first() {
        let mut flash = Flash::new(CASES);
        // Every other line, so that none is read ahead.
        let jumps = |flash: &mut Flash, lines: std::ops::Range<u64>| -> u64 {
            lines.map(|line| flash.fetch(line * 32, line * 100)).sum()
        };
        assert_eq!(jumps(&mut flash, 0..64), 64 * 5);
        assert_eq!(flash.fetch(0, 10_000), 0);
        // The 65th puts out the second, not the first, which has just been used.
        assert_eq!(flash.fetch(64 * 32, 20_000), 5);
        assert_eq!(flash.fetch(0, 30_000), 0);
        assert_eq!(flash.fetch(32, 40_000), 5);
    }

    #[test]
    fn data_have_eight_lines_of_their_own_and_none_while_the_cache_is_off() {
        let mut flash = Flash::new(CASES);
        assert_eq!(flash.load(0x1000, 0), 5);
        assert_eq!(flash.load(0x100C, 10), 0);
        let others = (1..9).map(|line| flash.load(0x1000 + 16 * line, 100 * line));
        assert_eq!(others.sum::<u64>(), 8 * 5);
        assert_eq!(flash.load(0x1000, 2_000), 5);
        let mut off = Flash::new(CASES.writing());
        assert_eq!(off.load(0x1000, 0), 5);
        assert_eq!(off.load(0x1004, 10), 5);
    }

    #[test]
    fn data_wait_for_a_line_that_is_read_ahead() {
        let mut flash = Flash::new(CASES);
        flash.fetch(0x100, 0);
        assert_eq!(flash.load(0x1000, 7), 5 + 5);
    }

    #[test]
    fn without_wait_states_nothing_waits() {
        let mut flash = Flash::new(Setting::WITHOUT_WAIT_STATES);
        let waits = (0..100).map(|k| flash.fetch(0x100 + 4 * (k * 7 % 50), 3 * k));
        assert_eq!(waits.sum::<u64>(), 0);
    }
}
