//! What is told of repeated moves.

use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// `ILC?`: a line of each table.
    pub(in crate::gcs) fn reply_repeated_moves(
        &self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for table in self.commander.repeated_moves() {
            let [without, best, last] = table.error_counts;
            reply.line(format_args!(
                "{}={} TRIALS={} FIRST={without:.3} BEST={best:.3} LAST={last:.3} POINTS={} TICKS={} KEPT={}",
                table.name,
                table.state,
                table.trials,
                table.points,
                table.spacing_ticks,
                u8::from(table.kept)
            ))?;
        }
        reply.end()
    }
}
