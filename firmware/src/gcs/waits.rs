//! What holds up the lines of a connection.

use super::error::ErrorCode;
use super::interpreter::Interpreter;
use super::request::{Condition, Operand};
use super::session::{Awaited, Session};
use crate::commander::Referencing;
use crate::queues::CommandQueues;

impl Interpreter {
    /// Whether the lines of the connection have to wait; ends the wait when it is over.
    pub(super) fn is_waiting(
        &mut self,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> bool {
        let Some(wait) = session.wait else {
            return false;
        };
        if wait.stops != self.stops {
            session.error = ErrorCode::Stopped;
            session.abandon();
            return false;
        }
        let over = match wait.what {
            Awaited::Tick(tick) => self.commander.tick() >= tick,
            // A fault ends it too: the condition may never come about, and the error has been set.
            Awaited::Condition(condition) => {
                let holds = self.is_met(&condition, session);
                if let Err(code) = holds {
                    session.error = code;
                }
                self.commander.current_snapshot().is_some()
                    && (self.commander.is_faulted() || holds.unwrap_or(true))
            }
            Awaited::Stored => match self.persistence.result() {
                None => false,
                Some(result) => {
                    session.error = result.err().unwrap_or(session.error);
                    true
                }
            },
            Awaited::Reference => match self.commander.poll_referencing(queues) {
                Referencing::Waiting => false,
                Referencing::Done => true,
                Referencing::Failed(error) => {
                    self.note_pose_outside(&error);
                    session.error = error.into();
                    true
                }
            },
        };
        if over {
            session.wait = None;
        }
        !over
    }

    pub(super) fn is_met(
        &self,
        condition: &Condition,
        session: &Session,
    ) -> Result<bool, ErrorCode> {
        let left = match &condition.left {
            Operand::Axis(quantity, axis) => self.commander.value(*quantity, *axis),
            Operand::Variable(name) => self.variable_number(name, session)?,
        };
        Ok(condition.operator.holds(left, condition.value))
    }
}
