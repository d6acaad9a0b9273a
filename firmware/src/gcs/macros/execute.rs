//! What the lines about macros do.

use super::replies::reply_lines;
use super::request::MacroRequest;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::request::Condition;
use crate::gcs::session::Session;
use crate::gcs::text::{Name, Text};

impl Interpreter {
    /// Carries out what is about macros; queries are answered.
    pub(in crate::gcs) fn execute_macro(
        &mut self,
        request: &MacroRequest,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let result = match request {
            MacroRequest::Begin(name) => self.macros.begin(*name, self.commander.tick(), session),
            MacroRequest::End => self.macros.end(session),
            MacroRequest::Start(name, times, arguments) => {
                self.start(name, *times, arguments, session)
            }
            MacroRequest::Delete(name) => self.macros.delete(name),
            MacroRequest::Stop(name) => self.stop_macro(name.as_ref()),
            MacroRequest::List(Some(name)) => match self.macros.place(name) {
                Ok(place) => return reply_lines(self.macros.store.text(place), out),
                Err(code) => Err(code),
            },
            _ => return self.reply_macros(request, out),
        };
        let changes = matches!(request, MacroRequest::End | MacroRequest::Delete(_));
        match result {
            Ok(()) if changes => self.persistence.mark_changed(),
            Ok(()) => {}
            Err(code) => session.error = code,
        }
        Ok(())
    }

    /// `MAC START`: from a connection the macro begins a session of its own and gets the connection's variables; from a macro it
    /// runs before that goes on.
    fn start(
        &mut self,
        name: &Name,
        times: u32,
        arguments: &[Option<Text>; 2],
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if self.macros.is_running() && !session.is_macro {
            return Err(ErrorCode::MacroRunning);
        }
        let place = self.macros.place(name)?;
        self.variables.take(&mut session.variables)?;
        self.macros.calls.enter(place, times, arguments)?;
        if !session.is_macro {
            self.macros.failure = None;
            self.macros.session = Session::for_macro(session);
            // What was reported before does not end it.
            let mut session = core::mem::take(&mut self.macros.session);
            self.report_errors(&mut session);
            session.error = ErrorCode::None;
            self.macros.session = session;
        }
        Ok(())
    }

    fn stop_macro(&mut self, name: Option<&Name>) -> Result<(), ErrorCode> {
        if let Some(name) = name {
            let place = self.macros.place(name)?;
            if !self.macros.calls.contains(place) {
                return Ok(());
            }
        }
        self.macros.stop();
        Ok(())
    }

    /// `JRC` and `MEX`, which only a macro can have.
    pub(in crate::gcs) fn jump_if(
        &mut self,
        by: Option<i32>,
        condition: &Condition,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        if !session.is_macro {
            return Err(ErrorCode::NotAllowed);
        }
        if !self.is_met(condition, session)? {
            return Ok(());
        }
        let macros = &mut self.macros;
        match by {
            Some(by) => {
                // A loop without a wait goes round once a tick.
                macros.lines = 0;
                macros.calls.jump(by, &macros.store)
            }
            None => {
                macros.calls.leave();
                Ok(())
            }
        }
    }
}
