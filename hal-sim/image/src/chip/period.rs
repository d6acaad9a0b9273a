//! What a caller sees and can do once a control period.

use super::board::ChipBoard;
use super::cost::TickCost;
use super::follow::{FollowedTick, Following, Step};
use super::timeline::{EARLY_NS, FIRST_TICK_NS, LATCH_NS, PERIOD_NS};
use crate::cycles::Program;
use hal_sim::machine::devices::{BridgeState, Stage};
use rigless::device::{Level, ResetCause};
use rigless::emulator::{Host, InterruptLine, Watch};
use rigless::soc::Width;
use rigless::time::VirtualNanos;
use std::sync::Arc;

/// A restart of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reset {
    /// When, ns since power on.
    pub at_ns: u64,
    /// By what.
    pub cause: ResetCause,
}

/// Something to do to the board at an instant within a period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Press (`true`) or release the emergency stop.
    EmergencyStop(bool),
    /// Stop the timer that starts every control period: the loop halts.
    HaltLoop,
    /// Move the latches to come by so many counts of TIM3 (84 MHz): later, or, less than 0, earlier again.
    DelayLatch(i32),
    /// Keep what the bridges' pins say, for [`Period::probes`].
    Probe,
}

/// The image's exported record (`TRACE`), as the last tick left it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// Ticks since the chip started.
    pub ticks: u32,
    /// Running hash over all ticks: `RunningHash` of the firmware's recorder.
    pub hash: u32,
    /// Commands the tick has taken.
    pub commands: u32,
    /// Why the chip started, as the image understood it.
    pub reset_cause: u32,
    /// How often the command interface has run.
    pub served: u32,
}

/// A run of the chip's command interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Service {
    /// Bytes it has taken since the chip started, the last of them right before this run.
    pub bytes: u32,
    /// The tick of the snapshot it had at hand; 0 before the first.
    pub snapshot: u32,
}

/// How many of them the image remembers.
const SERVICES: u32 = 16;
/// Where they stand in the record, in words.
const SERVICES_AT: u64 = 5;

/// One control period: the frames and the ADC inputs of tick [`Period::tick`] have just been handed over, 16 us before it.
pub struct Period<'a> {
    pub(super) board: &'a mut ChipBoard,
    pub(super) host: &'a mut dyn Host,
    pub(super) at: VirtualNanos,
    pub(super) trace_at: u64,
    pub(super) actions: &'a mut Vec<(u64, Action)>,
    /// The tick to come, counted from the last start of the chip; so many are done.
    pub tick: u64,
    /// The stage at this tick. Its encoders' frames have been handed over already: a fault set now shows next period.
    pub stage: &'a mut Stage,
    /// What the pins said from where the last tick's duty acts.
    pub pins: [BridgeState; 3],
    /// Whether bridges have switched themselves off. May be changed.
    pub bridge_faults: &'a mut [bool; 3],
    /// What ticks cost so far.
    pub cost: TickCost,
    /// Restarts so far.
    pub resets: &'a [Reset],
    /// What [`Action::Probe`] found, with the instants (ns since power on) of probing.
    pub probes: &'a [(u64, [BridgeState; 3])],
    pub(super) following: &'a mut Option<Following>,
    /// Where a tick begins, writes its duties and ends.
    pub(super) ends: [u64; 3],
}

impl Period<'_> {
    /// Time since power on, ns.
    #[must_use]
    pub fn at_ns(&self) -> u64 {
        self.at.0
    }

    /// When the tick to come is due, ns since power on.
    #[must_use]
    pub fn tick_at_ns(&self) -> u64 {
        self.at.0 + LATCH_NS + EARLY_NS
    }

    /// Sends bytes to the command interface.
    pub fn send(&mut self, bytes: &[u8]) {
        if let Some(line) = self.board.line() {
            line.send(bytes);
        }
    }

    /// How many bytes have not gone out to it yet.
    pub fn unsent(&mut self) -> usize {
        self.board.line().map_or(0, |line| line.waiting())
    }

    /// The bytes that have gone out to it since the last call, each with the instant at which it began, ns since power on.
    pub fn sent(&mut self) -> Vec<(u64, u8)> {
        (self.board.line()).map_or_else(Vec::new, |line| line.take_sent())
    }

    /// When the timers were started, ns since power on.
    #[must_use]
    pub fn started_at_ns(&self) -> u64 {
        self.tick_at_ns() - FIRST_TICK_NS - self.tick * PERIOD_NS
    }

    /// Counts of the PWM pulses of the period under way, or `None` while the outputs are cut.
    pub fn duty(&mut self) -> Option<[u16; 3]> {
        self.board.duty(self.at)
    }

    /// What the command interface has answered since the last call.
    pub fn received(&mut self) -> Vec<u8> {
        self.board
            .line()
            .map(|line| line.take_received())
            .unwrap_or_default()
    }

    /// Does something to the board at an instant to come, ns since power on.
    pub fn at(&mut self, at_ns: u64, action: Action) {
        self.actions.push((at_ns, action));
        self.actions.sort_by_key(|(at_ns, _)| *at_ns);
    }

    /// The word at an address of the chip's memory, or `None` where there is none.
    pub fn word(&mut self, address: u64) -> Option<u32> {
        self.host
            .read(address, Width::W32)
            .ok()
            .map(|word| word as u32)
    }

    /// Changes the word at an address of the chip's RAM; whether there is one.
    pub fn set_word(&mut self, address: u64, word: u32) -> bool {
        (self.host.write(address, Width::W32, word.into())).is_ok()
    }

    /// Has the instructions of ticks noted from the next one on, or no more. Returns whether they can be.
    pub fn follow(&mut self, program: Option<&Arc<Program>>) -> bool {
        let before = std::mem::replace(
            self.following,
            program.map(|program| Following::new(program, self.ends)),
        );
        if let Some(before) = before {
            for at in before.addresses() {
                self.host.unwatch(Watch::Instruction(at));
            }
        }
        let following = self.following.as_ref();
        following.is_none_or(|it| {
            it.addresses()
                .all(|at| self.host.watch(Watch::Instruction(at)))
        })
    }

    /// The instructions of the last tick, from the first of its handler to the symbol `stage_tick_end`; `None` when it was not
    /// followed to its end.
    #[must_use]
    pub fn steps(&self) -> Option<&[Step]> {
        self.following.as_ref().and_then(Following::steps)
    }

    /// The ticks that are over since this was asked last: the last one may still be under way. `None` when one was not followed to
    /// its end.
    pub fn followed(&mut self) -> Option<Vec<FollowedTick>> {
        self.following.as_mut().and_then(Following::take_over)
    }

    /// The register of a peripheral at an address, as the program last left it, or `None` where there is none. The registers of
    /// the processor itself are not among them.
    pub fn register(&mut self, address: u64) -> Option<u32> {
        self.board.register(self.at, address)
    }

    /// Raises an interrupt of the chip by its number, as its peripheral would.
    pub fn interrupt(&mut self, number: u16) {
        if let Some(line) = InterruptLine::new(number) {
            self.host.set_interrupt(line, Level::High);
        }
    }

    /// When the first byte of each encoder's last frame crossed its line, and the last, ns since power on.
    pub fn frames_ns(&mut self) -> [[u64; 2]; 3] {
        self.board.frames_ns()
    }

    /// Sets the supply of the chip itself, mV.
    pub fn set_chip_supply(&mut self, millivolts: u32) {
        self.board.set_chip_supply(millivolts);
    }

    /// The image's record.
    pub fn trace(&mut self) -> Trace {
        let mut word = |index: u64| self.word(self.trace_at + 4 * index).unwrap_or(0);
        Trace {
            ticks: word(0),
            hash: word(1),
            commands: word(2),
            reset_cause: word(3),
            served: word(4),
        }
    }

    /// The runs of the command interface from number `from` up to, not including, `to`; `None` when the image has forgotten some.
    pub fn services(&mut self, from: u32, to: u32) -> Option<Vec<Service>> {
        let count = to.wrapping_sub(from);
        if count > SERVICES {
            return None;
        }
        let mut word = |index: u64| self.word(self.trace_at + 4 * index).unwrap_or(0);
        let services = (0..count).map(|offset| {
            let place = u64::from(from.wrapping_add(offset) % SERVICES);
            Service {
                bytes: word(SERVICES_AT + 2 * place),
                snapshot: word(SERVICES_AT + 2 * place + 1),
            }
        });
        Some(services.collect())
    }
}
