//! The host's heartbeat: when one is asked for with `HBT` or its parameter, a host that is not heard for longer is taken for gone.
//!
//! Heard is any byte on a connection that has promised it with `HBT`: a page that looks on beside a script, or another client,
//! does not stand for a script that has died. Where no connection has promised anything (the parameter was set, kept
//! settings ask for it, or a macro said `HBT`) it is any byte on any connection. What follows is what `STP` does: the motion ends at the highest deceleration, on its
//! path, the macro and all waits end, every connection gets error 10, and the event is kept. It is no fault: a stage that
//! stands still under its servo is safer than one whose motors are off, and whoever comes back finds it where it stopped.

use super::error::ErrorCode;
use super::events::Event;
use super::session::Session;
use super::{LONGEST_MS, Panel};
use crate::motion::Stop;
use crate::queues::CommandQueues;

/// Shortest heartbeat that can be asked for: what an operating system keeps with ease.
pub(super) const SHORTEST_MS: f64 = 10.0;

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Heartbeat {
    heard: u64,
    /// It has been silent for too long, and not heard since.
    is_silent: bool,
    /// Connections have promised to be heard, and they alone count.
    is_promised: bool,
    /// Times it was switched off: promises from before that are void.
    round: u32,
}

impl Panel {
    /// `HBT`: longest silence, or 0 for none. With it a connection promises to be heard; a macro can not.
    pub(super) fn set_heartbeat(
        &mut self,
        ms: f64,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if ms != 0.0 && !(SHORTEST_MS..=LONGEST_MS).contains(&ms) {
            return Err(ErrorCode::OutOfRange);
        }
        for parameters in [&mut self.parameters, &mut self.parameters_before] {
            parameters.supervision.host_silence_ms = ms;
        }
        let Heartbeat {
            mut is_promised,
            mut round,
            ..
        } = self.heartbeat;
        if ms == 0.0 {
            is_promised = false;
            round = round.wrapping_add(1);
        } else if !session.is_macro {
            is_promised = true;
            session.promise = Some(round);
        }
        self.heartbeat = Heartbeat {
            heard: self.stage.tick(),
            is_silent: false,
            is_promised,
            round,
        };
        Ok(())
    }

    /// Notes whether a connection has been heard.
    pub(super) fn listen(&mut self, session: &mut Session) {
        let Heartbeat {
            is_promised, round, ..
        } = self.heartbeat;
        let counts = !is_promised || session.promise == Some(round);
        if core::mem::take(&mut session.heard) && counts {
            self.heartbeat.heard = self.stage.tick();
            self.heartbeat.is_silent = false;
        }
    }

    /// Stops when the host has been silent for too long.
    pub(super) fn watch_heartbeat(&mut self, queues: &mut CommandQueues<'_>) {
        let Heartbeat {
            heard, is_silent, ..
        } = self.heartbeat;
        let ms = self.parameters.supervision.host_silence_ms;
        let tick = self.stage.tick();
        if ms == 0.0 || is_silent || tick <= heard + self.stage.ticks(ms) {
            return;
        }
        self.heartbeat.is_silent = true;
        self.events.add(tick, Event::Silent(ms));
        self.stop_all(Stop::Urgent, queues);
        self.stage.tell_all(ErrorCode::Stopped);
    }
}
