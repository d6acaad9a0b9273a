//! What lines about repeated moves do.

use super::request::LearnAction;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::text::Name;
use crate::iterative_learning::{LearningError, TableName};
use crate::queues::CommandQueues;

impl Interpreter {
    /// `ILC LEARN`, `ILC FREEZE`, `ILC FORGET`. Not in motion: the table under way is what the motion was sent with.
    pub(in crate::gcs) fn change_repeated_moves(
        &mut self,
        action: &LearnAction,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        let commander = &mut self.commander;
        let done = match action {
            LearnAction::Learn(name) => commander.learn_move(table_name(name), queues),
            LearnAction::Freeze(name) => commander.freeze_move(&table_name(name)),
            LearnAction::Forget(name) => {
                commander.forget_move(name.as_ref().map(table_name).as_ref(), queues)
            }
        };
        done.map_err(|error| match error {
            LearningError::TooMany => ErrorCode::NoMemory,
            LearningError::Unknown => ErrorCode::OutOfRange,
            LearningError::OtherWaits => ErrorCode::Busy,
        })
    }
}

fn table_name(name: &Name) -> TableName {
    // As long as a name can be.
    TableName::try_from(name.as_str()).unwrap_or_default()
}
