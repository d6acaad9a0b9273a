//! `JOG`, `JTM`, and what ends.

use crate::commander::Quantity;
use crate::commander::axis::AxisValues;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::request::MAX_DELAY_MS;
use crate::gcs::session::Session;
use crate::motion::Stop;
use crate::queues::CommandQueues;

/// Shortest time that a velocity may be asked to last: some ticks of a slow line.
const MIN_JOG_TIME_MS: f64 = 10.0;

impl Interpreter {
    /// `JOG`: the velocities belong to the connection from now on.
    pub(in crate::gcs) fn jog(
        &mut self,
        values: &AxisValues,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.commander.jog(values, queues)?;
        let owner = session.number.filter(|_| !session.is_macro);
        self.jogs.note(values, owner, self.jog_end(session));
        Ok(())
    }

    /// The tick at which a velocity ends that this connection asks for now.
    fn jog_end(&self, session: &Session) -> Option<u64> {
        let ticks = session.jog_time_ms.map(|ms| self.commander.ticks(ms));
        ticks.map(|ticks| self.commander.tick() + ticks)
    }

    /// `JTM`: how long the velocities of this connection last without another `JOG`, those in force from now on; 0: as long as
    /// the connection.
    pub(in crate::gcs) fn set_jog_time(
        &mut self,
        ms: f64,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if ms != 0.0 && !(MIN_JOG_TIME_MS..=MAX_DELAY_MS).contains(&ms) {
            return Err(ErrorCode::OutOfRange);
        }
        session.jog_time_ms = (ms != 0.0).then_some(ms);
        let owner = session.number.filter(|_| !session.is_macro);
        self.jogs.set_end(owner, self.jog_end(session));
        Ok(())
    }

    /// Ends the velocities whose time is over, or whose connection is gone; tried again until it is done.
    pub(in crate::gcs) fn end_jogs(&mut self, queues: &mut CommandQueues<'_>) {
        let Some(ended) = self.jogs.ended(self.commander.tick()) else {
            return;
        };
        if self.commander.current_snapshot().is_none() {
            return;
        }
        // What has come to rest, or moves for another reason, since is nobody's jog.
        let jogs = |axis| self.commander.value(Quantity::Jog, axis) != 0.0;
        let is_any_left = crate::commander::axis::Axis::ALL
            .into_iter()
            .any(|axis| ended[axis.index()].is_some() && jogs(axis));
        if is_any_left && self.commander.jog(&ended, queues).is_err() {
            // There is always a way to rest.
            self.commander.stop(Stop::Smooth, queues);
        }
        self.jogs.forget(|axis| ended[axis.index()].is_some());
    }
}
