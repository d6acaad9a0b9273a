//! Records, and the recorder as the user has it.

use super::{Answered, Bench, LOOK_S};
use crate::commission::Aside;
use crate::commission::id::AXES;
use crate::record::desk::strange;
use crate::record::{Record, TABLES, answer};
use commissioning::record::Signals;

/// Rows that are fetched at a time.
const ROWS: usize = 256;
/// Duty, current and angle of a pivot, as `DRC` takes them.
pub(in crate::commission) const DUTY: &str = "73";
pub(in crate::commission) const CURRENT: &str = "200";
pub(in crate::commission) const ANGLE: &str = "2";
const OF_PIVOT: [&str; 3] = [DUTY, CURRENT, ANGLE];
pub(in crate::commission) const SUPPLY: &str = "0 201";
/// Parameters: a record's points, and those before its trigger.
const POINTS: u32 = 0x1600_0201;
const BEFORE: u32 = 0x5450_0900;

/// What of the recorder is the user's: the rows of a record, and what its tables record, as `DRC?` tells it.
pub(super) struct Recorder {
    points: Aside,
    tables: String,
}

/// A record of a pivot.
pub(crate) struct Recorded {
    /// Volts, currents and angles.
    pub signals: Signals,
    /// Mean supply, V.
    pub supply_v: f64,
}

impl Bench<'_> {
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
