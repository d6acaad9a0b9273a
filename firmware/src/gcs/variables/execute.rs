//! What the lines about variables do.

use super::request::VariableRequest;
use super::state::number_text;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;
use crate::gcs::text::{Name, Text};

impl Interpreter {
    /// Carries out what is about variables.
    pub(in crate::gcs) fn execute_variables(
        &mut self,
        request: &VariableRequest,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let result = match request {
            VariableRequest::Set(name, value) => self.set_variable(name, *value, session),
            VariableRequest::Add(name, a, b) => {
                number_text(a + b).and_then(|sum| self.set_variable(name, Some(sum), session))
            }
            VariableRequest::Query(names) => {
                let named = names.iter().flatten();
                let locals = self.macros.locals(session);
                let known = |name: &Name| self.variables.get(name, locals).is_some();
                if named.clone().all(known) {
                    return self.reply_variables(names, out);
                }
                Err(ErrorCode::UnknownVariable)
            }
        };
        if let Err(code) = result {
            session.error = code;
        }
        Ok(())
    }

    fn set_variable(
        &mut self,
        name: &Name,
        value: Option<Text>,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        let locals = self.macros.locals_mut(session);
        self.variables.set(name, value, locals)
    }

    fn reply_variables(
        &self,
        names: &[Option<Name>],
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let all = names.iter().all(Option::is_none);
        for (name, value) in self.variables.iter() {
            if all || names.contains(&Some(*name)) {
                reply.line(format_args!("{name}={value}"))?;
            }
        }
        reply.end()
    }
}
