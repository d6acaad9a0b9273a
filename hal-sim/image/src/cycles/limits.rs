//! What a tick may take: the file that the repository keeps, and whether ticks keep to it.

use super::tally::{Row, Tally};
use crate::chip::Use;
use std::path::{Path, PathBuf};

/// Share of the deadline that a tick may take at most, nominally, in every use: what protection and calibration will need comes on top.
pub const GOAL: f64 = 0.62;
/// And no tick may grow by more than this.
const SPARE: f64 = 1.10;
const COLUMNS: [&str; 3] = ["use", "nominal worst", "limit"];

/// What there is time for, cycles from an interrupt on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadlines {
    /// Until the duties are written.
    pub tick: u64,
    /// Until the encoders' ports are let go: later, a frame is not whole when its tick comes.
    pub latch: u64,
}

impl Deadlines {
    /// The one of a use.
    #[must_use]
    pub fn of(self, used: Use) -> u64 {
        if used == Use::Latch {
            self.latch
        } else {
            self.tick
        }
    }
}

/// The limit of a use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The use.
    pub name: String,
    /// The worst when it was set, cycles.
    pub worst: u64,
    /// What it may be, cycles.
    pub limit: u64,
}

/// Why the file cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum LimitsError {
    /// It cannot be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: csv::Error,
    },
    /// It is no file of limits.
    #[error("{}: line {line} is no limit", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line.
        line: usize,
    },
}

/// The limits that these ticks give: the figure and 10 %, and never more than the goal.
#[must_use]
pub fn limits(nominal: &Tally, deadlines: Deadlines) -> Vec<Limit> {
    let limit = |row: &Row| {
        let goal = (GOAL * deadlines.of(row.used) as f64) as u64;
        let worst = row.worst();
        Limit {
            name: row.name(),
            worst,
            limit: ((worst as f64 * SPARE) as u64).min(goal),
        }
    };
    nominal.rows.iter().map(limit).collect()
}

/// What is over its limit, or has none, in words.
#[must_use]
pub fn over(nominal: &Tally, limits: &[Limit]) -> Vec<String> {
    let mut found = Vec::new();
    for row in &nominal.rows {
        let (name, worst) = (row.name(), row.worst());
        match limits.iter().find(|limit| limit.name == name) {
            None => found.push(format!("{name}: has no limit")),
            Some(_) if row.cycles.is_empty() => {
                found.push(format!("{name}: there was no such tick"))
            }
            Some(limit) if worst > limit.limit => {
                found.push(format!(
                    "{name}: {worst} cycles, its limit is {}",
                    limit.limit
                ));
            }
            Some(_) => {}
        }
    }
    let gone = |limit: &&Limit| nominal.rows.iter().all(|row| row.name() != limit.name);
    let gone = limits.iter().filter(gone);
    found
        .extend(gone.map(|limit| format!("{}: has a limit, but there is no such use", limit.name)));
    found
}

/// What would miss its deadline on the slowest chip that there may be, in words.
#[must_use]
pub fn late(pessimistic: &Tally, deadlines: Deadlines) -> Vec<String> {
    let of = |row: &Row| (row.worst(), deadlines.of(row.used));
    (pessimistic.rows.iter())
        .filter(|row| of(row).0 >= of(row).1)
        .map(|row| {
            let (worst, deadline) = of(row);
            format!(
                "{}: {worst} cycles pessimistically, its deadline is {deadline}",
                row.name()
            )
        })
        .collect()
}

/// Reads a file.
///
/// # Errors
/// [`LimitsError`].
pub fn read_limits(path: &Path) -> Result<Vec<Limit>, LimitsError> {
    let bad = |error| LimitsError::File {
        path: path.to_owned(),
        error,
    };
    let mut reader = csv::Reader::from_path(path).map_err(bad)?;
    let mut limits = Vec::new();
    for (row, line) in reader.records().zip(2..) {
        let row = row.map_err(bad)?;
        let [name, worst, limit] =
            std::array::from_fn(|column| row.get(column).unwrap_or_default());
        let (Ok(worst), Ok(limit)) = (worst.parse(), limit.parse()) else {
            let path = path.to_owned();
            return Err(LimitsError::Line { path, line });
        };
        let name = name.to_owned();
        limits.push(Limit { name, worst, limit });
    }
    Ok(limits)
}

/// Writes a file.
///
/// # Errors
/// [`LimitsError`].
pub fn write_limits(path: &Path, limits: &[Limit]) -> Result<(), LimitsError> {
    let write = || {
        let mut writer = csv::Writer::from_path(path)?;
        writer.write_record(COLUMNS)?;
        for limit in limits {
            let numbers = [limit.worst, limit.limit].map(|number| number.to_string());
            writer.write_record([&limit.name, &numbers[0], &numbers[1]])?;
        }
        Ok(writer.flush()?)
    };
    write().map_err(|error| LimitsError::File {
        path: path.to_owned(),
        error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cycles::{Cycles, Setting};
    use std::collections::HashMap;

    const DEADLINES: Deadlines = Deadlines {
        tick: 1_000,
        latch: 600,
    };

    fn tally(ticks: &[u64]) -> Tally {
        tally_of(Use::Moving, ticks)
    }

    fn tally_of(used: Use, ticks: &[u64]) -> Tally {
        let row = Row {
            used,
            writing: false,
            cycles: ticks.to_vec(),
            whole: 0,
            sum: Cycles::default(),
            instructions: 0,
        };
        Tally {
            setting: Setting::NOMINAL,
            rows: vec![row],
            places: HashMap::new(),
        }
    }

    #[test]
    fn a_limit_is_the_figure_and_a_tenth_and_never_over_the_goal() {
        assert_eq!(limits(&tally(&[400, 500]), DEADLINES)[0].limit, 550);
        assert_eq!(limits(&tally(&[600]), DEADLINES)[0].limit, 620);
        assert_eq!(limits(&tally(&[700]), DEADLINES)[0].limit, 620);
    }

    #[test]
    fn what_misses_its_deadline_pessimistically_is_named() {
        assert_eq!(late(&tally(&[999]), DEADLINES), [""; 0]);
        assert_eq!(
            late(&tally(&[1_000]), DEADLINES),
            ["moving: 1000 cycles pessimistically, its deadline is 1000"]
        );
        assert_eq!(late(&tally_of(Use::Latch, &[599]), DEADLINES), [""; 0]);
        assert_eq!(late(&tally_of(Use::Latch, &[600]), DEADLINES).len(), 1);
    }

    #[test]
    fn what_is_over_its_limit_is_named() {
        let kept = limits(&tally(&[500]), DEADLINES);
        assert_eq!(over(&tally(&[550]), &kept), [""; 0]);
        assert_eq!(
            over(&tally(&[551]), &kept),
            ["moving: 551 cycles, its limit is 550"]
        );
        assert_eq!(over(&tally(&[]), &kept), ["moving: there was no such tick"]);
        assert_eq!(over(&tally(&[1]), &[]), ["moving: has no limit"]);
    }

    #[test]
    fn a_file_is_read_as_it_was_written() {
        let path = std::env::temp_dir().join(format!("limits-{}.csv", std::process::id()));
        let kept = limits(&tally(&[700]), DEADLINES);
        write_limits(&path, &kept).expect("a file");
        assert_eq!(read_limits(&path).expect("limits"), kept);
        std::fs::write(&path, "use,nominal worst,limit\nmoving,many,1\n").expect("a file");
        let error = read_limits(&path).unwrap_err();
        assert!(
            matches!(error, LimitsError::Line { line: 2, .. }),
            "{error}"
        );
        std::fs::remove_file(&path).expect("it was there");
    }
}
