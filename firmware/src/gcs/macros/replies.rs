//! What queries about macros answer.

use super::request::MacroRequest;
use super::state::Failure;
use super::texts::lines;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// Answers a query about macros.
    pub(super) fn reply_macros(
        &self,
        request: &MacroRequest,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let macros = &self.macros;
        let mut reply = ReplyWriter::new(out);
        match request {
            MacroRequest::Error => {
                if let Some(Failure {
                    name,
                    line,
                    code,
                    text,
                }) = &macros.failure
                {
                    // Only what could be printed was recorded.
                    let text = core::str::from_utf8(text).unwrap_or_default();
                    let code = code.number();
                    reply.line(format_args!("{name} {line}={code} <{text}>"))?;
                }
            }
            MacroRequest::Free => reply.line(format_args!("{}", macros.store.free()))?,
            MacroRequest::List(_) => {
                for name in macros.store.names() {
                    reply.line(format_args!("{name}"))?;
                }
            }
            MacroRequest::Running => {
                for place in macros.calls.places() {
                    reply.line(format_args!("{}", macros.store.name(place)))?;
                }
            }
            _ => reply.line(format_args!("{}", u8::from(macros.is_running())))?,
        }
        reply.end()
    }
}

/// The lines of a macro.
pub(super) fn reply_lines(text: &[u8], out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for line in lines(text) {
        // Only what could be printed was recorded.
        let line = core::str::from_utf8(line).unwrap_or_default();
        reply.line(format_args!("{line}"))?;
    }
    reply.end()
}
