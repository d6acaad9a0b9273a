//! The Cortex-M4F as its manual has it (Technical Reference Manual, 3.3 and 7.2): one instruction after the other.
//!
//! - A load takes two cycles; a load or store right behind it, whose address does not hang on what is loaded, one less.
//! - A store at a register and a number takes one cycle: it is done while the next instruction runs. So is one over a slow bus, and
//!   the next load or store waits until it is through.
//! - A result of floating-point arithmetic is there a cycle late for the instruction right behind; the addend of a multiplication
//!   with addition is taken a cycle late too.
//! - A division or root of the floating-point unit takes 14 cycles; the unit's next arithmetic waits for it, and what touches its
//!   result. Loads, stores and moves of other registers do not: the manual is silent on that, LLVM's model of the core has it so.
//! - A jump that is taken costs the refill of the pipeline: what the fetch takes to have the instruction there.
//!
//! Not in it: that an `IT` may cost nothing, accesses of the DMA to the same RAM.

use super::fetch::Fetch;
use super::flash::Flash;
use super::instruction::{Instruction, Kind};
use super::registers::Registers;
use super::setting::Setting;

/// What an instruction does on a bus, of what costs more than RAM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bus {
    /// Nothing.
    #[default]
    None,
    /// Loads from the flash, at an address.
    Flash(u32),
    /// Loads from the block of RAM in which the code lies, or stores there.
    CodeBlock,
    /// Loads from a peripheral.
    Read(u32),
    /// Stores to a peripheral.
    Write(u32),
}

/// An instruction as it ran.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ran<'a> {
    /// Where it stands.
    pub at: u64,
    /// The instruction.
    pub instruction: &'a Instruction,
    /// What it did on a bus.
    pub bus: Bus,
}

/// Cycles of something, by what they were spent on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    /// ARM's table.
    pub table: u64,
    /// Waiting for a result of the floating-point unit.
    pub float: u64,
    /// Refilling the pipeline after jumps, with a flash that is as fast as RAM.
    pub refill: u64,
    /// Waiting for instructions from the flash.
    pub fetch: u64,
    /// Waiting for data from the flash, or from the block of RAM in which the code lies.
    pub data: u64,
    /// Waiting for peripherals.
    pub peripherals: u64,
    /// From the interrupt to the first instruction, and putting the floating-point registers on the stack.
    pub entry: u64,
}

impl Cycles {
    /// All of them.
    #[must_use]
    pub const fn all(&self) -> u64 {
        self.table
            + self.float
            + self.refill
            + self.fetch
            + self.data
            + self.peripherals
            + self.entry
    }

    /// What is no more than waiting.
    #[must_use]
    pub const fn stalls(&self) -> u64 {
        self.all() - self.table
    }

    /// Adds others.
    pub const fn add(&mut self, other: &Self) {
        self.table += other.table;
        self.float += other.float;
        self.refill += other.refill;
        self.fetch += other.fetch;
        self.data += other.data;
        self.peripherals += other.peripherals;
        self.entry += other.entry;
    }
}

/// From the interrupt to the first instruction of its handler, with a memory without wait states (Technical Reference Manual, 3.9).
const ENTRY: u64 = 12;
/// A division or root of the floating-point unit (7.2).
const FLOAT_DIVIDE: u64 = 14;
const WORD: u64 = 4;

const APB1: std::ops::Range<u32> = 0x4000_0000..0x4001_0000;
const APB2: std::ops::Range<u32> = 0x4001_0000..0x4002_0000;

/// The core.
#[derive(Clone, Debug)]
pub struct Core {
    setting: Setting,
    flash: Flash,
}

/// What is left of the instructions before.
#[derive(Clone, Copy, Debug, Default)]
struct Before {
    /// What the load right before has loaded.
    loaded: Option<Registers>,
    /// What the arithmetic right before has written.
    late: Registers,
    /// The cycle in which the floating-point unit has divided, and what it has written then.
    divided_at: u64,
    divided: Registers,
    /// The cycle in which a store over a slow bus is through.
    stored_at: u64,
    /// Whether the floating-point registers of what was interrupted are kept.
    stacked: bool,
}

impl Core {
    /// With empty caches.
    #[must_use]
    pub fn new(setting: Setting) -> Self {
        Self {
            setting,
            flash: Flash::new(setting),
        }
    }

    /// Cycles from an interrupt to its handler.
    #[must_use]
    pub const fn entry(&self) -> u64 {
        ENTRY + self.setting.vector
    }

    /// The cycles of a handler, from its interrupt to the end of the last of these instructions. `each` is told those of each.
    pub fn run<'a, I, F>(&mut self, handler: I, mut each: F) -> Cycles
    where
        I: IntoIterator<Item = Ran<'a>>,
        F: FnMut(u64, &Cycles),
    {
        self.flash.rest();
        let mut handler = handler.into_iter().peekable();
        let first = handler.peek().map_or(0, |ran| ran.at);
        // Entry ends with the first instruction in the pipeline: its fetch begins two cycles before.
        let entry = self.entry();
        let mut fetch = Fetch::new(&self.setting, first, entry - 2);
        let mut before = Before::default();
        let mut now = entry;
        let mut sum = Cycles {
            entry,
            ..Cycles::default()
        };
        // What a jump costs besides waiting for the flash, once its target begins.
        let mut refill = 0;
        while let Some(ran) = handler.next() {
            let begins_at = fetch.begin(
                &mut self.flash,
                ran.at,
                u64::from(ran.instruction.length),
                now,
            );
            let late = begins_at - now;
            let mut cycles = Cycles {
                refill: late.min(refill),
                fetch: late.saturating_sub(refill),
                ..Cycles::default()
            };
            now = begins_at + self.execute(&ran, &mut before, begins_at, &mut cycles);
            refill = 0;
            let follows = ran.at + u64::from(ran.instruction.length);
            if let Some(next) = handler.peek().filter(|next| next.at != follows) {
                fetch.jump(&mut self.flash, next.at, now);
                let two_words =
                    next.at / WORD != (next.at + u64::from(next.instruction.length) - 1) / WORD;
                refill = self.setting.refill + u64::from(two_words);
            }
            each(ran.at, &cycles);
            sum.add(&cycles);
        }
        sum.float += before.divided_at.saturating_sub(now);
        sum
    }

    /// The cycles of an instruction from where it begins, noted by what they are for.
    fn execute(
        &mut self,
        ran: &Ran<'_>,
        before: &mut Before,
        begins_at: u64,
        cycles: &mut Cycles,
    ) -> u64 {
        let instruction = ran.instruction;
        if instruction.float && !std::mem::replace(&mut before.stacked, true) {
            cycles.entry += self.setting.lazy_stacking;
        }
        if instruction.float {
            let divided = before.divided;
            let computes = matches!(instruction.kind, Kind::Float(_) | Kind::FloatDivide);
            if computes || instruction.reads.meets(divided) || instruction.writes.meets(divided) {
                cycles.float += before.divided_at.saturating_sub(begins_at + cycles.entry);
            }
            cycles.float += u64::from(instruction.reads.meets(before.late));
        }
        let overlaps = before
            .loaded
            .is_some_and(|loaded| !loaded.meets(instruction.address));
        cycles.table += self.table(instruction, overlaps);
        let so_far = cycles.entry + cycles.float;
        match ran.bus {
            Bus::None => {}
            Bus::Flash(address) => {
                cycles.data += self.load(instruction, address, begins_at + so_far);
            }
            Bus::CodeBlock => cycles.data += self.setting.shared_block * words(instruction),
            Bus::Read(address) => {
                let through = before.stored_at.saturating_sub(begins_at + so_far);
                cycles.peripherals += through + self.peripheral(address);
            }
            Bus::Write(address) => {
                let through = before.stored_at.saturating_sub(begins_at + so_far);
                cycles.peripherals += through;
                before.stored_at = begins_at + so_far + through + 1 + self.peripheral(address);
            }
        }
        if instruction.kind == Kind::FloatDivide {
            before.divided_at = begins_at + so_far + FLOAT_DIVIDE;
            before.divided = instruction.writes;
        }
        before.loaded = instruction.is_load().then_some(instruction.writes);
        before.late = match instruction.kind {
            Kind::Float(_) | Kind::FloatDivide => instruction.writes,
            _ => Registers::default(),
        };
        so_far + cycles.table + cycles.data + cycles.peripherals
    }

    /// ARM's table.
    fn table(&self, instruction: &Instruction, overlaps: bool) -> u64 {
        let less = u64::from(overlaps);
        match instruction.kind {
            Kind::Plain(cycles) | Kind::Float(cycles) => u64::from(cycles),
            Kind::Divide => u64::from(self.setting.divide),
            Kind::FloatDivide if self.setting.divides_beside => 1,
            Kind::FloatDivide => FLOAT_DIVIDE,
            Kind::Load | Kind::StoreIndexed => 2 - less,
            Kind::Store | Kind::Jump | Kind::JumpRegister => 1,
            Kind::Many(words) | Kind::JumpLoaded(words) => 1 + u64::from(words),
        }
    }

    /// What the words of a load from the flash wait.
    fn load(&mut self, instruction: &Instruction, address: u32, now: u64) -> u64 {
        (0..words(instruction)).fold(0, |waited, word| {
            waited
                + self
                    .flash
                    .load(u64::from(address) + WORD * word, now + word + waited)
        })
    }

    fn peripheral(&self, address: u32) -> u64 {
        match address {
            _ if APB1.contains(&address) => self.setting.apb1,
            _ if APB2.contains(&address) => self.setting.apb2,
            _ => 0,
        }
    }
}

/// Words that an instruction loads or stores.
fn words(instruction: &Instruction) -> u64 {
    match instruction.kind {
        Kind::Many(words) | Kind::JumpLoaded(words) => u64::from(words),
        _ => 1,
    }
}
