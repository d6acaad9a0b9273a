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
use super::{MAX_DELAY_MS, Panel};
use crate::motion::Stop;
use crate::queues::PanelLink;

/// Shortest heartbeat that can be asked for: what an operating system keeps with ease.
pub(super) const SHORTEST_MS: f64 = 10.0;

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Heartbeat {
    last_heard_tick: u64,
    /// It has been silent for too long, and not heard since.
    is_silent: bool,
    /// Connections have promised to be heard, and they alone count.
    is_promised: bool,
    /// Times it was switched off: promises from before that are void.
    generation: u32,
}

impl Panel {
    /// `HBT`: longest silence, or 0 for none. With it a connection promises to be heard; a macro can not.
    pub(super) fn set_heartbeat(
        &mut self,
        ms: f64,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if ms != 0.0 && !(SHORTEST_MS..=MAX_DELAY_MS).contains(&ms) {
            return Err(ErrorCode::OutOfRange);
        }
        for parameters in [&mut self.parameters, &mut self.previous_parameters] {
            parameters.supervision.host_silence_ms = ms;
        }
        let Heartbeat {
            mut is_promised,
            mut generation,
            ..
        } = self.heartbeat;
        if ms == 0.0 {
            is_promised = false;
            generation = generation.wrapping_add(1);
        } else if !session.is_macro {
            is_promised = true;
            session.promised_generation = Some(generation);
        }
        self.heartbeat = Heartbeat {
            last_heard_tick: self.commander.tick(),
            is_silent: false,
            is_promised,
            generation,
        };
        Ok(())
    }

    /// Notes whether a connection has been heard.
    pub(super) fn note_activity(&mut self, session: &mut Session) {
        let Heartbeat {
            is_promised,
            generation,
            ..
        } = self.heartbeat;
        let counts = !is_promised || session.promised_generation == Some(generation);
        if core::mem::take(&mut session.received_bytes) && counts {
            self.heartbeat.last_heard_tick = self.commander.tick();
            self.heartbeat.is_silent = false;
        }
    }

    /// Stops when the host has been silent for too long.
    pub(super) fn watch_heartbeat(&mut self, queues: &mut PanelLink<'_>) {
        let Heartbeat {
            last_heard_tick,
            is_silent,
            ..
        } = self.heartbeat;
        let ms = self.parameters.supervision.host_silence_ms;
        let tick = self.commander.tick();
        if ms == 0.0 || is_silent || tick <= last_heard_tick + self.commander.ticks(ms) {
            return;
        }
        self.heartbeat.is_silent = true;
        self.events.add(tick, Event::HostSilent(ms));
        self.stop_all(Stop::Urgent, queues);
        self.report_to_all(ErrorCode::Stopped);
    }
}
