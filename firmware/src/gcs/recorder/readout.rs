//! `DRR?`: an answer of any length, out of a connection that goes on meanwhile.
//!
//! The answer is a state of its session. Each service writes some more of it, line by line, as far as the output has room; single
//! bytes act and are answered between two lines, other connections are served as ever, and lines of this one wait.
//!
//! If another record takes the place of the one that is being read, the rest is answered as not a number, with an error: a
//! client counts the rows.

use super::options::{Channel, RecordRow};
use super::{FaultRecordReadout, Record, RecordQuery, RecorderState, TableList, replies};
use crate::gcs::Panel;
use crate::gcs::error::ErrorCode;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::session::Session;
use crate::queues::PanelLink;
use crate::recorder::{Cursor, PanelRecorder, TABLES};
use core::fmt::{self, Write as _};
use heapless::String;

/// Longest line: eight numbers.
pub(super) const MAX_LINE_BYTES: usize = 384;
/// Lines that a service writes at most, so that other work is not kept waiting.
pub(super) const LINES_PER_SERVICE: usize = 8;

/// What is left of an answer.
pub(in crate::gcs) struct RecordReadout {
    /// The record.
    number: u32,
    columns: [Option<Channel>; TABLES],
    /// Lines of the head that are written.
    header_lines_written: usize,
    cursor: Cursor,
    /// The next row, counted from that of the trigger.
    row: i64,
    rows: u32,
    left: u32,
}

impl Panel {
    /// Answers a question about the recorder, or begins to.
    pub(in crate::gcs) fn reply_record(
        &mut self,
        query: RecordQuery,
        session: &mut Session,
        queues: &PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let recorder_state = &self.recorder_state;
        match query {
            RecordQuery::Channels(tables) => recorder_state.reply_channels(&tables, out),
            RecordQuery::Triggers(tables) => recorder_state.reply_triggers(&tables, out),
            RecordQuery::Rate => recorder_state.reply_rate(out),
            RecordQuery::Lengths(tables) => {
                recorder_state.reply_lengths(&tables, &queues.recorder, out)
            }
            RecordQuery::FaultRecord => {
                match FaultRecordReadout::new(queues.black_box) {
                    Ok(readout) => session.fault_record_readout = Some(readout),
                    Err(code) => session.error = code,
                }
                Ok(())
            }
            RecordQuery::Help => replies::reply_help(self.parameters.recorder.points, out),
            RecordQuery::Count => replies::reply_count(out),
            RecordQuery::Data(span, tables) => {
                match recorder_state.begin_readout(span, &tables, &queues.recorder) {
                    Ok(readout) => session.readout = Some(readout),
                    Err(code) => session.error = code,
                }
                Ok(())
            }
        }
    }

    /// Writes some more of the answer that a connection waits for, if it waits for one; whether it still does.
    pub(in crate::gcs) fn write_readout(
        &self,
        session: &mut Session,
        queues: &PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<bool, WriteFailed> {
        let Some(readout) = &mut session.readout else {
            return Ok(false);
        };
        for _ in 0..LINES_PER_SERVICE {
            if session.room.is_some_and(|room| room < MAX_LINE_BYTES) {
                return Ok(true);
            }
            let record = self.recorder_state.record.as_ref();
            let record = record.filter(|record| record.setup.number == readout.number);
            if record.is_none() {
                session.error = ErrorCode::NotRecorded;
            }
            let line = readout.line(record, &queues.recorder);
            out.write_all(line.as_bytes())?;
            session.room = session.room.map(|room| room - line.len());
            if readout.left == 0 {
                session.readout = None;
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl RecorderState {
    fn begin_readout(
        &self,
        span: Option<[u32; 2]>,
        tables: &TableList,
        recorder: &PanelRecorder<'_>,
    ) -> Result<RecordReadout, ErrorCode> {
        let progress = self.progress(recorder);
        let [first, rows] = span.unwrap_or([1, progress.rows]);
        let enough = first
            .checked_add(rows)
            .is_some_and(|end| end - 1 <= progress.rows);
        let (true, true, Some(record)) = (rows > 0, enough, &self.record) else {
            return Err(ErrorCode::NotRecorded);
        };
        let mut columns = [None; TABLES];
        let recorded = tables.iter().map(|table| record.channels[table]);
        if tables.is_empty() {
            for (column, channel) in columns.iter_mut().zip(recorded.flatten()) {
                *column = Some(channel);
            }
        } else {
            for (column, channel) in columns.iter_mut().zip(recorded) {
                *column = Some(channel.ok_or(ErrorCode::TableOff)?);
            }
        }
        Ok(RecordReadout {
            number: record.setup.number,
            columns,
            header_lines_written: 0,
            cursor: recorder.seek(&record.setup, first - 1),
            row: i64::from(first - 1) - i64::from(progress.before),
            rows,
            left: rows,
        })
    }
}

impl RecordReadout {
    /// The next line, with its end.
    fn line(
        &mut self,
        record: Option<&Record>,
        recorder: &PanelRecorder<'_>,
    ) -> String<MAX_LINE_BYTES> {
        let mut line = String::new();
        // The longest line fits; a longer one would be cut short, and counted all the same.
        if self.header_lines_written < HEADER_LINES + self.columns() {
            let _ = self.header_line(record, &mut line);
            let _ = line.write_str(" \n");
            self.header_lines_written += 1;
        } else {
            let _ = self.row_line(record, recorder, &mut line);
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
        recorder: &PanelRecorder<'_>,
        line: &mut String<MAX_LINE_BYTES>,
    ) -> fmt::Result {
        let mut row = record.map(|record| RecordRow {
            words: &record.setup.words,
            values: recorder.next(&record.setup, &mut self.cursor),
            scales: &record.scales,
            row: self.row,
            every: record.setup.every,
            pose: None,
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
