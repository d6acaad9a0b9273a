//! Statistics of the loop, gathered from every snapshot: `LST?` tells them, `LST` starts them again.

use super::Panel;
use super::output::{Output, WriteFailed};
use super::reply::ReplyWriter;
use crate::control::config::UNITS_PER_RAD;
use crate::control::loop_counters::Interval;
use crate::queues::Snapshot;

/// Since the start or since `LST`; the peak of the following error since it was told.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Statistics {
    ticks: u64,
    cycles: u32,
    cycles_sum: u64,
    cycles_worst: u32,
    late: u32,
    peak_error: u32,
    commands: u32,
    refused: u32,
    /// Commands taken and refused up to the latest snapshot.
    counted: (u32, u32),
}

impl Statistics {
    /// Takes the next snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        let Interval {
            ticks,
            cycles,
            cycles_sum,
            cycles_worst,
            late,
            peak_error,
        } = snapshot.interval;
        self.ticks += u64::from(ticks);
        self.cycles = cycles;
        self.cycles_sum += u64::from(cycles_sum);
        self.cycles_worst = self.cycles_worst.max(cycles_worst);
        self.late = self.late.saturating_add(late);
        self.peak_error = self.peak_error.max(peak_error);
        let (commands, refused) = self.counted;
        self.commands = (self.commands).wrapping_add(snapshot.commands.wrapping_sub(commands));
        self.refused = (self.refused).wrapping_add(snapshot.refused.wrapping_sub(refused));
        self.counted = (snapshot.commands, snapshot.refused);
    }

    fn restart(&mut self) {
        *self = Self {
            counted: self.counted,
            ..Self::default()
        };
    }
}

impl Panel {
    /// `LST`
    pub(super) fn restart_statistics(&mut self) {
        self.statistics.restart();
    }

    /// Answers `LST?`.
    pub(super) fn reply_statistics(&mut self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
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
        reply.end()
    }
}
