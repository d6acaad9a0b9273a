//! Answering queries.

use super::interpreter::Interpreter;
use super::output::{Output, WriteFailed};
use super::parameter::{Parameter, loosened, parameter_help};
use super::reply_writer::{ReplyWriter, one_line};
use super::request::{Property, Query};
use super::session::Session;
use super::table::COMMANDS;
use crate::commander::Quantity;
use crate::commander::axis::{Axis, AxisSet, AxisValues, Coordinates};

/// What `CST?` answers.
const STAGE_TYPE: &str = "XYT-1";

/// Bit 16 of `#4`: referenced.
const STATUS_REFERENCED: u32 = 1 << 16;

impl Interpreter {
    /// Answers a query about the controller as a whole.
    pub(super) fn reply_query(
        &mut self,
        query: Query,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        match query {
            Query::Identity => one_line(
                out,
                format_args!(
                    "(c)2026 Tripivot, XYT-1 (C-887 compatible), {}, {}",
                    self.identity.serial, self.identity.version
                ),
            ),
            Query::Syntax => one_line(out, format_args!("2.0")),
            Query::Version => one_line(out, format_args!("FW: {}", self.identity.version)),
            Query::Serial => one_line(out, format_args!("{}", self.identity.serial)),
            Query::Help => help(out),
            Query::Axes => axes(out),
            Query::Error => {
                let error = core::mem::take(&mut session.error);
                one_line(out, format_args!("{}", error.number()))
            }
            Query::CycleTime => one_line(out, format_args!("T={}", self.commander.cycle_time_ms())),
            Query::Velocity => one_line(out, format_args!("{}", self.commander.velocity_mm_s())),
            Query::ParameterHelp => parameter_help(out),
            Query::Level => one_line(out, format_args!("{}", session.level)),
            Query::Commissioned => self.reply_commissioned(out),
            Query::SelfTest => self.reply_self_test(session, out),
            Query::Heartbeat => {
                let own = self.heartbeat.promised_ms(session.number);
                let ms = own.unwrap_or(self.parameters.supervision.host_silence_ms);
                one_line(out, format_args!("{ms}"))
            }
            Query::Approach => one_line(out, format_args!("{}", self.commander.approach_um())),
            Query::JogTime => one_line(out, format_args!("{}", session.jog_time_ms.unwrap_or(0.0))),
            Query::Ownership => self.reply_ownership(session, out),
            Query::Recovery => one_line(
                out,
                format_args!("{}", u8::from(self.commander.is_recovering())),
            ),
            Query::PiezoChannels => one_line(out, format_args!("0")),
            Query::Joysticks(named) => joysticks(named, out),
            Query::Events => self.reply_events(out),
            Query::Statistics => self.reply_statistics(out),
            Query::Calibration => self.reply_calibration(out),
            Query::Temperature => self.reply_temperature(out),
            Query::PositionAsDrawn => self.reply_position_as_drawn(out),
            Query::Excitation => self.reply_excitation(out),
            Query::RepeatedMoves => self.reply_repeated_moves(out),
            Query::Fault => self.reply_fault(out),
            Query::Monitor => self.reply_monitor(session, out),
            Query::Status => one_line(out, format_args!("{}", self.status())),
            Query::Moving => one_line(
                out,
                format_args!("{:x}", self.commander.moving_axes().mask()),
            ),
            Query::Changed => {
                let changed = self.commander.changed_since(session.reported_pivots);
                one_line(out, format_args!("{:x}", changed.mask()))
            }
            Query::Ready => {
                let ready = session.wait.is_none() && !self.commander.is_referencing();
                out.write_all(&[if ready { 0xB1 } else { 0xB0 }, b'\n'])
            }
        }
    }

    /// Answers a query about axes, a line each.
    pub(super) fn reply_quantity(
        &self,
        quantity: Quantity,
        axes: AxisSet,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        if quantity == Quantity::Position {
            // The direct kinematics once for all axes.
            let measured = self.commander.measured();
            for axis in axes.iter() {
                let value = without_minus_zero(measured[axis.index()]);
                reply.line(format_args!("{}={value:.9}", axis.letter()))?;
            }
        } else {
            for axis in axes.iter() {
                // As many digits as tell the number from its neighbours: what was commanded comes back the same.
                let value = self.commander.value(quantity, axis);
                reply.line(format_args!("{}={value}", axis.letter()))?;
            }
        }
        reply.end()
    }

    /// Answers a query about axes in words.
    pub(super) fn reply_property(
        &self,
        property: Property,
        axes: AxisSet,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for axis in axes.iter() {
            let text = match property {
                Property::Stage => STAGE_TYPE,
                Property::Unit => axis.unit(),
            };
            reply.line(format_args!("{}={text}", axis.letter()))?;
        }
        reply.end()
    }

    /// Answers `VMO?`.
    pub(super) fn reply_reachable(
        &self,
        values: &AxisValues,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        one_line(
            out,
            format_args!("{}", u8::from(self.commander.is_reachable(values))),
        )
    }

    fn status(&self) -> u32 {
        if self.commander.value(Quantity::Referenced, Axis::X) == 1.0 {
            STATUS_REFERENCED
        } else {
            0
        }
    }

    /// The latched fault; without one the encoders that cannot be used, which will be the next question.
    fn reply_fault(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let Some(snapshot) = self.commander.snapshot() else {
            return one_line(out, format_args!("0 no fault"));
        };
        if let Some(fault) = snapshot.fault {
            let mut reply = ReplyWriter::new(out);
            reply.line(format_args!("{fault}"))?;
            if let Some(worse) = snapshot.stop_ended_by {
                reply.line(format_args!("its stop was ended: {worse}"))?;
            }
            self.reply_about_parameters(&mut reply)?;
            return reply.end();
        }
        let mut reply = ReplyWriter::new(out);
        if snapshot.encoder_faults == [None; 3] {
            match self.start_cause {
                None => reply.line(format_args!("0 no fault"))?,
                Some(cause) => reply.line(format_args!("0 no fault, started by {cause}"))?,
            }
        }
        if let Some(reason) = self.not_commissioned() {
            reply.line(format_args!("{reason}"))?;
        }
        for (pivot, kind) in (1..).zip(snapshot.encoder_faults) {
            if let Some(kind) = kind {
                reply.line(format_args!("{}, pivot {pivot}", kind.text()))?;
            }
        }
        self.reply_about_parameters(&mut reply)?;
        reply.end()
    }

    /// A line for each threshold of supervision that is looser than the reference, and for each kept value that is not in force.
    fn reply_about_parameters(&self, reply: &mut ReplyWriter<'_>) -> Result<(), WriteFailed> {
        for (id, value) in &self.persistence.unusable {
            let Some(parameter) = Parameter::find(*id) else {
                continue;
            };
            let [lowest, highest] = parameter.range;
            reply.line(format_args!(
                "kept, not in force: 0x{id:X} = {value}, which may be {lowest} to {highest}"
            ))?;
        }
        for parameter in loosened(&self.parameters) {
            let (id, text) = (parameter.id, parameter.text);
            reply.line(format_args!("looser than the reference: 0x{id:X}, {text}"))?;
        }
        Ok(())
    }
}

/// Answers `TRA?`: where the axes that were named come to.
pub(super) fn reply_furthest_target(
    values: &AxisValues,
    end: &Coordinates,
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for axis in Axis::ALL {
        if values[axis.index()].is_some() {
            reply.line(format_args!("{}={}", axis.letter(), end[axis.index()]))?;
        }
    }
    reply.end()
}

fn help(out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    reply.line(format_args!("The following commands are available:"))?;
    for entry in COMMANDS {
        reply.line(format_args!("{} {}", entry.name, entry.help))?;
    }
    reply.line(format_args!("end of help"))?;
    reply.end()
}

fn axes(out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for axis in Axis::ALL {
        reply.line(format_args!("{}", axis.letter()))?;
    }
    reply.end()
}

/// None of them is there, so none is on.
fn joysticks(named: u8, out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for number in (0..u8::BITS).filter(|bit| named >> bit & 1 != 0) {
        reply.line(format_args!("{}=0", number + 1))?;
    }
    reply.end()
}

/// What rounds to zero at nine decimals is not to be printed with a sign.
fn without_minus_zero(value: f64) -> f64 {
    if value.abs() < 0.5e-9 { 0.0 } else { value }
}
