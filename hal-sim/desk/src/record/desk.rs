//! The controller's end: lines that are carried out or refused, and waiting for the record.

use std::thread::sleep;
use std::time::{Duration, Instant};

use super::Record;
use super::{RecordError, answer};
use crate::line::{Endpoint, Line, PATIENCE};

/// How often the length of the record is asked for.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Longest time for which the controller is let alone without an answer.
const DELAY_MS: f64 = 500.0;

/// A controller that listens.
pub(crate) struct Desk {
    line: Line,
    place: String,
}

impl Desk {
    pub fn open(endpoint: &Endpoint) -> Result<Self, RecordError> {
        Self::open_with(endpoint, PATIENCE)
    }

    /// One that may be so slow.
    pub fn open_with(endpoint: &Endpoint, patience: Duration) -> Result<Self, RecordError> {
        let place = endpoint.to_string();
        match Line::open(endpoint, patience) {
            Ok(line) => Ok(Self { line, place }),
            Err(error) => Err(RecordError::Unreachable { place, error }),
        }
    }

    /// How long the controller may be silent in the middle of an answer.
    pub const fn set_patience(&mut self, patience: Duration) {
        self.line.set_patience(patience);
    }

    /// A line, and its answer if it has one.
    pub fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        let answer = self.line.ask(line).map_err(|error| RecordError::Broken {
            place: self.place.clone(),
            error,
        })?;
        match answer.error {
            // A stop has this error without having been refused.
            0 | 10 => Ok(answer.reply),
            code => Err(RecordError::Refused {
                line: line.to_owned(),
                code,
                hint: hint(line, code),
            }),
        }
    }

    /// Who answers.
    pub fn identity(&self) -> &str {
        self.line.identity()
    }

    /// A line that is not to answer.
    pub fn carry_out(&mut self, line: &str) -> Result<(), RecordError> {
        self.ask(line).map(|_| ())
    }

    /// Lets time pass, by the controller's clock: a simulated one may be slow.
    pub fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        let mut left_ms = seconds * 1e3;
        while left_ms > 0.0 {
            self.carry_out(&format!("DEL {}", left_ms.min(DELAY_MS).ceil()))?;
            left_ms -= DELAY_MS;
        }
        Ok(())
    }

    /// The number behind the last `=` of an answer.
    fn number(&mut self, line: &str) -> Result<f64, RecordError> {
        let answer = self.ask(line)?.unwrap_or_default();
        let number = answer
            .rsplit('=')
            .next()
            .and_then(|n| n.trim().parse().ok());
        number.ok_or_else(|| strange(line, &answer))
    }

    /// The value of a parameter.
    pub fn parameter(&mut self, id: &str) -> Result<f64, RecordError> {
        self.number(&format!("SPA? 1 {id}"))
    }

    /// Waits until so many points are recorded, and tells how many are meanwhile.
    pub fn wait(
        &mut self,
        points: usize,
        patience: Duration,
        tell: impl Fn(usize),
    ) -> Result<(), RecordError> {
        let end = Instant::now() + patience;
        loop {
            let rows = self.number("DRL? 1")? as usize;
            tell(rows);
            if rows >= points {
                return Ok(());
            }
            if Instant::now() > end {
                return Err(match rows {
                    0 => RecordError::NoTrigger(patience),
                    rows => RecordError::Slow {
                        rows,
                        points,
                        patience,
                    },
                });
            }
            sleep(LOOK_EVERY);
        }
    }

    /// Fetches rows, the first of which is counted from 1.
    pub fn fetch(
        &mut self,
        first: usize,
        rows: usize,
        record: &mut Record,
    ) -> Result<(), RecordError> {
        let line = format!("DRR? {first} {rows}");
        let answer = self.ask(&line)?.unwrap_or_default();
        let before = record.rows.len();
        let understood = answer::read(&answer, record);
        if understood.is_none() || record.rows.len() != before + rows {
            return Err(strange(&line, &answer));
        }
        Ok(())
    }
}

pub(crate) fn strange(line: &str, answer: &str) -> RecordError {
    RecordError::Strange {
        line: line.to_owned(),
        answer: answer.chars().take(60).collect(),
    }
}

/// What may help against a refusal.
pub(crate) fn hint(line: &str, code: u16) -> &'static str {
    match (line.get(..3), code) {
        (Some("DRC"), 15 | 58) => ": HDR? of the controller lists sources and options",
        (Some("DRT"), 17) => ": this signal cannot trigger",
        (Some("SPA"), 17) => {
            ": out of its range, or it does not go with the others (a record: more points than there is room\
             for, or none after the trigger)"
        }
        (Some("WPA"), 53) => ": settings can be kept while the stage is at rest",
        (Some("WPA"), 4001) => ": the flash does not take what is written",
        (Some("SPA"), 89) => ": this one needs the servo off (SVO X 0)",
        (Some("SPA"), 54) => ": this controller has no such parameter",
        (Some("SPA"), 53) => ": parameters can be set while the stage is at rest",
        (_, 2) => ": this controller has no data recorder, or does not know the command",
        (_, 5) => ": the stage is not referenced (FRF), or its servo is off",
        (_, 1024) => ": a fault is latched (FLT? tells it, FLC acknowledges it)",
        _ => "",
    }
}
