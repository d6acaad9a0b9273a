//! `OWN`, and what others may do meanwhile.

use super::state::Owner;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::macros::MacroRequest;
use crate::gcs::request::{Action, Request};
use crate::gcs::session::Session;
use crate::gcs::text::{Name, Text};

impl Interpreter {
    /// `OWN`: 1 makes the connection the owner, if there is none; 0 ends that.
    pub(in crate::gcs) fn own(
        &mut self,
        value: f64,
        name: Option<Name>,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if let Some(name) = name {
            session.name = Text::new(name.as_bytes()).unwrap_or(session.name);
        }
        let Some(connection) = session.number.filter(|_| !session.is_macro) else {
            return Err(ErrorCode::NotAllowed);
        };
        match value {
            0.0 => self.ownership.release(connection),
            1.0 if self.ownership.excludes(session.number) => {
                return Err(ErrorCode::OwnedByAnother);
            }
            1.0 if self.ownership.owner.is_none() => {
                self.ownership.owner = Some(Owner {
                    connection,
                    name: session.shown_name(),
                    since_tick: self.commander.tick(),
                });
            }
            1.0 => {}
            _ => return Err(ErrorCode::OutOfRange),
        }
        Ok(())
    }

    /// Whether a connection may ask for this; notes who commanded last.
    pub(in crate::gcs) fn check_ownership(
        &mut self,
        request: &Request,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        if !request.changes_stage() {
            return Ok(());
        }
        if self.ownership.excludes(session.number) {
            return Err(ErrorCode::OwnedByAnother);
        }
        self.connections.last_command = Some((session.shown_name(), self.commander.tick()));
        Ok(())
    }
}

impl Request {
    /// Whether it starts a motion, or changes a mode, a parameter or anything else that motions of others depend on: what an owner
    /// has for itself. Stops do not count, nor does what belongs to the connection alone; variables look for themselves.
    pub fn changes_stage(&self) -> bool {
        match self {
            Self::Macro(request) => matches!(
                request,
                MacroRequest::Begin(_)
                    | MacroRequest::End
                    | MacroRequest::Start(..)
                    | MacroRequest::Delete(_)
            ),
            Self::Act(action) => !matches!(
                action,
                Action::Stop
                    | Action::Halt(_)
                    | Action::Recover(0.0)
                    | Action::Own(..)
                    | Action::Level(..)
                    | Action::Heartbeat(_)
                    | Action::JogTime(_)
                    | Action::Record(_)
                    | Action::RestartStatistics
                    | Action::Delay(_)
                    | Action::Wait(_)
                    | Action::Jump(..)
                    | Action::Leave(_)
            ),
            _ => false,
        }
    }
}
