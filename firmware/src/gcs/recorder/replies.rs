//! Answers about the recorder that are a few lines.

use super::options::{OFF, OPTIONS, Source};
use super::trigger::TRIGGERS;
use super::{Desk, TableList};
use crate::gcs::reply::{Reply, one_line};
use crate::recorder::{RECORDER_TABLES, RecorderReader};
use embedded_io::Write;

impl Desk {
    /// `DRC?`
    pub(super) fn tell_channels<W: Write>(
        &self,
        tables: &TableList,
        out: &mut W,
    ) -> Result<(), W::Error> {
        let mut reply = Reply::new(out);
        for table in tables.iter() {
            let (source, option) = match self.tables[table].channel {
                Some(channel) => (channel.source, channel.option),
                None => (Source::Controller, OFF),
            };
            reply.line(format_args!("{}={source} {option}", table + 1))?;
        }
        reply.end()
    }

    /// `DRT?`
    pub(super) fn tell_triggers<W: Write>(
        &self,
        tables: &TableList,
        out: &mut W,
    ) -> Result<(), W::Error> {
        let mut reply = Reply::new(out);
        for table in tables.iter() {
            let trigger = self.tables[table].trigger;
            reply.line(format_args!("{}={trigger}", table + 1))?;
        }
        reply.end()
    }

    /// `DRL?`: nothing for a table that is not in the record.
    pub(super) fn tell_lengths<W: Write>(
        &self,
        tables: &TableList,
        recorder: &RecorderReader<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        let rows = self.progress(recorder).rows;
        let mut reply = Reply::new(out);
        for table in tables.iter() {
            let recorded = (self.record.as_ref()).and_then(|record| record.channels[table]);
            let rows = recorded.map_or(0, |_| rows);
            reply.line(format_args!("{}={rows}", table + 1))?;
        }
        reply.end()
    }

    /// `RTR?`
    pub(super) fn tell_rate<W: Write>(&self, out: &mut W) -> Result<(), W::Error> {
        one_line(out, format_args!("{}", self.every))
    }
}

/// `TNR?`
pub(super) fn tell_count<W: Write>(out: &mut W) -> Result<(), W::Error> {
    one_line(out, format_args!("{RECORDER_TABLES}"))
}

/// `HDR?`: in the sections by which clients find their way in it.
pub(super) fn tell_help<W: Write>(points: u32, out: &mut W) -> Result<(), W::Error> {
    let mut reply = Reply::new(out);
    reply.line(format_args!("#RecordOptions"))?;
    reply.line(format_args!("{OFF}=nothing is recorded"))?;
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
