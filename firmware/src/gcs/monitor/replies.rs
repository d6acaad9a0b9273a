//! What `MON?` answers.

use crate::commander::axis::Axis;
use crate::control::units::UNITS_PER_RAD;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;
use crate::mode::Mode;

/// Urad in a unit of a pivot's following error.
const URAD_PER_UNIT: f32 = (1e6 / UNITS_PER_RAD) as f32;
/// Deg in a unit of an angle.
const DEG_PER_UNIT: f64 = 360.0 / 4_294_967_296.0;

impl Interpreter {
    /// Answers `MON?`.
    pub(in crate::gcs) fn reply_monitor(
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
        let counts = f32::from(self.parameters.power.pwm_counts);
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
        Mode::Exciting => "exciting",
    }
}
