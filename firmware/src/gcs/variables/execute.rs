//! What the lines about variables do.

use super::request::VariableRequest;
use super::state::number_text;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;
use crate::gcs::text::Name;

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
                let known = |name: &Name| self.variable(name, session).is_some();
                if names.iter().flatten().all(known) {
                    return self.reply_variables(names, session, out);
                }
                Err(ErrorCode::UnknownVariable)
            }
        };
        if let Err(code) = result {
            session.error = code;
        }
        Ok(())
    }

    fn reply_variables(
        &self,
        names: &[Option<Name>],
        session: &Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let all = names.iter().all(Option::is_none);
        let is_hidden = |name: &Name| session.variables.get(name).is_some();
        let of_macros = self.variables.iter().filter(|(name, _)| !is_hidden(name));
        for (name, value) in session.variables.iter().chain(of_macros) {
            if all || names.contains(&Some(*name)) {
                reply.line(format_args!("{name}={value}"))?;
            }
        }
        reply.end()
    }
}
