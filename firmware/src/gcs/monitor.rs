//! `MON?`: what a client needs to draw the stage while it moves, in one answer.
//!
//! Pose and pivots are those of the base frame and of the platform's centre, whatever frame and centre of rotation are in
//! force. Following errors and duties change faster than anybody asks: told is the lowest and the highest since this
//! connection asked last, among the ticks that the panel has seen (on the host all of them).

use super::Panel;
use super::output::{Output, WriteFailed};
use super::reply::ReplyWriter;
use super::session::Session;
use crate::commander::axis::Axis;
use crate::control::config::UNITS_PER_RAD;
use crate::mode::Mode;
use crate::queues::Snapshot;

/// Urad in a unit of a pivot's following error.
const URAD_PER_UNIT: f32 = (1e6 / UNITS_PER_RAD) as f32;
/// Deg in a unit of an angle.
const DEG_PER_UNIT: f64 = 360.0 / 4_294_967_296.0;

/// The lowest and highest of one quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Range {
    lowest: i32,
    highest: i32,
}

impl Range {
    fn widen(&mut self, value: i32, first: bool) {
        if first || value < self.lowest {
            self.lowest = value;
        }
        if first || value > self.highest {
            self.highest = value;
        }
    }
}

/// What a connection has not been told yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Monitor {
    /// The tick looked at last.
    tick: u64,
    /// The next tick begins new ranges.
    starts_anew: bool,
    errors: [Range; 3],
    duties: [Range; 3],
}

impl Monitor {
    /// Takes what is known at a tick; the same one again changes nothing.
    pub fn update(&mut self, snapshot: &Snapshot) {
        if snapshot.tick == self.tick {
            return;
        }
        let first = self.starts_anew || self.tick == 0;
        self.tick = snapshot.tick;
        self.starts_anew = false;
        for i in 0..3 {
            self.errors[i].widen(snapshot.pivot_errors[i], first);
            self.duties[i].widen(snapshot.duty[i].0.into(), first);
        }
    }
}

impl Panel {
    /// Answers `MON?`.
    pub(super) fn reply_monitor(
        &self,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let snapshot = self.commander.snapshot().cloned().unwrap_or_default();
        let mut reply = ReplyWriter::new(out);
        reply.line(format_args!("TICK={}", snapshot.tick))?;
        reply.line(format_args!("MODE={}", mode_text(snapshot.mode)))?;
        let pose = self.commander.platform_pose();
        for axis in [Axis::X, Axis::Y, Axis::W] {
            reply.line(format_args!("{}={:.6}", axis.letter(), pose[axis.index()]))?;
        }
        for (number, pivot) in (1..).zip(snapshot.pivots) {
            let deg = pivot.units() as f64 * DEG_PER_UNIT;
            reply.line(format_args!("PIVOT{number}={deg:.6}"))?;
        }
        for (number, range) in (1..).zip(session.monitor.errors) {
            let [low, high] = [range.lowest, range.highest].map(|v| v as f32 * URAD_PER_UNIT);
            reply.line(format_args!("ERROR{number}={low:.3} {high:.3}"))?;
        }
        let counts = f32::from(self.parameters.drive.pwm_counts);
        for (number, range) in (1..).zip(session.monitor.duties) {
            let [low, high] = [range.lowest, range.highest].map(|v| v as f32 / counts);
            reply.line(format_args!("DUTY{number}={low:.5} {high:.5}"))?;
        }
        session.monitor.starts_anew = true;
        reply.end()
    }
}

const fn mode_text(mode: Mode) -> &'static str {
    match mode {
        Mode::Off => "off",
        Mode::Holding => "holding",
        Mode::Moving => "moving",
        Mode::Fault => "fault",
        Mode::Stopping => "stopping",
    }
}
