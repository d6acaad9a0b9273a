//! The instructions of ticks as they run, with what they do on the buses.

use crate::cycles::{Bus, Program, address};
use rigless::emulator::{Access, AccessKind, Host};
use std::ops::Range;
use std::sync::Arc;

/// One instruction as it ran.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Where it stands.
    pub at: u64,
    /// What it did on a bus.
    pub bus: Bus,
}

/// Both banks of the flash.
const FLASH: Range<u32> = 0x0800_0000..0x0820_0000;
/// The block of RAM in which the loop's code lies, at both its addresses.
const CODE_BLOCK: [Range<u32>; 2] = [0..0x1_C000, 0x2000_0000..0x2001_C000];
const CORE_REGISTERS: usize = 16;
const PC: usize = 15;

/// Follows ticks.
#[derive(Debug)]
pub struct Following {
    program: Arc<Program>,
    /// Where a tick begins, writes its duties and ends, which is watched whoever follows it.
    ends: [u64; 3],
    steps: Vec<Step>,
    inside: bool,
    complete: bool,
    /// Steps of the tick under way, or of the last one, until its duties were written.
    until_duties: usize,
    /// The tick under way, and those that are over and were not taken yet.
    tick: u64,
    over: Vec<FollowedTick>,
}

/// The instructions of a tick, all of them.
#[derive(Clone, Debug)]
pub struct FollowedTick {
    /// Its number.
    pub tick: u64,
    /// Its instructions.
    pub steps: Vec<Step>,
    /// So many of them until its duties are written.
    pub until_duties: usize,
}

impl Following {
    pub fn new(program: &Arc<Program>, ends: [u64; 3]) -> Self {
        Self {
            program: Arc::clone(program),
            ends,
            steps: Vec::new(),
            inside: false,
            complete: false,
            until_duties: 0,
            tick: 0,
            over: Vec::new(),
        }
    }

    /// What is to be watched, besides where a tick begins and ends.
    pub fn addresses(&self) -> impl Iterator<Item = u64> + use<'_> {
        let ends = self.ends;
        self.program
            .addresses()
            .filter(move |at| !ends.contains(at))
    }

    /// The steps of the last tick until its duties were written.
    pub fn steps(&self) -> Option<&[Step]> {
        self.steps
            .get(..self.until_duties)
            .filter(|_| self.complete)
    }

    /// The ticks that are over since this was asked last; `None` when one was not followed to its end.
    pub fn take_over(&mut self) -> Option<Vec<FollowedTick>> {
        self.complete.then(|| std::mem::take(&mut self.over))
    }

    pub fn begin(&mut self, at: u64, tick: u64, host: &mut dyn Host) {
        self.steps.clear();
        (self.tick, self.until_duties) = (tick, 0);
        self.inside = true;
        self.complete = true;
        self.step(at, host);
    }

    /// The duties are written before this instruction.
    pub fn duties(&mut self, at: u64, host: &mut dyn Host) {
        if self.inside {
            self.until_duties = self.steps.len();
        }
        self.step(at, host);
    }

    pub fn end(&mut self) {
        if std::mem::replace(&mut self.inside, false) {
            self.over.push(FollowedTick {
                tick: self.tick,
                steps: self.steps.clone(),
                until_duties: self.until_duties,
            });
        }
    }

    /// The core has come to an instruction.
    pub fn step(&mut self, at: u64, host: &mut dyn Host) {
        if !self.inside {
            return;
        }
        let place = self.program.at(at).and_then(|it| it.place);
        let mut bus = Bus::None;
        // What goes to peripherals is told by them, and other RAM is all the same.
        if let Some(place) = place {
            match registers(host, at) {
                Some(registers) => {
                    let at = address(&place, &registers);
                    if FLASH.contains(&at) {
                        bus = Bus::Flash(at);
                    } else if CODE_BLOCK.iter().any(|block| block.contains(&at)) {
                        bus = Bus::CodeBlock;
                    }
                }
                None => self.complete = false,
            }
        }
        self.steps.push(Step { at, bus });
    }

    /// A peripheral was read or written by the instruction under way.
    pub fn access(&mut self, access: &Access) {
        let Some(last) = self.steps.last_mut().filter(|_| self.inside) else {
            return;
        };
        let at = access.address as u32;
        last.bus = match access.kind {
            AccessKind::Write => Bus::Write(at),
            _ => Bus::Read(at),
        };
    }
}

/// The core's registers before the instruction at an address: they stand first in what the emulator saves, behind a length, each as
/// a number of seven bits a byte. That this is so is of its one version, and the program counter tells.
fn registers(host: &mut dyn Host, at: u64) -> Option<[u32; CORE_REGISTERS]> {
    let saved = host.save_state().ok()?;
    let mut bytes = saved.into_iter();
    let mut number = || {
        let mut value = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = bytes.next()?;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    };
    number()?;
    let mut registers = [0; CORE_REGISTERS];
    for register in &mut registers {
        *register = number()? as u32;
    }
    (u64::from(registers[PC]) == at).then_some(registers)
}
