//! Questions, excitations and records, as the steps need them.

use super::Machine;
use super::found::{CommissionError, fail};
use super::known::AXES;
use crate::record::answer;
use crate::record::{Record, RecordError};
use commissioning::record::Signals;

type Result<T> = std::result::Result<T, CommissionError>;

/// Rows that are fetched at a time.
const ROWS: usize = 256;
/// Longest time that a stage is given to settle, s.
const SETTLING_S: f64 = 5.0;
/// Volts, current and angle of a pivot, as `DRC` takes them.
const OF_PIVOT: [&str; 3] = ["73", "200", "2"];
const SUPPLY: &str = "0 201";
/// Parameter with a record's points, and the one with those before its trigger.
const POINTS: &str = "0x16000201";
const BEFORE: &str = "0x54500900";

/// The machine as the steps see it.
pub(super) struct Bench<'a> {
    machine: &'a mut dyn Machine,
    /// Rows that a record has.
    points: usize,
}

/// How an excitation has ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ended {
    /// Why: `time`, `way`, `current`.
    pub by: String,
    /// Seconds that it took.
    pub seconds: f64,
}

impl<'a> Bench<'a> {
    pub fn new(machine: &'a mut dyn Machine) -> Self {
        Self { machine, points: 0 }
    }

    /// A line, and its answer.
    pub fn ask(&mut self, line: &str) -> Result<String> {
        Ok(self.machine.ask(line)?.unwrap_or_default())
    }

    pub fn delay(&mut self, seconds: f64) -> Result<()> {
        Ok(self.machine.delay(seconds)?)
    }

    pub fn request(&mut self, task: super::Task) -> Result<()> {
        Ok(self.machine.request(task)?)
    }

    /// The text behind `name=` in the answer of a question.
    pub fn text(&mut self, question: &str, name: &str) -> Result<String> {
        let answer = self.ask(question)?;
        let found = (answer.lines()).find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
        match found {
            Some(text) => Ok(text.trim().to_owned()),
            None => Err(CommissionError::Controller(RecordError::Strange {
                line: question.to_owned(),
                answer,
            })),
        }
    }

    /// The first number behind `name=` in the answer of a question.
    pub fn number(&mut self, question: &str, name: &str) -> Result<f64> {
        let text = self.text(question, name)?;
        let first = text.split([' ', ',']).next().unwrap_or_default();
        first.parse().map_err(|_| {
            CommissionError::Controller(RecordError::Strange {
                line: question.to_owned(),
                answer: text.clone(),
            })
        })
    }

    /// The value of a parameter.
    pub fn parameter(&mut self, id: u32) -> Result<f64> {
        let id = format!("1 0x{id:X}");
        self.number(&format!("SPA? {id}"), &id)
    }

    /// Sets parameters, four in a line.
    pub fn set(&mut self, values: &[(u32, f64)]) -> Result<()> {
        for some in values.chunks(4) {
            let settings: String = some
                .iter()
                .map(|(id, value)| format!(" 1 0x{id:X} {value}"))
                .collect();
            self.ask(&format!("SPA{settings}"))?;
        }
        Ok(())
    }

    /// Measured angles of the pivots, rad, with their turns.
    pub fn pivots_rad(&mut self) -> Result<[f64; AXES]> {
        let answer = self.ask("MON?")?;
        let angle = |number: usize| {
            let name = format!("PIVOT{number}=");
            let text = answer.lines().find_map(|line| line.strip_prefix(&name));
            text.and_then(|text| text.trim().parse::<f64>().ok())
                .map(f64::to_radians)
        };
        match [angle(1), angle(2), angle(3)] {
            [Some(one), Some(two), Some(three)] => Ok([one, two, three]),
            _ => Err(CommissionError::Controller(RecordError::Strange {
                line: "MON?".to_owned(),
                answer,
            })),
        }
    }

    /// The controller's clock, s.
    pub fn clock_s(&mut self) -> std::result::Result<f64, RecordError> {
        let tick = self.number("MON?", "TICK");
        let period = self.parameter(0x0E00_0200);
        match (tick, period) {
            (Ok(tick), Ok(period_s)) => Ok(tick * period_s),
            (Err(CommissionError::Controller(error)), _)
            | (_, Err(CommissionError::Controller(error))) => Err(error),
            _ => Ok(0.0),
        }
    }

    /// The latched fault, behind a colon.
    pub fn fault(&mut self) -> std::result::Result<String, RecordError> {
        // A fault that comes while it is asked for is the error of the question.
        let fault = match self.machine.ask("FLT?") {
            Err(RecordError::Refused { .. }) => self.machine.ask("FLT?")?,
            answer => answer?,
        };
        let fault = fault.unwrap_or_default();
        let fault = fault.trim();
        Ok(if fault.is_empty() || fault.starts_with("0 ") {
            String::new()
        } else {
            format!(": {fault}")
        })
    }

    /// Motors off, and what is kept in force again.
    pub fn give_up(&mut self) -> std::result::Result<(), RecordError> {
        for line in ["STP", "SVO X 0", "FLC"] {
            let _ = self.machine.ask(line);
        }
        self.machine.delay(0.5)?;
        // A controller that keeps nothing has nothing to go back to: it stays as the last step left it, uncommissioned.
        let _ = self.machine.ask("CMS 0");
        let _ = self.machine.ask("RPA");
        Ok(())
    }

    /// An excitation, to its end.
    pub fn excite(&mut self, line: &str, seconds: f64) -> Result<Ended> {
        self.ask(line)?;
        self.delay(seconds)?;
        self.ended()
    }

    fn ended(&mut self) -> Result<Ended> {
        for _ in 0..100 {
            if self.number("EXC?", "RUNS")? == 0.0 {
                let by = self.text("EXC?", "END")?;
                if by == "fault" {
                    let fault = self.fault()?;
                    return fail(
                        format!("a fault has ended an excitation{fault}"),
                        "something moves that should not: look at wires and encoders before the next try",
                    );
                }
                let ticks = self.number("EXC?", "TICKS")?;
                let period_s = self.parameter(0x0E00_0200)?;
                return Ok(Ended {
                    by,
                    seconds: ticks * period_s,
                });
            }
            self.delay(0.05)?;
        }
        fail("an excitation does not end", "STP ends it")
    }

    /// What came of the excitation that was recorded.
    pub fn excitation_end(&mut self) -> Result<Ended> {
        self.ended()
    }

    /// The supply that is measured, V.
    pub fn supply_v(&mut self) -> Result<f64> {
        let text = self.ask("DRR? 1 1 1")?;
        let mut record = Record::default();
        let read = answer::read(&text, &mut record);
        let value = record.rows.first().and_then(|row| row.first());
        match (read, value) {
            (Some(()), Some(volts)) => Ok(*volts),
            _ => fail("the recorder has no supply", "see what HDR? lists"),
        }
    }

    /// The number that a question answers alone.
    pub fn number_of(&mut self, question: &str) -> Result<f64> {
        let answer = self.ask(question)?;
        answer.trim().parse().map_err(|_| {
            CommissionError::Controller(RecordError::Strange {
                line: question.to_owned(),
                answer: answer.clone(),
            })
        })
    }

    /// Waits until a move is over and the stage has settled.
    pub fn wait_for_target(&mut self, seconds: f64) -> Result<()> {
        let end = self.clock_s()? + seconds;
        loop {
            if self.number("ONT? X", "X")? == 1.0 {
                return Ok(());
            }
            let fault = self.fault()?;
            if !fault.is_empty() || self.clock_s()? > end {
                return fail(
                    format!("a move has not come to its end{fault}"),
                    "something rubs or gives way, or the gains are far from this machine's",
                );
            }
            self.delay(0.05)?;
        }
    }

    /// Waits until the stage has settled: how long it took, s.
    pub fn settle(&mut self) -> Result<f64> {
        let start = self.clock_s()?;
        loop {
            let passed = self.clock_s()? - start;
            if self.number("ONT? X", "X")? == 1.0 {
                return Ok(passed);
            }
            if passed > SETTLING_S {
                let fault = self.fault()?;
                return fail(
                    format!("the stage does not settle in {SETTLING_S} s{fault}"),
                    "see what FLT? and EVT? tell",
                );
            }
            self.delay(0.02)?;
        }
    }

    /// Gives records so many rows: not in motion. Records that are shorter may then be made in motion.
    pub fn reserve(&mut self, rows: usize) -> Result<()> {
        self.ask(&format!("SPA 1 {POINTS} {rows} 1 {BEFORE} 0"))?;
        self.points = rows;
        Ok(())
    }

    /// Volts, currents and angles of these pivots while a line is carried out: every tick, or less often.
    pub fn record(
        &mut self,
        pivots: &[usize],
        rows: usize,
        every: usize,
        line: Option<&str>,
    ) -> Result<Vec<Signals>> {
        let mut tables = vec![SUPPLY.to_owned()];
        for pivot in pivots {
            tables.extend(OF_PIVOT.map(|option| format!("{} {option}", pivot + 1)));
        }
        tables.resize(crate::record::TABLES, "0 0".to_owned());
        for (number, table) in (1..).zip(&tables) {
            self.ask(&format!("DRC {number} {table}"))?;
        }
        self.ask(&format!("RTR {every}"))?;
        if self.points < rows {
            self.reserve(rows)?;
        }
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
        let period_s = self.parameter(0x0E00_0200)?;
        self.delay((rows * every) as f64 * period_s)?;
        for _ in 0..50 {
            if self.number("DRL? 1", "1")? >= rows as f64 {
                break;
            }
            self.delay(0.02)?;
        }
        let mut record = Record::default();
        while record.rows.len() < rows {
            let (first, some) = (record.rows.len() + 1, ROWS.min(rows - record.rows.len()));
            let question = format!("DRR? {first} {some}");
            let text = self.ask(&question)?;
            if answer::read(&text, &mut record).is_none() || record.rows.len() < first {
                return Err(CommissionError::Controller(RecordError::Strange {
                    line: question,
                    answer: text.chars().take(60).collect(),
                }));
            }
        }
        let signals = |place: usize| {
            let column = |k: usize| record.rows.iter().map(move |row| row[1 + 3 * place + k]);
            let supply = record.rows.iter().map(|row| row[0]);
            Signals {
                volts: column(0)
                    .zip(supply)
                    .map(|(duty, volts)| duty * volts)
                    .collect(),
                current_a: column(1).collect(),
                angle_rad: column(2).map(f64::to_radians).collect(),
            }
        };
        Ok((0..pivots.len()).map(signals).collect())
    }
}
