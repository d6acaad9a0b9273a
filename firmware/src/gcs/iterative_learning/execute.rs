//! What lines about repeated moves do.

use super::request::LearnAction;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::{Awaited, Session};
use crate::gcs::text::Name;
use crate::iterative_learning::{LearningError, TableName};
use crate::queues::CommandQueues;

impl Interpreter {
    /// `ILC LEARN`, `ILC FREEZE`, `ILC KEEP`, `ILC FORGET`. Not in motion: the table under way is what the motion was sent with.
    pub(in crate::gcs) fn change_repeated_moves(
        &mut self,
        action: &LearnAction,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        if let LearnAction::Keep(name) = action {
            self.store_move(table_name(name), queues)?;
            self.wait(session, Awaited::Stored);
            return Ok(());
        }
        let commander = &mut self.commander;
        let done = match action {
            LearnAction::Learn(name) => commander.learn_move(table_name(name), queues),
            LearnAction::Freeze(name) => commander.freeze_move(&table_name(name)),
            LearnAction::Keep(_) => Ok(()),
            LearnAction::Forget(name) => {
                let name = name.as_ref().map(table_name);
                // What is forgotten is stored no more.
                if commander.is_move_kept(name.as_ref()) {
                    self.persistence.mark_changed();
                }
                commander.forget_move(name.as_ref(), &mut queues.trial)
            }
        };
        Ok(done?)
    }
}

impl From<LearningError> for ErrorCode {
    fn from(error: LearningError) -> Self {
        match error {
            LearningError::TooMany => Self::NoMemory,
            LearningError::Unknown => Self::OutOfRange,
            LearningError::OtherWaits => Self::Busy,
        }
    }
}

fn table_name(name: &Name) -> TableName {
    // As long as a name can be.
    TableName::try_from(name.as_str()).unwrap_or_default()
}
