//! Writing long answers about records, some lines at each service.

use super::fault_record_readout::FaultRecordReadout;
use super::readout::{LINES_PER_SERVICE, MAX_LINE_BYTES, RecordReadout};
use super::replies;
use super::request::{RecordQuery, TableList};
use super::scales::MachineNow;
use super::state::RecorderState;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::session::Session;
use crate::queues::CommandQueues;
use crate::recorder::{RECORDER_TABLES, RecorderReader};
use heapless::String;

impl Interpreter {
    /// Answers a question about the recorder, or begins to.
    pub(in crate::gcs) fn reply_record(
        &mut self,
        query: RecordQuery,
        session: &mut Session,
        queues: &CommandQueues<'_>,
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
                match FaultRecordReadout::new(queues.retained_memory) {
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
        queues: &CommandQueues<'_>,
        out: &mut Output<'_>,
    ) -> Result<bool, WriteFailed> {
        let Some(readout) = &mut session.readout else {
            return Ok(false);
        };
        let machine = MachineNow {
            built: self.commander.built(),
            growth: self.commander.growth(),
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
            let line = readout.line(record, &queues.recorder, &machine);
            out.write_all(line.as_bytes())?;
            session.room = session.room.map(|room| room - line.len());
            if readout.left == 0 {
                session.readout = None;
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Writes some more of the fault record that a connection waits for, if it waits for one; whether it still does.
    pub(in crate::gcs) fn write_fault_record_readout(
        &self,
        session: &mut Session,
        queues: &CommandQueues<'_>,
        out: &mut Output<'_>,
    ) -> Result<bool, WriteFailed> {
        let (Some(readout), Some(retained_memory)) =
            (&mut session.fault_record_readout, queues.retained_memory)
        else {
            return Ok(false);
        };
        for _ in 0..LINES_PER_SERVICE {
            if session.room.is_some_and(|room| room < MAX_LINE_BYTES) {
                return Ok(true);
            }
            let mut line = String::new();
            if !readout.line(
                retained_memory,
                1.0 / self.parameters.limits.rate_hz,
                &mut line,
            ) {
                session.error = ErrorCode::NotRecorded;
            }
            out.write_all(line.as_bytes())?;
            session.room = session.room.map(|room| room - line.len());
            if readout.left == 0 {
                session.fault_record_readout = None;
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
        recorder: &RecorderReader<'_>,
    ) -> Result<RecordReadout, ErrorCode> {
        let progress = self.progress(recorder);
        let [first, rows] = span.unwrap_or([1, progress.rows]);
        let enough = first
            .checked_add(rows)
            .is_some_and(|end| end - 1 <= progress.rows);
        let (true, true, Some(record)) = (rows > 0, enough, &self.record) else {
            return Err(ErrorCode::NotRecorded);
        };
        let mut columns = [None; RECORDER_TABLES];
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
