//! What is told of the calibration.

use super::execute::CALIBRATED_WITHIN_K;
use crate::commander::axis::Axis;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;

impl Interpreter {
    /// `CAL?`: whether there is one and whether it counts; whose, of which day, at which temperature, and its checksum.
    pub(in crate::gcs) fn reply_calibration(
        &self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let Some(machine) = self.commander.calibration() else {
            reply.line(format_args!("STATE=NONE"))?;
            return reply.end();
        };
        let state = if machine.is_on { "ON" } else { "OFF" };
        reply.line(format_args!("STATE={state}"))?;
        reply.line(format_args!("SERIAL={}", machine.serial))?;
        reply.line(format_args!("DATE={}", machine.date))?;
        match machine.temperature_c {
            Some(celsius) => reply.line(format_args!("TEMPERATURE={celsius}"))?,
            None => reply.line(format_args!("TEMPERATURE=UNKNOWN"))?,
        }
        reply.line(format_args!("CHECKSUM={}", machine.checksum()))?;
        reply.end()
    }

    /// `TMP?`: the temperature that was told, how much the machine grows, by how much it is warmer than when it was calibrated, and whether
    /// that is what the calibration holds for.
    pub(in crate::gcs) fn reply_temperature(
        &self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        match self.commander.temperature_c() {
            Some(celsius) => reply.line(format_args!("TEMPERATURE={celsius}"))?,
            None => reply.line(format_args!("TEMPERATURE=UNKNOWN"))?,
        }
        let growth_ppm_per_k = self.commander.growth_ppm_per_k();
        reply.line(format_args!("GROWTH={growth_ppm_per_k}"))?;
        let Some(over_k) = self.commander.over_calibrated_k() else {
            reply.line(format_args!("STATE=UNKNOWN"))?;
            return reply.end();
        };
        reply.line(format_args!("OVER={over_k:.3}"))?;
        let is_off = over_k.abs() > CALIBRATED_WITHIN_K;
        let state = if is_off { "OFF" } else { "CALIBRATED" };
        reply.line(format_args!("STATE={state}"))?;
        reply.end()
    }

    /// `CAL POS?`: what `POS?` would answer without it.
    pub(in crate::gcs) fn reply_position_as_drawn(
        &self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let measured = self.commander.measured_as_drawn();
        for axis in Axis::ALL {
            let value = measured[axis.index()];
            reply.line(format_args!("{}={value:.9}", axis.letter()))?;
        }
        reply.end()
    }
}
