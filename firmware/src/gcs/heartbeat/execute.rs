//! `HBT`, and what follows a silence of the host.

use super::state::Heartbeat;
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::request::MAX_DELAY_MS;
use crate::gcs::session::Session;
use crate::motion::Stop;
use crate::parameters::MIN_HOST_SILENCE_MS;
use crate::queues::CommandQueues;

impl Interpreter {
    /// `HBT`: longest silence, or 0 for none. With it a connection promises to be heard; a macro can not.
    pub(in crate::gcs) fn set_heartbeat(
        &mut self,
        ms: f64,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if ms != 0.0 && !(MIN_HOST_SILENCE_MS..=MAX_DELAY_MS).contains(&ms) {
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
    pub(in crate::gcs) fn note_activity(&mut self, session: &mut Session) {
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
    pub(in crate::gcs) fn watch_heartbeat(&mut self, queues: &mut CommandQueues<'_>) {
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
