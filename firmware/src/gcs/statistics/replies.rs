//! What the statistics answer.

use crate::control::units::UNITS_PER_RAD;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// `LST`
    pub(in crate::gcs) fn restart_statistics(&mut self) {
        self.statistics.restart();
    }

    /// Answers `LST?`.
    pub(in crate::gcs) fn reply_statistics(
        &mut self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let s = self.statistics;
        let mean = match s.ticks {
            0 => 0.0,
            ticks => s.cycles_sum as f64 / ticks as f64,
        };
        let peak_rad = f64::from(core::mem::take(&mut self.statistics.peak_error)) / UNITS_PER_RAD;
        let mut reply = ReplyWriter::new(out);
        reply.line(format_args!("TICKS={}", s.ticks))?;
        reply.line(format_args!("CYCLES_LAST={}", s.cycles))?;
        reply.line(format_args!("CYCLES_MEAN={mean:.1}"))?;
        reply.line(format_args!("CYCLES_WORST={}", s.cycles_worst))?;
        reply.line(format_args!("LATE={}", s.late))?;
        reply.line(format_args!("PEAK_ERROR_RAD={peak_rad:e}"))?;
        reply.line(format_args!("COMMANDS={}", s.commands))?;
        reply.line(format_args!("REFUSED={}", s.refused))?;
        self.reply_learnt(&mut reply)?;
        self.reply_conditions(&mut reply)?;
        reply.line(format_args!("LOOSENED={}", self.loosened))?;
        reply.end()
    }
}
