//! `TST?`: what the board reads about itself, and what the control loop knows of encoders and time, each with what it has to be.

use crate::control::LEAST_RESISTOR_DROP_V;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::ReplyWriter;
use crate::gcs::session::Session;
use crate::self_test::{Board, Reading};

/// Of an encoder at rest, rms, counts of 26 bits: a third of what `tripivot board` takes from its lowest reading to its highest. A
/// ring that is turned has more.
const MOST_NOISE: f64 = 6.0;
/// Drop that the brake resistor makes at most, V: with more than an ohm in its way the supply feeds nobody.
const MOST_RESISTOR_DROP_V: f64 = 6.0;

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

    /// What the control loop knows: encoders that can be used and their noise; the brake resistor; late ticks and the longest, since `LST`.
    fn loop_readings(&self, tell: &mut dyn FnMut(&Reading)) {
        let snapshot = self.commander.snapshot();
        let faults = snapshot.map_or([None; 3], |snapshot| snapshot.encoder_faults);
        for (name, fault) in ["ENCODER1", "ENCODER2", "ENCODER3"].into_iter().zip(faults) {
            tell(&Reading {
                name,
                value: f64::from(u8::from(fault.is_none())),
                unit: "",
                good: 1.0..=1.0,
            });
        }
        let noise = self.statistics.noise_counts();
        for (name, value) in ["NOISE1", "NOISE2", "NOISE3"].into_iter().zip(noise) {
            tell(&Reading {
                name,
                value,
                unit: "counts",
                good: 0.0..=MOST_NOISE,
            });
        }
        // None before the bridges have been awake.
        if let Some(drop_v) = snapshot.and_then(|snapshot| snapshot.resistor_drop_v) {
            tell(&Reading {
                name: "RESISTOR_DROP",
                value: f64::from(drop_v),
                unit: "V",
                good: rounded(LEAST_RESISTOR_DROP_V)..=MOST_RESISTOR_DROP_V,
            });
        }
        tell(&Reading {
            name: "LATE",
            value: f64::from(self.statistics.late),
            unit: "ticks",
            good: 0.0..=0.0,
        });
        if let Some(cycles) = self.board.and_then(Board::deadline_cycles) {
            tell(&Reading {
                name: "WORST_TICK",
                value: f64::from(self.statistics.cycles_worst),
                unit: "cycles",
                good: 0.0..=f64::from(cycles),
            });
        }
    }
}

/// Name, value, what it has to be, and whether it is.
fn reply_reading(reply: &mut ReplyWriter<'_>, reading: &Reading) -> Result<(), WriteFailed> {
    let (name, unit) = (reading.name, reading.unit);
    let value = rounded(reading.value);
    let (low, high) = (reading.good.start(), reading.good.end());
    let judged = if reading.is_good() { "ok" } else { "BAD" };
    let space = if unit.is_empty() { "" } else { " " };
    reply.line(format_args!(
        "{name}={value}{space}{unit}, {low} to {high}, {judged}"
    ))
}

/// More decimals tell nobody anything.
fn rounded(value: f64) -> f64 {
    libm::rint(value * 1e3) / 1e3
}
