//! Answers about the recorder that are a few lines.

use super::channel::{OPTION_OFF, OPTIONS, SignalSource};
use super::trigger::TRIGGERS;
use super::{RecorderState, TableList};
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::{ReplyWriter, one_line};
use crate::recorder::{RECORDER_TABLES, RecorderReader};

impl RecorderState {
    /// `DRC?`
    pub(super) fn reply_channels(
        &self,
        tables: &TableList,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for table in tables.iter() {
            let (source, option) = match self.tables[table].channel {
                Some(channel) => (channel.source, channel.option),
                None => (SignalSource::Controller, OPTION_OFF),
            };
            reply.line(format_args!("{}={source} {option}", table + 1))?;
        }
        reply.end()
    }

    /// `DRT?`
    pub(super) fn reply_triggers(
        &self,
        tables: &TableList,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for table in tables.iter() {
            let trigger = self.tables[table].trigger;
            reply.line(format_args!("{}={trigger}", table + 1))?;
        }
        reply.end()
    }

    /// `DRL?`: nothing for a table that is not in the record.
    pub(super) fn reply_lengths(
        &self,
        tables: &TableList,
        recorder: &RecorderReader<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let rows = self.progress(recorder).rows;
        let mut reply = ReplyWriter::new(out);
        for table in tables.iter() {
            let recorded = (self.record.as_ref()).and_then(|record| record.channels[table]);
            let rows = recorded.map_or(0, |_| rows);
            reply.line(format_args!("{}={rows}", table + 1))?;
        }
        reply.end()
    }

    /// `RTR?`
    pub(super) fn reply_rate(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        one_line(out, format_args!("{}", self.every))
    }
}

/// `TNR?`
pub(super) fn reply_count(out: &mut Output<'_>) -> Result<(), WriteFailed> {
    one_line(out, format_args!("{RECORDER_TABLES}"))
}

/// `HDR?`: in the sections by which clients find their way in it.
pub(super) fn reply_help(points: u32, out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    reply.line(format_args!("#RecordOptions"))?;
    reply.line(format_args!("{OPTION_OFF}=nothing is recorded"))?;
    for option in OPTIONS {
        let (number, name, detail) = (option.number, option.name, option.detail);
        reply.line(format_args!("{number}={name}{detail}"))?;
    }
    reply.line(format_args!("#TriggerOptions"))?;
    for (number, text) in TRIGGERS {
        reply.line(format_args!("{number}={text}"))?;
    }
    reply.line(format_args!("#Parameters to be set with SPA"))?;
    reply.line(format_args!("0x16000201=points of a record"))?;
    reply.line(format_args!("0x54500900=points before the trigger"))?;
    reply.line(format_args!("#Additional information"))?;
    reply.line(format_args!("{RECORDER_TABLES} record tables"))?;
    reply.line(format_args!("{points} datapoints per table"))?;
    reply.line(format_args!(
        "sources: X Y Z U V W axes of the platform in the base frame; 1 2 3 pivots; 0 controller"
    ))?;
    reply.line(format_args!("end of help"))?;
    reply.end()
}
