//! `DRR?`: an answer of any length, out of a connection that goes on meanwhile.
//!
//! The answer is a state of its session. Each service writes some more of it, line by line, as far as the output has room; single
//! bytes act and are answered between two lines, other connections are served as ever, and lines of this one wait.
//!
//! If another record takes the place of the one that is being read, the rest is answered as not a number, with an error: a
//! client counts the rows.

use super::options::{Channel, Row};
use super::{Desk, HistoryDump, Record, RecordQuery, TableList, replies};
use crate::gcs::Panel;
use crate::gcs::error::ErrorCode;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::session::Session;
use crate::queues::PanelLink;
use crate::recorder::{Cursor, PanelRecorder, TABLES};
use core::fmt::{self, Write as _};
use heapless::String;

/// Longest line: eight numbers.
pub(super) const LINE: usize = 384;
/// Lines that a service writes at most, so that other work is not kept waiting.
pub(super) const LINES: usize = 8;

/// What is left of an answer.
pub(in crate::gcs) struct Dump {
    /// The record.
    number: u32,
    columns: [Option<Channel>; TABLES],
    /// Lines of the head that are written.
    head: usize,
    cursor: Cursor,
    /// The next row, counted from that of the trigger.
    row: i64,
    rows: u32,
    left: u32,
}

impl Panel {
    /// Answers a question about the recorder, or begins to.
    pub(in crate::gcs) fn tell_record(
        &mut self,
        query: RecordQuery,
        session: &mut Session,
        link: &PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let desk = &self.desk;
        match query {
            RecordQuery::Channels(tables) => desk.tell_channels(&tables, out),
            RecordQuery::Triggers(tables) => desk.tell_triggers(&tables, out),
            RecordQuery::Rate => desk.tell_rate(out),
            RecordQuery::Lengths(tables) => desk.tell_lengths(&tables, &link.recorder, out),
            RecordQuery::History => {
                match HistoryDump::new(link.black_box) {
                    Ok(dump) => session.history = Some(dump),
                    Err(code) => session.error = code,
                }
                Ok(())
            }
            RecordQuery::Help => replies::tell_help(self.parameters.recorder.points, out),
            RecordQuery::Count => replies::tell_count(out),
            RecordQuery::Data(span, tables) => {
                match desk.dump(span, &tables, &link.recorder) {
                    Ok(dump) => session.dump = Some(dump),
                    Err(code) => session.error = code,
                }
                Ok(())
            }
        }
    }

    /// Writes some more of the answer that a connection waits for, if it waits for one; whether it still does.
    pub(in crate::gcs) fn carry_dump(
        &self,
        session: &mut Session,
        link: &PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<bool, WriteFailed> {
        let Some(dump) = &mut session.dump else {
            return Ok(false);
        };
        for _ in 0..LINES {
            if session.room.is_some_and(|room| room < LINE) {
                return Ok(true);
            }
            let record = self.desk.record.as_ref();
            let record = record.filter(|record| record.setup.number == dump.number);
            if record.is_none() {
                session.error = ErrorCode::NotRecorded;
            }
            let line = dump.line(record, &link.recorder);
            out.write_all(line.as_bytes())?;
            session.room = session.room.map(|room| room - line.len());
            if dump.left == 0 {
                session.dump = None;
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl Desk {
    fn dump(
        &self,
        span: Option<[u32; 2]>,
        tables: &TableList,
        recorder: &PanelRecorder<'_>,
    ) -> Result<Dump, ErrorCode> {
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
        Ok(Dump {
            number: record.setup.number,
            columns,
            head: 0,
            cursor: recorder.seek(&record.setup, first - 1),
            row: i64::from(first - 1) - i64::from(progress.before),
            rows,
            left: rows,
        })
    }
}

impl Dump {
    /// The next line, with its end.
    fn line(&mut self, record: Option<&Record>, recorder: &PanelRecorder<'_>) -> String<LINE> {
        let mut line = String::new();
        // The longest line fits; a longer one would be cut short, and counted all the same.
        if self.head < HEAD + self.columns() {
            let _ = self.head_line(record, &mut line);
            let _ = line.write_str(" \n");
            self.head += 1;
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

    fn head_line(&self, record: Option<&Record>, line: &mut String<LINE>) -> fmt::Result {
        let period_s = record.map_or(0.0, |record| {
            record.scales.period_s() * f64::from(record.setup.every)
        });
        let names = self.columns();
        match self.head {
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
        line: &mut String<LINE>,
    ) -> fmt::Result {
        let mut row = record.map(|record| Row {
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
const HEAD: usize = 6;
