//! What is told of an excitation.

use crate::control::excitation::ExcitationEnd;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// Answers `EXC?`.
    pub(in crate::gcs) fn reply_excitation(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let report = self.commander.excitation();
        let mut reply = ReplyWriter::new(out);
        reply.line(format_args!(
            "RUNS={}",
            u8::from(self.commander.is_exciting())
        ))?;
        reply.line(format_args!("END={}", end_text(report.end)))?;
        reply.line(format_args!("PIVOT={}", report.pivot + 1))?;
        reply.line(format_args!("VALUE={:e}", report.value))?;
        reply.line(format_args!("TICKS={}", report.ticks))?;
        reply.end()
    }
}

const fn end_text(end: ExcitationEnd) -> &'static str {
    match end {
        ExcitationEnd::None => "none",
        ExcitationEnd::Time => "time",
        ExcitationEnd::Way => "way",
        ExcitationEnd::Current => "current",
        ExcitationEnd::Stopped => "stopped",
        ExcitationEnd::Fault => "fault",
    }
}
