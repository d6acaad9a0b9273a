//! `RCV`, and what ends it.

use super::state::RecoveryOwner;
use crate::commander::RecoveryEnd;
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::execute::tenths;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Interpreter {
    /// `RCV`: 1 begins, or goes on for as long again; 0 ends it. Not for a macro: somebody has to be there.
    pub(in crate::gcs) fn recover(
        &mut self,
        value: f64,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let tick = self.commander.tick();
        match value {
            0.0 => {
                if self.commander.is_recovering() {
                    self.tell_mover(session);
                    self.commander.stop(Stop::Smooth, queues);
                }
                return Ok(());
            }
            1.0 if session.is_macro => return Err(ErrorCode::NotAllowed),
            1.0 if self.commander.is_recovering() => {
                if self.recovery_owner.connection != session.number {
                    return Err(ErrorCode::InMotion);
                }
            }
            1.0 => {
                let pose = self.commander.begin_recovery(&self.parameters, queues)?;
                self.events.add(tick, Event::Recovery(tenths(pose)));
                self.note_mover(session);
            }
            _ => return Err(ErrorCode::OutOfRange),
        }
        let ticks = session.jog_time_ms.map(|ms| self.commander.ticks(ms));
        self.recovery_owner = RecoveryOwner {
            connection: session.number,
            end_tick: ticks.map(|ticks| tick + ticks),
        };
        Ok(())
    }

    /// Whether a stage is being driven back into its reach.
    pub const fn is_recovering(&self) -> bool {
        self.commander.is_recovering()
    }

    /// Carries the recovery on, and ends the one whose time is over, or whose connection is gone.
    pub(in crate::gcs) fn advance_recovery(&mut self, queues: &mut CommandQueues<'_>) {
        if !self.commander.is_recovering() {
            return;
        }
        let tick = self.commander.tick();
        if self
            .recovery_owner
            .end_tick
            .take_if(|end| tick >= *end)
            .is_some()
        {
            self.commander.stop(Stop::Smooth, queues);
        }
        let event = match self.commander.advance_recovery(&self.parameters, queues) {
            None => return,
            Some(RecoveryEnd::InReach) => Event::Recovered,
            Some(RecoveryEnd::GivenUp) => Event::RecoveryGivenUp,
        };
        self.events.add(tick, event);
    }
}
