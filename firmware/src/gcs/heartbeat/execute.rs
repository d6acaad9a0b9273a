//! `HBT`, and what follows a silence of the host.

use super::state::{Promise, Silence};
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::request::MAX_DELAY_MS;
use crate::gcs::session::Session;
use crate::motion::Stop;
use crate::parameters::MIN_HOST_SILENCE_MS;
use crate::queues::CommandQueues;

impl Interpreter {
    /// `HBT`: with it a connection promises to be heard, or, with 0, ends its promise and no other. A macro can not promise: it
    /// sets the parameter.
    pub(in crate::gcs) fn set_heartbeat(
        &mut self,
        ms: f64,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        if ms != 0.0 && !(MIN_HOST_SILENCE_MS..=MAX_DELAY_MS).contains(&ms) {
            return Err(ErrorCode::OutOfRange);
        }
        let mut silence = Silence::default();
        silence.end(self.commander.tick());
        let Some(connection) = session.number.filter(|_| !session.is_macro) else {
            for parameters in [&mut self.parameters, &mut self.previous_parameters] {
                parameters.supervision.host_silence_ms = ms;
            }
            self.heartbeat.any = silence;
            return Ok(());
        };
        let promises = &mut self.heartbeat.promises;
        promises.retain(|promise| promise.connection != connection);
        if ms == 0.0 {
            return Ok(());
        }
        let promise = Promise {
            connection,
            ms,
            silence,
            has_ended: false,
        };
        promises.push(promise).map_err(|_| ErrorCode::Busy)
    }

    /// Notes whether a connection has been heard.
    pub(in crate::gcs) fn note_activity(&mut self, session: &mut Session) {
        if !core::mem::take(&mut session.received_bytes) {
            return;
        }
        let tick = self.commander.tick();
        self.heartbeat.any.end(tick);
        for promise in &mut self.heartbeat.promises {
            if Some(promise.connection) == session.number {
                promise.silence.end(tick);
            }
        }
    }

    /// Stops when one that has promised to be heard has not been, or, for the parameter, nobody at all.
    pub(in crate::gcs) fn watch_heartbeat(&mut self, queues: &mut CommandQueues<'_>) {
        let tick = self.commander.tick();
        let ms = self.parameters.supervision.host_silence_ms;
        let ticks = self.commander.ticks(ms);
        let mut missed =
            (ms != 0.0 && self.heartbeat.any.becomes_too_long(tick, ticks)).then_some(ms);
        for promise in &mut self.heartbeat.promises {
            let ticks = self.commander.ticks(promise.ms);
            if promise.silence.becomes_too_long(tick, ticks) {
                missed = Some(promise.ms);
            }
        }
        let Some(ms) = missed else {
            return;
        };
        self.heartbeat.forget_missed();
        self.events.add(tick, Event::HostSilent(ms));
        self.stop_all(Stop::Urgent, queues);
        self.report_to_all(ErrorCode::Stopped);
    }
}
