//! `OWN?`

use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;

/// Stands for nobody: no name has brackets.
const NOBODY: &str = "(nobody)";

impl Interpreter {
    /// Answers `OWN?`: who owns and since when, whether that is this connection, and who changed something last.
    pub(in crate::gcs) fn reply_ownership(
        &self,
        session: &Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let seconds = |tick: u64| {
            let ticks = self.commander.tick().saturating_sub(tick);
            ticks as f64 / self.parameters.limits.rate_hz
        };
        let owner = self.ownership.owner.as_ref();
        let last = self.connections.last_command.as_ref();
        let mut reply = ReplyWriter::new(out);
        reply.line(format_args!(
            "OWNER={}",
            owner.map_or(NOBODY, |owner| owner.name.as_str())
        ))?;
        reply.line(format_args!(
            "MINE={}",
            u8::from(self.ownership.is_of(session.number))
        ))?;
        reply.line(format_args!(
            "OWNED_S={:.1}",
            owner.map_or(0.0, |owner| seconds(owner.since_tick))
        ))?;
        reply.line(format_args!(
            "LAST={}",
            last.map_or(NOBODY, |(name, _)| name.as_str())
        ))?;
        reply.line(format_args!(
            "LAST_S={:.1}",
            last.map_or(0.0, |(_, tick)| seconds(*tick))
        ))?;
        reply.end()
    }
}
