//! Questions, excitations, moves and records, as the steps need them.
//!
//! | file | idea |
//! |---|---|
//! | `excitation` | excitations, and why they have ended |
//! | `motion` | the stage held, turning, moved and settled |
//! | `recorder` | records, and the recorder as the user has it |

mod excitation;
mod motion;
mod recorder;

pub(crate) use excitation::{BY_CURRENT, BY_TIME, BY_WAY, Ended};
pub(super) use motion::PEAK;
pub(super) use recorder::{ANGLE, CURRENT, DUTY, Recorded, SUPPLY};

use super::found::{CommissionError, fail};
use super::id;
use super::id::AXES;
use super::{Machine, Task};
use crate::record::RecordError;
use crate::record::desk::strange;
use firmware::control::servo::BorneLimits;
use firmware::gcs::{ErrorCode, PARAMETERS};
use firmware::parameters::Parameters;
use recorder::Recorder;

pub(super) type Answered<T> = Result<T, RecordError>;
type Result<T, E = CommissionError> = std::result::Result<T, E>;

/// Parameter: the control period.
const PERIOD: u32 = 0x0E00_0200;
/// What a controller answers that has no store.
const NO_STORE: u16 = ErrorCode::NotForStage.number();
pub(super) const LIMITS_NOT_BORNE: u16 = ErrorCode::LimitsNotBorne.number();
/// How often it is looked whether something has ended, s.
const LOOK_S: f64 = 0.02;

/// The machine as the steps see it.
pub(crate) struct Bench<'a> {
    machine: &'a mut dyn Machine,
    /// Control period.
    pub period_s: f64,
    /// Rows that a record has.
    points: usize,
    /// The recorder as the user has it, once records have been reserved.
    recorder: Option<Recorder>,
}

/// Limits that the drives bear, as parameters.
pub(super) const fn limits(borne: &BorneLimits) -> [(u32, f64); 3] {
    [
        (id::PIVOT_RATE, borne.rate_rad_s),
        (id::PIVOT_ACCELERATION, borne.acceleration_rad_s2),
        (id::FAULT_STOP, borne.stop_s),
    ]
}

impl<'a> Bench<'a> {
    pub fn new(machine: &'a mut dyn Machine) -> Answered<Self> {
        let mut bench = Self {
            machine,
            period_s: 0.0,
            points: 0,
            recorder: None,
        };
        bench.period_s = bench.parameter(PERIOD)?;
        Ok(bench)
    }

    /// The same, for whoever goes to places: those of the base frame, of the platform's own centre.
    pub fn in_base_frame(machine: &'a mut dyn Machine) -> Answered<Self> {
        let mut bench = Self::new(machine)?;
        let frames = bench.ask("KEN?")?;
        let mut names = frames.lines().filter_map(|line| line.split('=').next());
        if let Some(frame) = names.find(|name| *name != "ZERO") {
            return Err(RecordError::OtherFrame {
                frame: frame.to_owned(),
            });
        }
        let (r_mm, s_mm) = (bench.number("SPI? R", "R")?, bench.number("SPI? S", "S")?);
        if r_mm != 0.0 || s_mm != 0.0 {
            return Err(RecordError::OtherCentre { r_mm, s_mm });
        }
        Ok(bench)
    }

    /// A line, and its answer if it has one.
    pub fn answer(&mut self, line: &str) -> Answered<Option<String>> {
        self.machine.ask(line)
    }

    /// A line, and its answer.
    pub fn ask(&mut self, line: &str) -> Answered<String> {
        Ok(self.answer(line)?.unwrap_or_default())
    }

    /// See [`Machine::scale_periods`].
    pub fn scale_periods(&self) -> Option<u32> {
        self.machine.scale_periods()
    }

    pub fn delay(&mut self, seconds: f64) -> Answered<()> {
        self.machine.delay(seconds)
    }

    pub fn request(&mut self, task: Task) -> Answered<()> {
        self.machine.request(task)
    }

    /// The text behind `name=` in the answer of a question.
    fn text(&mut self, question: &str, name: &str) -> Answered<String> {
        let answer = self.ask(question)?;
        let found = (answer.lines()).find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
        match found {
            Some(text) => Ok(text.trim().to_owned()),
            None => Err(strange(question, &answer)),
        }
    }

    /// The first number behind `name=` in the answer of a question.
    pub fn number(&mut self, question: &str, name: &str) -> Answered<f64> {
        let text = self.text(question, name)?;
        let first = text.split([' ', ',']).next().unwrap_or_default();
        first.parse().map_err(|_| strange(question, &text))
    }

    /// The number that a question answers alone.
    pub fn number_of(&mut self, question: &str) -> Answered<f64> {
        let answer = self.ask(question)?;
        (answer.trim().parse()).map_err(|_| strange(question, &answer))
    }

    /// The value of a parameter.
    pub fn parameter(&mut self, id: u32) -> Answered<f64> {
        let id = format!("1 0x{id:X}");
        self.number(&format!("SPA? {id}"), &id)
    }

    /// A parameter as it is kept; one of a controller that keeps nothing is as it was.
    pub fn recall(&mut self, id: u32) -> Answered<()> {
        match self.ask(&format!("RPA 1 0x{id:X}")) {
            Err(RecordError::Refused { code, .. }) if code == NO_STORE => Ok(()),
            answer => answer.map(drop),
        }
    }

    /// All parameters as the controller has them.
    pub fn parameters(&mut self) -> Answered<Parameters> {
        let mut parameters = Parameters::REFERENCE;
        let mut settable: Vec<_> = (PARAMETERS.iter())
            .filter(|one| !one.is_read_only() && one.number(&parameters).is_some())
            .collect();
        // A number for all three pivots, which reads as the first one's, comes before those of each.
        settable.sort_by_key(|one| one.id);
        for one in settable {
            let value = self.parameter(one.id)?;
            one.set(value, &mut parameters)
                .map_err(|_| strange(&format!("SPA? 1 0x{:X}", one.id), &value.to_string()))?;
        }
        Ok(parameters)
    }

    /// Sets parameters, four in a line. Where the drives turn out to bear less than the limits of motion in force, those are lowered first.
    pub fn set(&mut self, values: &[(u32, f64)]) -> Answered<()> {
        for some in values.chunks(4) {
            self.ask_bearing(some, |bench| bench.set_line(some))?;
        }
        Ok(())
    }

    /// Says that the machine is commissioned.
    pub fn commission(&mut self) -> Answered<()> {
        self.ask_bearing(&[], |bench| bench.ask("CMS 1").map(drop))
    }

    /// Asks for what the drives may not bear with the limits of motion in force, which are lowered then; with these values among what is
    /// asked for.
    fn ask_bearing(
        &mut self,
        values: &[(u32, f64)],
        ask: impl Fn(&mut Self) -> Answered<()>,
    ) -> Answered<()> {
        match ask(self) {
            Err(RecordError::Refused { code, .. }) if code == LIMITS_NOT_BORNE => {
                self.lower_limits_for(values)?;
                ask(self)
            }
            answer => answer,
        }
    }

    fn set_line(&mut self, values: &[(u32, f64)]) -> Answered<()> {
        let settings: String = (values.iter())
            .map(|(id, value)| format!(" 1 0x{id:X} {value}"))
            .collect();
        self.ask(&format!("SPA{settings}")).map(drop)
    }

    fn lower_limits_for(&mut self, values: &[(u32, f64)]) -> Answered<()> {
        let mut parameters = self.parameters()?;
        for (id, value) in values {
            let one = PARAMETERS.iter().find(|one| one.id == *id);
            let set = one.map(|one| one.set(*value, &mut parameters));
            set.and_then(Result::ok)
                .ok_or_else(|| strange(&format!("SPA 1 0x{id:X}"), &value.to_string()))?;
        }
        self.set_line(&limits(&BorneLimits::new(&parameters)))
    }

    /// Measured angles of the pivots, rad, with their turns.
    pub fn pivots_rad(&mut self) -> Answered<[f64; AXES]> {
        let answer = self.ask("MON?")?;
        let angle = |number: usize| {
            let name = format!("PIVOT{number}=");
            let text = answer.lines().find_map(|line| line.strip_prefix(&name));
            text.and_then(|text| text.trim().parse::<f64>().ok())
                .map(f64::to_radians)
        };
        match [angle(1), angle(2), angle(3)] {
            [Some(one), Some(two), Some(three)] => Ok([one, two, three]),
            _ => Err(strange("MON?", &answer)),
        }
    }

    /// The controller's clock, s.
    pub fn clock_s(&mut self) -> Answered<f64> {
        Ok(self.number("MON?", "TICK")? * self.period_s)
    }

    /// The latched fault, behind a colon.
    pub fn fault(&mut self) -> Answered<String> {
        // A fault that comes while it is asked for is the error of the question.
        let fault = match self.ask("FLT?") {
            Err(RecordError::Refused { .. }) => self.ask("FLT?")?,
            answer => answer?,
        };
        let fault = fault.trim();
        Ok(if fault.starts_with("0 ") {
            String::new()
        } else {
            format!(": {fault}")
        })
    }

    /// Whether a fault is latched.
    pub fn is_faulted(&mut self) -> Answered<bool> {
        Ok(!self.fault()?.is_empty())
    }

    /// After a fault: it is forgotten, and parameters may be set.
    pub fn clear_fault(&mut self) -> Answered<()> {
        self.delay(0.3)?;
        self.ask("FLC")?;
        self.delay(0.1)
    }

    /// Motors off, and what is kept in force again.
    ///
    /// # Errors
    /// What was refused of that: nothing drives then, and what the steps have set is in force.
    pub fn give_up(&mut self) -> Answered<()> {
        self.ask("STP")?;
        self.ask("SVO X 0")?;
        self.delay(0.5)?;
        self.ask("FLC")?;
        self.delay(0.1)?;
        self.ask("CMS 0")?;
        self.ask("RPA")?;
        Ok(())
    }
}

/// The mean of some values.
pub(super) fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
