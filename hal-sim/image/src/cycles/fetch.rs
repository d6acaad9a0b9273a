//! The core's fetch: words of the code, one a cycle where the memory does not hold it up, a few ahead of what runs.
//!
//! Code in RAM does without the flash's waits. Where it is fetched over the instruction bus, from under the addresses of the flash,
//! each word is there in the cycle in which it is asked for (RM0090, 2.3.1: no wait states; Cortex-M3 Technical Reference Manual, 14.3,
//! which says of this bus what the later manual leaves out). Over the system bus, from RAM's own address, it takes a cycle more (14.5).

use super::flash::Flash;
use super::setting::Setting;
use std::collections::VecDeque;
use std::ops::Range;

/// RAM under the instruction bus's addresses, and at its own.
const CODE_RAM: Range<u64> = 0..0x0800_0000;
const RAM: Range<u64> = 0x2000_0000..0x4000_0000;
/// Bytes of a word.
const WORD: u64 = 4;
/// Words that it fetches ahead (Cortex-M3 Technical Reference Manual, 14.3; the later manual does not say). With fewer, code of wide
/// instructions would not run at one a cycle from a memory without wait states, which ARM's table has it do.
const AHEAD: usize = 3;
/// From the cycle in which a word is there to the one in which its instruction begins: it is decoded meanwhile.
const DECODE: u64 = 2;

/// A word that was fetched, and the first cycle in which its instruction can begin.
#[derive(Clone, Copy, Debug)]
struct Fetched {
    word: u64,
    begins_at: u64,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Fetch {
    refill: u64,
    queue: VecDeque<Fetched>,
    next: u64,
    /// The first cycle in which the next fetch can begin.
    free_at: u64,
}

impl Fetch {
    /// Begins at an address, in a cycle.
    #[must_use]
    pub fn new(setting: &Setting, address: u64, now: u64) -> Self {
        Self {
            refill: setting.refill,
            queue: VecDeque::new(),
            next: address / WORD,
            free_at: now,
        }
    }

    /// The cycle in which an instruction can begin that follows what began last, when the core is ready for it in `now`.
    pub fn begin(&mut self, flash: &mut Flash, address: u64, length: u64, now: u64) -> u64 {
        let (first, last) = (address / WORD, (address + length - 1) / WORD);
        self.pass(first, now);
        while self.next <= last || (self.queue.len() < AHEAD && self.free_at < now) {
            self.fetch(flash);
        }
        let needed = self.queue.iter().rfind(|it| it.word <= last);
        needed.map_or(now, |it| it.begins_at.max(now))
    }

    /// A jump to an address is taken by an instruction that ends in the cycle before `now`.
    pub fn jump(&mut self, flash: &mut Flash, address: u64, now: u64) {
        // What was begun ahead of it keeps the flash busy.
        while self.queue.len() < AHEAD && self.free_at + 1 < now {
            self.fetch(flash);
        }
        self.queue.clear();
        self.next = address / WORD;
        self.free_at = (now + self.refill).saturating_sub(DECODE);
    }

    /// Words before this one are done with.
    fn pass(&mut self, first: u64, now: u64) {
        let full = self.queue.len() >= AHEAD;
        let before = self.queue.len();
        self.queue.retain(|it| it.word >= first);
        if full && self.queue.len() < before {
            self.free_at = self.free_at.max(now.saturating_sub(1));
        }
    }

    fn fetch(&mut self, flash: &mut Flash) {
        let address = self.next * WORD;
        let wait = if CODE_RAM.contains(&address) {
            0
        } else if RAM.contains(&address) {
            1
        } else {
            flash.fetch(address, self.free_at)
        };
        let there_at = self.free_at + wait;
        self.queue.push_back(Fetched {
            word: self.next,
            begins_at: there_at + DECODE,
        });
        self.next += 1;
        self.free_at = there_at + 1;
    }
}
