//! `DRR?`: an answer of any length, out of a connection that goes on meanwhile.
//!
//! The answer is a state of its session. Each service writes some more of it, line by line, as far as the output has
//! room; single bytes act and are answered between two lines, other connections are served as ever, and lines of this
//! one wait.
//!
//! If another record takes the place of the one that is being read, the rest is answered as not a number, with an
//! error: a client counts the rows.

use super::channel::Channel;
use super::scales::{MachineNow, RecordRow};
use super::state::Record;
use crate::recorder::{Cursor, RECORDER_TABLES, RecorderReader};
use core::fmt::{self, Write as _};
use heapless::String;

/// Longest line: eight numbers.
pub(super) const MAX_LINE_BYTES: usize = 384;
/// Lines that a service writes at most, so that other work is not kept waiting.
pub(super) const LINES_PER_SERVICE: usize = 8;

/// What is left of an answer.
pub(in crate::gcs) struct RecordReadout {
    /// The record.
    pub(super) number: u32,
    pub(super) columns: [Option<Channel>; RECORDER_TABLES],
    /// Lines of the head that are written.
    pub(super) header_lines_written: usize,
    pub(super) cursor: Cursor,
    /// The next row, counted from that of the trigger.
    pub(super) row: i64,
    pub(super) rows: u32,
    pub(super) left: u32,
}

impl RecordReadout {
    /// The next line, with its end.
    pub(super) fn line(
        &mut self,
        record: Option<&Record>,
        recorder: &RecorderReader<'_>,
        machine: &MachineNow<'_>,
    ) -> String<MAX_LINE_BYTES> {
        let mut line = String::new();
        // The longest line fits; a longer one would be cut short, and counted all the same.
        if self.header_lines_written < HEADER_LINES + self.columns() {
            let _ = self.header_line(record, &mut line);
            let _ = line.write_str(" \n");
            self.header_lines_written += 1;
        } else {
            let _ = self.row_line(record, recorder, machine, &mut line);
            self.left -= 1;
            let _ = line.write_str(if self.left == 0 { "\n" } else { " \n" });
        }
        line
    }

    fn columns(&self) -> usize {
        self.columns.iter().flatten().count()
    }

    fn header_line(
        &self,
        record: Option<&Record>,
        line: &mut String<MAX_LINE_BYTES>,
    ) -> fmt::Result {
        let period_s = record.map_or(0.0, |record| {
            record.scales.period_s() * f64::from(record.setup.every)
        });
        let names = self.columns();
        match self.header_lines_written {
            0 => write!(line, "# DIM = {names}"),
            1 => write!(line, "# NDATA = {}", self.rows),
            2 => write!(line, "# SAMPLE_TIME = {period_s}"),
            3 => write!(line, "# SEPARATOR = 32"),
            4 => write!(line, "# TYPE = 1"),
            at => match self.columns.get(at - 5).copied().flatten() {
                Some(channel) => write!(line, "# NAME{} = {channel}", at - 5),
                None => write!(line, "# END_HEADER"),
            },
        }
    }

    fn row_line(
        &mut self,
        record: Option<&Record>,
        recorder: &RecorderReader<'_>,
        machine: &MachineNow<'_>,
        line: &mut String<MAX_LINE_BYTES>,
    ) -> fmt::Result {
        let mut row = record.map(|record| RecordRow {
            words: &record.setup.signals,
            values: recorder.next(&record.setup, &mut self.cursor),
            scales: &record.scales,
            row: self.row,
            every: record.setup.every,
            machine,
            pose: None,
            drawn_pose: None,
        });
        self.row += 1;
        for (place, channel) in self.columns.iter().flatten().enumerate() {
            if place > 0 {
                line.write_str(" ")?;
            }
            let value = row.as_mut().map_or(f64::NAN, |row| row.value(*channel));
            if channel.is_whole() {
                write!(line, "{value}")?;
            } else {
                // Nine decimals: 1e-12 m, 1.7e-11 rad. What rounds to zero is not to be printed with a sign.
                let value = if value.abs() < 0.5e-9 { 0.0 } else { value };
                write!(line, "{value:.9}")?;
            }
        }
        Ok(())
    }
}

/// Lines of the head besides the names.
const HEADER_LINES: usize = 6;
