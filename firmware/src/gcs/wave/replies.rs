//! What queries about tables and generators answer.

use super::request::WaveQuery;
use crate::commander::wave::Waveforms;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::{ReplyWriter, one_line};

/// Answers a query; `running` says which generators run.
pub(in crate::gcs) fn reply_waves(
    waves: &Waveforms,
    query: WaveQuery,
    running: &[bool; 6],
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    match query {
        WaveQuery::Generators => one_line(out, format_args!("{}", waves.generators.len())),
        WaveQuery::Mask => {
            let bits = running
                .iter()
                .zip(0..)
                .map(|(&running, bit)| u8::from(running) << bit);
            one_line(out, format_args!("{:x}", bits.sum::<u8>()))
        }
        WaveQuery::Lengths(named) => {
            let mut reply = ReplyWriter::new(out);
            for (table, _) in wanted(&named) {
                reply.line(format_args!("{} 1={}", table + 1, waves.length(table)))?;
            }
            reply.end()
        }
        WaveQuery::Tables(named) => each(&named, out, |i| waves.generators[i].table.into()),
        WaveQuery::Cycles(named) => each(&named, out, |i| waves.generators[i].cycles),
        WaveQuery::Running(named) => each(&named, out, |i| running[i].into()),
        WaveQuery::Rates(named) => {
            let mut reply = ReplyWriter::new(out);
            for (generator, _) in wanted(&named) {
                reply.line(format_args!("{}={} 1", generator + 1, waves.ticks))?;
            }
            reply.end()
        }
    }
}

/// The places that are named; all when none is.
fn wanted(named: &[bool]) -> impl Iterator<Item = (usize, &bool)> {
    let all = !named.contains(&true);
    (named.iter().enumerate()).filter(move |&(_, &named)| named || all)
}

/// A line of each generator.
fn each(
    named: &[bool; 6],
    out: &mut Output<'_>,
    value: impl Fn(usize) -> u32,
) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for (generator, _) in wanted(named) {
        reply.line(format_args!("{}={}", generator + 1, value(generator)))?;
    }
    reply.end()
}
