//! `TST?`: what the board reads about itself, and what the control loop knows of encoders and time, each with what it has to be.

use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;
use crate::self_test::{Board, Reading};

/// Cycles of the core that encoder frames are whole before their tick, at least.
const LEAST_FRAME_MARGIN: f64 = 84.0;

impl Interpreter {
    /// The board that `TST?` asks.
    pub fn set_board(&mut self, board: &'static dyn Board) {
        self.board = Some(board);
    }

    /// Answers `TST?`; not with the servo on, when the bridges are awake.
    pub(in crate::gcs) fn reply_self_test(
        &self,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        if self.commander.is_held() {
            session.error = ErrorCode::NotAllowed;
            return Ok(());
        }
        let mut reply = ReplyWriter::new(out);
        let mut bad = 0;
        let name = self.board.map_or("unknown", Board::name);
        reply.line(format_args!("BOARD={name}"))?;
        let mut result = Ok(());
        let mut tell = |reading: &Reading| {
            bad += u32::from(!reading.is_good());
            if result.is_ok() {
                result = reply_reading(&mut reply, reading);
            }
        };
        if let Some(board) = self.board {
            board.readings(&mut tell);
        }
        self.loop_readings(&mut tell);
        result?;
        reply.line(format_args!("BAD={bad}"))?;
        reply.end()
    }

    /// What the control loop knows: encoders that can be used, when their frames were whole, and late ticks since `LST`.
    fn loop_readings(&self, tell: &mut dyn FnMut(&Reading)) {
        let faults =
            (self.commander.snapshot()).map_or([None; 3], |snapshot| snapshot.encoder_faults);
        for (name, fault) in ["ENCODER1", "ENCODER2", "ENCODER3"].into_iter().zip(faults) {
            tell(&Reading {
                name,
                value: f64::from(u8::from(fault.is_none())),
                unit: "",
                good: 1.0..=1.0,
            });
        }
        // Half a microsecond, since the core may have a long instruction under way when the latch is due. Only a chip counts it.
        if let Some(margin) = self.statistics.frame_margin_least {
            tell(&Reading {
                name: "FRAME_MARGIN",
                value: f64::from(margin),
                unit: "cycles",
                good: LEAST_FRAME_MARGIN..=f64::from(u16::MAX),
            });
        }
        tell(&Reading {
            name: "LATE",
            value: f64::from(self.statistics.late),
            unit: "ticks",
            good: 0.0..=0.0,
        });
    }
}

/// Name, value, what it has to be, and whether it is.
fn reply_reading(reply: &mut ReplyWriter<'_>, reading: &Reading) -> Result<(), WriteFailed> {
    let (name, value, unit) = (reading.name, reading.value, reading.unit);
    let (low, high) = (reading.good.start(), reading.good.end());
    let judged = if reading.is_good() { "ok" } else { "BAD" };
    let space = if unit.is_empty() { "" } else { " " };
    reply.line(format_args!(
        "{name}={value}{space}{unit}, {low} to {high}, {judged}"
    ))
}
