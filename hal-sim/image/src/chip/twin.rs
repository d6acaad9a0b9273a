//! The same controller on the host, fed with what the chip was fed: its hash says whether the two agree to the bit, and if
//! they do, its sample is the chip's.
//!
//! What the tick gets is easy to repeat: the frames and the ADC's counts of its period, and the commands. What commands
//! the command side sends depends on when it runs: a way out of a motion is planned from the snapshot at hand, and the
//! chip plans for many ticks what a host plans in none. So the image keeps a record of its command side's runs, each with
//! the bytes it had received and the tick of its snapshot, and the twin's command side runs as often, with the same:
//!
//! ```text
//!  chip  tick 7   tick 8   tick 9  ...  tick 24   tick 25 takes the plan
//!          \-> interpreter: line, snapshot 7, plans -/  \-- its record: bytes, 7
//!  twin  tick 7 .. tick 24, then waits for that record: interpreter with the same bytes, snapshot 7 -> plan -> tick 25
//! ```
//!
//! So the twin is a tick behind the chip, and as many more as the chip's command side takes from a command to the end of
//! its run.

use super::period::{Period, Service, Trace};
use firmware::control::Inputs;
use firmware::drivers::biss::{RawFrame, decode};
use firmware::drivers::power_stage::signed_current_counts;
use firmware::gcs::Session;
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Snapshot, TickQueues};
use hal_sim::front::ControlLoop;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::devices::biss::{Preamble, encode};
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::{ControllerMemory, Rig};
use std::collections::VecDeque;
use std::fmt;

/// What the twin knows of the tick that the chip is about to execute.
struct Latched {
    inputs: Inputs,
    pose: [f64; 3],
}

/// A tick that the chip has executed, and the twin has not.
struct Executed {
    latched: Latched,
    trace: Trace,
    instructions: u64,
}

/// A tick in which chip and twin agreed.
#[derive(Debug)]
pub struct Agreed<'a> {
    /// What the tick offered its recorder, and the hash.
    pub record: &'a TickRecord,
    /// The stage's pose (m, m, rad) at the encoders' latch.
    pub pose: [f64; 3],
    /// What the tick cost on the chip.
    pub instructions: u64,
    /// Whether it took a command.
    pub commanded: bool,
}

/// The twin.
pub struct Twin {
    /// Tick and command side, of queues of their own: what goes from one to the other is passed on when the chip has done
    /// so.
    rig: Rig<'static, ControlLoop>,
    record: TickRecord,
    session: Session,
    /// The other ends of the command side's queues, and of the tick's.
    panel_side: TickQueues<'static>,
    tick_side: CommandQueues<'static>,
    /// Ticks and commands done, and bytes given to the command side.
    ticks: u32,
    commands: u32,
    bytes: u32,
    input: VecDeque<u8>,
    latched: Option<Latched>,
    executed: VecDeque<Executed>,
    /// The command side's runs to come, and how many the chip has told of.
    services: VecDeque<Service>,
    served: u32,
    /// What the command side can still be asked to look at, and the tick of what it looked at last.
    snapshots: VecDeque<Snapshot>,
    seen: u32,
    flip_at: Option<u64>,
}

/// The first tick at which chip and twin differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divergence {
    /// Their hashes differ.
    Hash {
        /// The tick, counted from 0.
        tick: u32,
        /// The chip's hash.
        chip: u32,
        /// The twin's.
        host: u32,
    },
    /// The chip has not done as many ticks as periods have passed.
    Ticks {
        /// Ticks the chip has done.
        chip: u32,
        /// Periods passed.
        host: u64,
    },
    /// The chip's tick has taken a command that the twin's command side did not send.
    Command {
        /// The tick, counted from 0.
        tick: u32,
    },
    /// The chip's command side has run in a way that the twin's can not repeat.
    Interpreter {
        /// Ticks done.
        ticks: u32,
    },
}

/// Ticks that the chip's command side may take from a command to the end of its run: a second, and plans take
/// milliseconds.
const PATIENCE: usize = 20_000;

impl Twin {
    /// A twin of a chip that has just started.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        Self::with_settings(parameters, SettingsFlash::in_memory())
    }

    /// The same of a board whose flash keeps these settings; where it keeps none, those of a machine of these parameters.
    #[must_use]
    pub fn with_settings(parameters: &Parameters, flash: SettingsFlash) -> Self {
        let (mut panel_side, command_queues) = ControllerMemory::endless().split();
        let (mut tick_queues, tick_side) = ControllerMemory::endless().split();
        // The twin's command side orders its records from the twin's tick; nothing of them has to be held back.
        std::mem::swap(&mut panel_side.observers, &mut tick_queues.observers);
        let links = (tick_queues, command_queues);
        Self {
            rig: Rig::new(links, parameters, flash, ControlLoop::new),
            record: TickRecord::default(),
            session: Session::new(),
            panel_side,
            tick_side,
            ticks: 0,
            commands: 0,
            bytes: 0,
            input: VecDeque::new(),
            latched: None,
            executed: VecDeque::new(),
            services: VecDeque::new(),
            served: 0,
            snapshots: VecDeque::new(),
            seen: 0,
            flip_at: None,
        }
    }

    /// Flips the lowest bit of the first encoder's count before tick `tick` (counted from 0), on the host alone: a comparison
    /// that is one has to find it.
    #[must_use]
    pub fn with_flip(mut self, tick: Option<u64>) -> Self {
        self.flip_at = tick;
        self
    }

    /// Bytes that were sent to the chip.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.input.extend(bytes);
    }

    /// Takes note of a period. To be called first thing in every one, and only while bridges and emergency stop leave the
    /// chip in peace; then [`Self::catch_up`] until there is no more.
    ///
    /// # Errors
    /// The chip has lost ticks, or its command side's record is not whole.
    pub fn look(&mut self, period: &mut Period<'_>) -> Result<(), Divergence> {
        let trace = period.trace();
        if u64::from(trace.ticks) != period.tick {
            return Err(Divergence::Ticks {
                chip: trace.ticks,
                host: period.tick,
            });
        }
        let services = period.services(self.served, trace.served);
        self.services
            .extend(services.ok_or(Divergence::Interpreter { ticks: trace.ticks })?);
        self.served = trace.served;
        let (currents, supply_counts) = period.stage.analog();
        let mut frames = period.stage.frames();
        if self.flip_at == Some(period.tick) {
            frames[0] = with_flipped_bit(frames[0]);
        }
        let next = Latched {
            inputs: Inputs {
                frames: frames.map(RawFrame),
                bridge_fault: period.stage.pulled_fault_pins(),
                emergency_stop: false,
                current_counts: currents.map(signed_current_counts),
                supply_counts,
                tick_cycles: 0,
                program_damaged: false,
                late: false,
            },
            pose: period.stage.latched_pose(),
        };
        if let Some(latched) = self.latched.replace(next) {
            self.executed.push_back(Executed {
                latched,
                trace,
                instructions: period.cost.last,
            });
        }
        Ok(())
    }

    /// The next tick that the chip has executed and the twin can repeat.
    ///
    /// # Errors
    /// Where the two went apart.
    pub fn catch_up(&mut self) -> Result<Option<Agreed<'_>>, Divergence> {
        self.serve_panel()?;
        // A tick takes its command last: the next one's record tells of it.
        let Some(Executed { trace, .. }) = self.executed.get(1) else {
            return Ok(None);
        };
        let commanded = trace.commands != self.commands;
        if commanded && !self.relay() {
            let tick = self.ticks;
            // The run of the chip's command side that sent the command is not over.
            let over = self.executed.len() > PATIENCE;
            return if over {
                Err(Divergence::Command { tick })
            } else {
                Ok(None)
            };
        }
        let Some(Executed {
            latched: Latched { inputs, pose },
            trace,
            instructions,
        }) = self.executed.pop_front()
        else {
            return Ok(None);
        };
        self.rig.front.inputs = inputs;
        self.rig.tick(&mut self.record);
        let tick = self.ticks;
        self.ticks = tick.wrapping_add(1);
        self.snapshots.extend(self.tick_side.snapshot());
        if self.record.hash.0 != trace.hash {
            return Err(Divergence::Hash {
                tick,
                chip: trace.hash,
                host: self.record.hash.0,
            });
        }
        Ok(Some(Agreed {
            record: &self.record,
            pose,
            instructions,
            commanded,
        }))
    }

    /// Runs the command side as often as the chip's has run, as far as the twin's ticks have come; its answers are the
    /// chip's to give.
    fn serve_panel(&mut self) -> Result<(), Divergence> {
        while let Some(&service) = self.services.front()
            && service.snapshot <= self.ticks
        {
            self.services.pop_front();
            self.serve(service)
                .ok_or(Divergence::Interpreter { ticks: self.ticks })?;
        }
        Ok(())
    }

    /// One run; `None` when it can not be had.
    fn serve(&mut self, service: Service) -> Option<()> {
        let count = service.bytes.wrapping_sub(self.bytes) as usize;
        if count > self.input.len() {
            return None;
        }
        let bytes: Vec<u8> = self.input.drain(..count).collect();
        if self.session.receive(&bytes) < count {
            return None;
        }
        self.bytes = service.bytes;
        if service.snapshot != self.seen {
            self.seen = service.snapshot;
            while self.snapshots.front()?.tick < u64::from(self.seen) {
                self.snapshots.pop_front();
            }
            let snapshot = self.snapshots.pop_front()?;
            // The command side has taken the one before.
            self.panel_side.snapshots.enqueue(snapshot).ok()?;
        }
        let Ok(()) = self.rig.service(&mut self.session, &mut Nowhere);
        self.rig.keep();
        Some(())
    }

    /// Passes on the next command, of which the chip's tick takes one at a time; whether there was one.
    fn relay(&mut self) -> bool {
        let sent = match self.panel_side.commands.dequeue() {
            Some(Command::Move(handle)) => {
                let plan = self.panel_side.plans.plan(&handle);
                self.panel_side.plans.give_back(handle.slot);
                self.tick_side.send_plan(&plan).ok()
            }
            Some(command) => self.tick_side.send(command).ok(),
            None => None,
        };
        if sent.is_some() {
            self.commands = self.commands.wrapping_add(1);
        }
        sent.is_some()
    }
}

/// The frame of the count that differs in its lowest bit.
fn with_flipped_bit(frame: [u8; 8]) -> [u8; 8] {
    decode(&RawFrame(frame)).map_or(frame, |reading| {
        encode(
            reading.counts ^ 1,
            false,
            reading.warning,
            Preamble::DEFAULT,
        )
        .to_be_bytes()
    })
}

/// Takes every byte and keeps none.
struct Nowhere;

impl embedded_io::ErrorType for Nowhere {
    type Error = std::convert::Infallible;
}

impl embedded_io::Write for Nowhere {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hash { tick, chip, host } => {
                write!(
                    f,
                    "first at tick {tick}, after which the hash is {chip:08x} on the chip and {host:08x} on the host"
                )
            }
            Self::Ticks { chip, host } => {
                write!(f, "the chip has done {chip} ticks in {host} periods")
            }
            Self::Command { tick } => {
                write!(
                    f,
                    "at tick {tick} the chip has taken a command that the host's panel did not give"
                )
            }
            Self::Interpreter { ticks } => {
                write!(
                    f,
                    "after {ticks} ticks the chip's panel had bytes or a snapshot that the host has not, or its record is lost"
                )
            }
        }
    }
}
