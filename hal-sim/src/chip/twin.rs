//! The same controller on the host, one tick behind the chip, fed with what the chip was fed: its hash says whether the
//! two agree to the bit, and if they do, its sample is the chip's.
//!
//! Command bytes reach both panels, but at different instants: the chip's come over a serial line and wait for its idle
//! task. So a command of the twin's panel is held back until the chip's tick has taken its own.

use super::period::{Period, Trace};
use crate::observer::TickRecord;
use firmware::config::Config;
use firmware::controller::{Inputs, State, tick};
use firmware::drivers::biss::RawFrame;
use firmware::link::{Link, PanelLink, TickLink};
use firmware::panel::{Identity, Panel, Session};
use firmware::parameters::Parameters;
use std::fmt;

const SERVICES: usize = 3;

/// What the twin knows of the tick that the chip is about to execute.
struct Pending {
    inputs: Inputs,
    pose: [f64; 3],
}

/// The twin.
pub struct Twin {
    config: Config,
    state: State,
    record: TickRecord,
    panel: Panel,
    session: Session,
    /// The panel's ends of the link that the tick's side of [`Self::relay`] answers.
    panel_link: PanelLink<'static>,
    panel_side: TickLink<'static>,
    tick_side: PanelLink<'static>,
    tick_link: TickLink<'static>,
    commands: u32,
    input: Vec<u8>,
    pending: Option<Pending>,
}

/// The first tick at which chip and twin differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divergence {
    /// Their hashes differ.
    Hash {
        /// Ticks done.
        ticks: u32,
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
    /// The chip's tick has taken a command that the twin's panel did not send.
    Command {
        /// Ticks done.
        ticks: u32,
    },
}

impl Twin {
    /// A twin of a chip that has just started.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let (mut panel_side, panel_link) = endless_link();
        let (mut tick_link, tick_side) = endless_link();
        // The twin's panel orders its records from the twin's tick; nothing of them has to be held back.
        std::mem::swap(&mut panel_side.recorder, &mut tick_link.recorder);
        let identity = Identity {
            serial: "",
            version: "",
        };
        Self {
            config: Config::new(parameters),
            state: State::new(),
            record: TickRecord::default(),
            panel: Panel::new(parameters, identity),
            session: Session::new(),
            panel_link,
            panel_side,
            tick_side,
            tick_link,
            commands: 0,
            input: Vec::new(),
            pending: None,
        }
    }

    /// Bytes that were sent to the chip.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.input.extend_from_slice(bytes);
    }

    /// Catches up with the tick that the chip has executed since the last call: its record, and the stage's pose (m, m,
    /// rad) at its latch. `None` at the first call, when there was none. To be called first thing in every period, and
    /// only while bridges and emergency stop leave the chip in peace.
    ///
    /// # Errors
    /// Where the two went apart.
    pub fn follow(
        &mut self,
        period: &mut Period<'_>,
    ) -> Result<Option<(&TickRecord, [f64; 3])>, Divergence> {
        let trace = period.trace();
        if u64::from(trace.ticks) != period.tick {
            return Err(Divergence::Ticks {
                chip: trace.ticks,
                host: period.tick,
            });
        }
        self.serve_panel();
        let (current_counts, supply_counts) = period.stage.analog();
        let next = Pending {
            inputs: Inputs {
                frames: period.stage.frames().map(RawFrame),
                bridge_fault: [false; 3],
                emergency_stop: false,
                current_counts,
                supply_counts,
                tick_cycles: 0,
                late: false,
            },
            pose: period.stage.latched_pose(),
        };
        let Some(Pending { inputs, pose }) = self.pending.replace(next) else {
            return Ok(None);
        };
        self.relay(&trace)?;
        tick(
            &mut self.config,
            &mut self.state,
            &inputs,
            &mut self.tick_link,
            &mut self.record,
        );
        if self.record.hash.0 != trace.hash {
            return Err(Divergence::Hash {
                ticks: trace.ticks,
                chip: trace.hash,
                host: self.record.hash.0,
            });
        }
        Ok(Some((&self.record, pose)))
    }

    /// Lets the panel handle what has been received; its answers are the chip's to give.
    fn serve_panel(&mut self) {
        let taken = self.session.receive(&self.input);
        self.input.drain(..taken);
        if let Some(snapshot) = self.tick_side.snapshot() {
            // Full when the panel has not taken the last one, which it does in the next line.
            let _ = self.panel_side.snapshots.enqueue(snapshot);
        }
        // As often as the chip's idle task does in a period, and once more.
        for _ in 0..SERVICES {
            let Ok(()) = self
                .panel
                .service(&mut self.session, &mut self.panel_link, &mut Nowhere);
        }
    }

    /// Passes on as many commands as the chip's tick has taken.
    fn relay(&mut self, trace: &Trace) -> Result<(), Divergence> {
        while self.commands != trace.commands {
            let sent = self
                .panel_side
                .commands
                .dequeue()
                .and_then(|command| self.tick_side.send(command).ok());
            if sent.is_none() {
                return Err(Divergence::Command { ticks: trace.ticks });
            }
            self.commands = self.commands.wrapping_add(1);
        }
        Ok(())
    }
}

/// A link whose ends live as long as the process: some kilobytes for each run.
fn endless_link() -> (TickLink<'static>, PanelLink<'static>) {
    Box::leak(Box::new(Link::new())).split()
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
            Self::Hash { ticks, chip, host } => {
                write!(
                    f,
                    "after {ticks} ticks the hash is {chip:08x} on the chip and {host:08x} on the host"
                )
            }
            Self::Ticks { chip, host } => {
                write!(f, "the chip has done {chip} ticks in {host} periods")
            }
            Self::Command { ticks } => {
                write!(
                    f,
                    "after {ticks} ticks the chip has taken a command that the host's panel did not give"
                )
            }
        }
    }
}
