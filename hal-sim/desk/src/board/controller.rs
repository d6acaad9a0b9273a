//! What the tests of the plan ask the controller.

use crate::line::Endpoint;
use crate::record::{Desk, RecordError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How often it is looked whether the stage has settled.
const LOOK_EVERY: Duration = Duration::from_millis(20);
/// Longest time for a motion of the plan, by the controller's clock.
const LONGEST_MOTION_S: f64 = 20.0;
/// How long one on an emulated chip may be silent: a second of it may take many of this machine, the more so where that is busy.
const EMULATED_PATIENCE: Duration = Duration::from_secs(60);

/// A controller that is tested.
pub(super) struct Controller {
    desk: Desk,
    /// Its seconds are not those of this machine.
    pub is_emulated: bool,
}

impl Controller {
    pub fn open(endpoint: &Endpoint, is_emulated: bool) -> Result<Self, RecordError> {
        let desk = if is_emulated {
            Desk::open_with(endpoint, EMULATED_PATIENCE)?
        } else {
            Desk::open(endpoint)?
        };
        Ok(Self { desk, is_emulated })
    }

    /// Who answers.
    pub fn identity(&self) -> &str {
        self.desk.identity()
    }

    /// The answer of a question.
    pub fn ask(&mut self, question: &str) -> Result<String, RecordError> {
        Ok(self.desk.ask(question)?.unwrap_or_default())
    }

    /// A line that is not to answer.
    pub fn carry_out(&mut self, line: &str) -> Result<(), RecordError> {
        self.desk.carry_out(line)
    }

    /// The error that a line is refused with; 0 if it is not.
    pub fn error_of(&mut self, line: &str) -> Result<u16, RecordError> {
        match self.desk.ask(line) {
            Ok(_) => Ok(0),
            Err(RecordError::Refused { code, .. }) => Ok(code),
            Err(error) => Err(error),
        }
    }

    /// The number behind `name=` in the answer of a question.
    pub fn field(&mut self, question: &str, name: &str) -> Result<f64, RecordError> {
        let answer = self.ask(question)?;
        let value = (answer.lines())
            .find_map(|line| line.strip_prefix(name)?.strip_prefix('='))
            .and_then(|value| value.split(' ').next()?.parse().ok());
        value.ok_or_else(|| RecordError::Strange {
            line: question.to_owned(),
            answer,
        })
    }

    /// Lets seconds of the controller's clock pass.
    pub fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.desk.delay(seconds)
    }

    /// Ticks in a second of the controller's clock.
    pub fn rate_hz(&mut self) -> Result<f64, RecordError> {
        Ok(1.0 / self.field("SPA? 1 0xE000200", "1 0xE000200")?)
    }

    /// Ticks in a second of this machine's clock, over a while.
    pub fn measured_rate_hz(&mut self, over: Duration) -> Result<f64, RecordError> {
        let (first, begin) = (self.tick()?, Instant::now());
        sleep(over);
        let (last, end) = (self.tick()?, Instant::now());
        Ok((last - first) / (end - begin).as_secs_f64())
    }

    /// The tick that the controller is at.
    pub fn tick(&mut self) -> Result<f64, RecordError> {
        self.field("MON?", "TICK")
    }

    /// Waits until the stage has settled: seconds of the controller's clock; `None` if it takes too long.
    pub fn settled(&mut self) -> Result<Option<f64>, RecordError> {
        let (begin, rate_hz) = (self.tick()?, self.rate_hz()?);
        loop {
            let passed_s = (self.tick()? - begin) / rate_hz;
            if self.field("ONT? X", "X")? == 1.0 {
                return Ok(Some(passed_s));
            }
            if passed_s > LONGEST_MOTION_S {
                return Ok(None);
            }
            sleep(LOOK_EVERY);
        }
    }
}
