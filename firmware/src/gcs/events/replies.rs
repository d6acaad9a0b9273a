//! What `EVT?` answers.

use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// Answers `EVT?`: number, tick and what has happened; faults stay longer than what else there was.
    pub(in crate::gcs) fn reply_events(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for (number, tick, event) in self.events.older_faults() {
            reply.line(format_args!("{number} {tick} {event}"))?;
        }
        let gone = self.events.count - self.events.entries.len() as u32;
        for (number, (tick, event)) in (gone + 1..).zip(&self.events.entries) {
            reply.line(format_args!("{number} {tick} {event}"))?;
        }
        reply.end()
    }
}
