//! Questions, excitations and records, as the steps need them.

use super::found::{CommissionError, fail};
use super::id;
use super::id::AXES;
use super::{Aside, Machine, Task};
use crate::record::desk::strange;
use crate::record::{Record, RecordError, TABLES, answer};
use commissioning::record::Signals;
use firmware::control::servo::BorneLimits;
use firmware::gcs::{ErrorCode, PARAMETERS};
use firmware::parameters::Parameters;

pub(super) type Answered<T> = Result<T, RecordError>;
type Result<T, E = CommissionError> = std::result::Result<T, E>;

/// Rows that are fetched at a time.
const ROWS: usize = 256;
/// Longest time that a stage is given to settle, s.
const SETTLING_S: f64 = 5.0;
/// Duty, current and angle of a pivot, as `DRC` takes them.
pub(super) const DUTY: &str = "73";
pub(super) const CURRENT: &str = "200";
pub(super) const ANGLE: &str = "2";
const OF_PIVOT: [&str; 3] = [DUTY, CURRENT, ANGLE];
pub(super) const SUPPLY: &str = "0 201";
/// Parameters: a record's points, those before its trigger, and the control period.
const POINTS: u32 = 0x1600_0201;
const BEFORE: u32 = 0x5450_0900;
const PERIOD: u32 = 0x0E00_0200;
/// What a controller answers that has no store.
const NO_STORE: u16 = ErrorCode::NotForStage.number();
pub(super) const LIMITS_NOT_BORNE: u16 = ErrorCode::LimitsNotBorne.number();
/// Longest time for which the platform turns without being asked again: more than any step takes, with records over a slow line.
const TURNING_MS: u32 = 600_000;
/// Longest time after which an excitation is over that should be, s.
const EXCITATION_END_S: f64 = 4.0;
/// Time after a move in which a stage settles that does, s.
const STAY_S: f64 = 1.0;
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

/// What of the recorder is the user's: the rows of a record, and what its tables record, as `DRC?` tells it.
struct Recorder {
    points: Aside,
    tables: String,
}

/// How an excitation has ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ended {
    /// Why: [`BY_TIME`], [`BY_WAY`], [`BY_CURRENT`], or that it was stopped.
    pub by: String,
    /// Seconds that it took.
    pub seconds: f64,
}

/// It came to its end, or a guard on way or current ended it, as `EXC?` says.
pub(crate) const BY_TIME: &str = "time";
pub(crate) const BY_WAY: &str = "way";
pub(crate) const BY_CURRENT: &str = "current";

/// Limits that the drives bear, as parameters.
pub(super) const fn limits(borne: &BorneLimits) -> [(u32, f64); 3] {
    [
        (id::PIVOT_RATE, borne.rate_rad_s),
        (id::PIVOT_ACCELERATION, borne.acceleration_rad_s2),
        (id::FAULT_STOP, borne.stop_s),
    ]
}

/// A record of a pivot.
pub(crate) struct Recorded {
    /// Volts, currents and angles.
    pub signals: Signals,
    /// Mean supply, V.
    pub supply_v: f64,
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

    /// The stage is held where it is.
    pub fn hold(&mut self) -> Result<()> {
        self.ask("FRF")?;
        self.settle()?;
        Ok(())
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

    /// The platform turns at a steady rate, rad/s, until something else is asked for; with nobody there any more, for as long as
    /// [`TURNING_MS`] on a serial line, which does not tell that somebody is gone.
    pub fn turn(&mut self, rate_rad_s: f64) -> Answered<()> {
        self.ask(&format!("JTM {TURNING_MS}"))?;
        self.ask(&format!("JOG W {}", rate_rad_s.to_degrees()))?;
        Ok(())
    }

    /// An excitation, to its end.
    pub fn excite(&mut self, line: &str, seconds: f64) -> Result<Ended> {
        self.ask(line)?;
        self.delay(seconds)?;
        self.excitation_end()
    }

    /// Waits until the excitation under way is over.
    pub fn excitation_end(&mut self) -> Result<Ended> {
        self.excitation_end_within(EXCITATION_END_S)
    }

    /// The same of one that may go on for so long.
    pub fn excitation_end_within(&mut self, seconds: f64) -> Result<Ended> {
        let looks = (seconds / LOOK_S).ceil() as usize;
        for _ in 0..looks {
            if self.number("EXC?", "RUNS")? == 0.0 {
                let by = self.text("EXC?", "END")?;
                if by == "fault" {
                    let fault = self.fault()?;
                    return fail(
                        format!("a fault has ended an excitation{fault}"),
                        "something moves that should not: look at wires and encoders before the next try",
                    );
                }
                let seconds = self.number("EXC?", "TICKS")? * self.period_s;
                return Ok(Ended { by, seconds });
            }
            self.delay(LOOK_S)?;
        }
        fail("an excitation does not end", "STP ends it")
    }

    /// Waits until the stage has settled after the reference: how long it took, s.
    pub fn settle(&mut self) -> Result<f64> {
        let start = self.clock_s()?;
        self.wait_for_target(SETTLING_S)?;
        Ok(self.clock_s()? - start)
    }

    /// Waits until a move is over and the stage has settled.
    pub fn wait_for_target(&mut self, seconds: f64) -> Result<()> {
        if self.settles_within(seconds)? {
            return Ok(());
        }
        let fault = self.fault()?;
        fail(
            format!("a move has not come to its end in {seconds} s{fault}"),
            "something rubs or gives way, or the gains are far from this machine's; EVT? tells more",
        )
    }

    /// Waits until a move is over and the stage has settled, so long at most, or until a fault: whether it has.
    pub fn settles_within(&mut self, seconds: f64) -> Result<bool> {
        let end = self.clock_s()? + seconds;
        while self.number("ONT? X", "X")? != 1.0 {
            let fault = self.fault()?;
            if !fault.is_empty() || self.clock_s()? > end {
                return Ok(false);
            }
            self.delay(LOOK_S)?;
        }
        Ok(true)
    }

    /// Waits until the stage has settled. One that stays some counts off is good enough, as long as it stays.
    pub fn stay(&mut self) -> Result<()> {
        if !self.settles_within(STAY_S)? && self.is_faulted()? {
            return self.wait_for_target(0.0);
        }
        Ok(())
    }

    /// Moves one after the other, each within so many seconds: the largest following error of a pivot, rad.
    pub fn follow(&mut self, moves: &[&str], seconds: f64) -> Result<f64> {
        self.number("LST?", PEAK)?;
        for line in moves {
            self.ask(line)?;
            self.wait_for_target(seconds)?;
        }
        Ok(self.number("LST?", PEAK)?)
    }

    /// The same at a share of the speed, which is as before afterwards, whatever came of the moves: no `RPA` brings it back.
    pub fn follow_slowly(&mut self, share: f64, moves: &[&str], seconds: f64) -> Result<f64> {
        let full = self.number_of("VLS?")?;
        self.ask(&format!("VLS {}", full * share))?;
        let followed = self.follow(moves, seconds);
        let given_back = self.ask(&format!("VLS {full}"));
        let largest_rad = followed?;
        given_back?;
        Ok(largest_rad)
    }

    /// Gives records so many rows: not in motion. Records that are shorter may then be made in motion.
    pub fn reserve(&mut self, rows: usize) -> Answered<()> {
        let values = [(POINTS, rows as f64), (BEFORE, 0.0)];
        if self.recorder.is_some() {
            self.clear_tables()?;
            self.set(&values)?;
        } else {
            let tables = self.ask("DRC?")?;
            self.clear_tables()?;
            let points = Aside::set(self, &values)?;
            self.recorder = Some(Recorder { points, tables });
        }
        self.points = rows;
        Ok(())
    }

    /// The recorder is the user's again: not in motion.
    pub fn give_back_recorder(&mut self) -> Answered<()> {
        let Some(Recorder { points, tables }) = self.recorder.take() else {
            return Ok(());
        };
        self.clear_tables()?;
        points.give_back(self)?;
        for table in tables.lines() {
            self.ask(&format!("DRC {}", table.trim().replace('=', " ")))?;
        }
        self.points = 0;
        Ok(())
    }

    /// Fewer tables leave room for more rows.
    fn clear_tables(&mut self) -> Answered<()> {
        (1..=TABLES).try_for_each(|table| self.ask(&format!("DRC {table} 0 0")).map(drop))
    }

    /// A record of a pivot while a line is carried out: every tick, or less often.
    pub fn record(
        &mut self,
        pivot: usize,
        rows: usize,
        every: usize,
        line: Option<&str>,
    ) -> Answered<Recorded> {
        let mut tables = vec![SUPPLY.to_owned()];
        tables.extend(OF_PIVOT.map(|option| format!("{} {option}", pivot + 1)));
        let record = self.record_tables(&tables, rows, every, line)?;
        let column = |at: usize| record.rows.iter().map(move |row| row[at]);
        let volts = column(1).zip(column(0));
        Ok(Recorded {
            signals: Signals {
                volts: volts.map(|(duty, supply_v)| duty * supply_v).collect(),
                current_a: column(2).collect(),
                angle_rad: column(3).map(f64::to_radians).collect(),
            },
            supply_v: column(0).sum::<f64>() / rows as f64,
        })
    }

    /// Currents and angles of all pivots, while a line is carried out: for volts there is no room.
    pub fn record_all(
        &mut self,
        rows: usize,
        every: usize,
        line: &str,
    ) -> Answered<[Signals; AXES]> {
        let tables: Vec<_> = (1..=AXES)
            .flat_map(|pivot| [CURRENT, ANGLE].map(|option| format!("{pivot} {option}")))
            .collect();
        let record = self.record_tables(&tables, rows, every, Some(line))?;
        let column = |at: usize| record.rows.iter().map(move |row| row[at]);
        Ok(std::array::from_fn(|pivot| Signals {
            volts: vec![0.0; rows],
            current_a: column(2 * pivot).collect(),
            angle_rad: column(2 * pivot + 1).map(f64::to_radians).collect(),
        }))
    }

    /// A record of tables, as `DRC` takes them, while a line is carried out.
    pub fn record_tables(
        &mut self,
        tables: &[String],
        rows: usize,
        every: usize,
        line: Option<&str>,
    ) -> Answered<Record> {
        if self.points < rows {
            self.reserve(rows)?;
        }
        let nothing = "0 0".to_owned();
        let tables = tables.iter().chain(std::iter::repeat(&nothing));
        for (number, table) in (1..=TABLES).zip(tables) {
            self.ask(&format!("DRC {number} {table}"))?;
        }
        self.ask(&format!("RTR {every}"))?;
        self.ask("DRT 0 0 0")?;
        match line {
            Some(line) => {
                self.ask("DRT 0 2 0")?;
                self.ask(line)?;
            }
            None => {
                self.ask("DRT 0 4 0")?;
            }
        }
        self.delay((rows * every) as f64 * self.period_s)?;
        for _ in 0..50 {
            if self.number("DRL? 1", "1")? >= rows as f64 {
                break;
            }
            self.delay(LOOK_S)?;
        }
        self.fetch(rows)
    }

    /// The rows of the record.
    fn fetch(&mut self, rows: usize) -> Answered<Record> {
        let mut record = Record::default();
        while record.rows.len() < rows {
            let done = record.rows.len();
            let question = format!("DRR? {} {}", done + 1, ROWS.min(rows - done));
            let text = self.ask(&question)?;
            if answer::read(&text, &mut record).is_none() || record.rows.len() <= done {
                return Err(strange(&question, &text));
            }
        }
        Ok(record)
    }
}

/// The mean of some values.
pub(super) fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// What `LST?` tells of following errors since it was asked last.
pub(super) const PEAK: &str = "PEAK_ERROR_RAD";
