//! The tables by their names, and what they learn.

use super::memory::{POOL_POINTS, Point, TRIAL_POINTS, TrialControl, TrialResult};
use core::fmt;
use heapless::{String, Vec};

/// Name of a table.
pub type TableName = String<16>;

/// Most tables.
pub const MOST_TABLES: usize = 8;
/// Ticks from point to point are a multiple of this.
pub(super) const SPACING_TICKS: u32 = 10;
/// Ticks for which a table goes on behind the end of its motion: less than a stage takes to settle.
pub(super) const TAIL_TICKS: u64 = 40;
/// Error of a trial over the best one from which on it was worse: what noise makes of the same again.
const WORSE: f32 = 1.02;
/// The first step is this power of a half: with a machine that is told ten times too heavy a whole one is twice as bad as none.
const FIRST_HALVINGS: u8 = 2;
/// What a step gains of the best error, over its own size, below which what is left is noise, of which less is learnt the smaller the step.
const HARDLY_GAINS: f32 = 0.2;
/// The same from which on the machine is as told: the next step is twice as large.
const GAINS_AS_TOLD: f32 = 0.75;
/// Error of the best one, followed again, over what it was, from which on the machine is another one.
const OTHER: f32 = 1.5;
/// Trials worse than the best, in a row, after which the best is what stays.
const MOST_WORSE: u8 = 3;
/// What is learnt at a time is never less than this power of a half.
pub(super) const MOST_HALVINGS: u8 = 4;

/// What makes a motion the same: its plan, from where, about which point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repeated {
    /// Of all that makes it: as good as that.
    pub key: u64,
    /// Its duration.
    pub ticks: u64,
}

/// What becomes of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableState {
    /// The next move that has none gets it.
    Waiting,
    /// It gets better with every trial.
    Learning,
    /// It is followed as it is.
    Frozen,
    /// It became worse and not better: the best of it is followed.
    Stopped,
}

/// What is told of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableReport {
    /// Its name.
    pub name: TableName,
    /// What becomes of it.
    pub state: TableState,
    /// Trials that it has learnt from.
    pub trials: u32,
    /// Root mean square of the pivots' errors, encoder counts: of the first trial, without it; the best; the last.
    pub error_counts: [f32; 3],
    /// Points, and ticks from one to the next.
    pub points: usize,
    /// See there.
    pub spacing_ticks: u32,
    /// It is kept over a restart, as it is when something is stored.
    pub kept: bool,
}

/// Why a table can not be had; nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LearningError {
    /// There are as many as there can be.
    TooMany,
    /// There is none of that name.
    Unknown,
    /// Another one waits for its move.
    OtherWaits,
}

#[derive(Clone, Debug)]
pub(super) struct Table {
    pub report: TableReport,
    pub key: u64,
    pub ticks: u64,
    /// Where its points begin in the pool: the best, and behind them those that are tried next.
    pub first: usize,
    /// Trials worse than the best, in a row; and all of them: each halves what is learnt at a time.
    pub worse: u8,
    pub halvings: u8,
    /// The best one is followed once more, after a trial of this error: was it so good, or was the start another one?
    pub checks_best: Option<f32>,
}

/// All tables; their points are in the pool of [`TrialControl`].
#[derive(Debug)]
pub struct Tables {
    pub(super) tables: Vec<Table, MOST_TABLES>,
    /// The one that the trial under way is of.
    tried: Option<usize>,
}

impl Default for Tables {
    fn default() -> Self {
        Self::new()
    }
}

impl Tables {
    /// None.
    pub const fn new() -> Self {
        Self {
            tables: Vec::new(),
            tried: None,
        }
    }

    /// A table of this name learns: from the next move that has none, or goes on.
    ///
    /// # Errors
    /// [`LearningError::TooMany`], [`LearningError::OtherWaits`].
    pub fn learn(&mut self, name: TableName) -> Result<(), LearningError> {
        if let Some(i) = self.place(&name) {
            let table = &mut self.tables[i];
            match table.report.state {
                TableState::Waiting | TableState::Learning => {}
                TableState::Frozen | TableState::Stopped => {
                    table.report.state = TableState::Learning;
                    (table.worse, table.halvings) = (0, FIRST_HALVINGS);
                }
            }
            return Ok(());
        }
        if (self.tables.iter()).any(|table| table.report.state == TableState::Waiting) {
            return Err(LearningError::OtherWaits);
        }
        let table = Table {
            report: TableReport {
                name,
                state: TableState::Waiting,
                trials: 0,
                error_counts: [0.0; 3],
                points: 0,
                spacing_ticks: 0,
                kept: false,
            },
            key: 0,
            ticks: 0,
            first: self.used(),
            worse: 0,
            halvings: FIRST_HALVINGS,
            checks_best: None,
        };
        self.tables.push(table).map_err(|_| LearningError::TooMany)
    }

    /// A table stays as it is at its best.
    ///
    /// # Errors
    /// [`LearningError::Unknown`], also for one that waits for its move.
    pub fn freeze(&mut self, name: &TableName) -> Result<(), LearningError> {
        self.learnt_mut(name)?.report.state = TableState::Frozen;
        Ok(())
    }

    /// The table of this name, if it has its move.
    pub(super) fn learnt_mut(&mut self, name: &TableName) -> Result<&mut Table, LearningError> {
        let mut tables = self.tables.iter_mut();
        let named = tables.find(|table| table.report.name == *name);
        named
            .filter(|table| table.report.state != TableState::Waiting)
            .ok_or(LearningError::Unknown)
    }

    /// Forgets a table, or all.
    ///
    /// # Errors
    /// [`LearningError::Unknown`].
    pub fn forget(
        &mut self,
        name: Option<&TableName>,
        trial: &mut TrialControl<'_>,
    ) -> Result<(), LearningError> {
        self.tried = None;
        let Some(name) = name else {
            self.tables.clear();
            return Ok(());
        };
        let i = self.place(name).ok_or(LearningError::Unknown)?;
        let gone = self.tables.remove(i);
        let points = 2 * gone.report.points;
        (trial.pool).copy_within(gone.first + points.., gone.first);
        for table in &mut self.tables[i..] {
            table.first -= points;
        }
        Ok(())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.tables.is_empty()
    }

    /// What is told of each.
    pub fn reports(&self) -> impl Iterator<Item = &TableReport> {
        self.tables.iter().map(|table| &table.report)
    }

    /// A move is about to be sent as the plan of this number: opens its table, if it has one.
    pub fn prepare(&mut self, plan: u32, motion: &Repeated, trial: &mut TrialControl<'_>) {
        // The one before may not be through with its tail.
        self.finish(trial);
        let Some(i) = self.table_of(motion, trial) else {
            return;
        };
        let Table {
            report,
            first,
            checks_best,
            ..
        } = &self.tables[i];
        let next = match report.state {
            TableState::Learning if checks_best.is_none() => first + report.points,
            _ => *first,
        };
        trial.open(plan, report.spacing_ticks, next..next + report.points);
        self.tried = Some(i);
    }

    /// The table of a motion; one that waits becomes it, if there is room.
    fn table_of(&mut self, motion: &Repeated, trial: &mut TrialControl<'_>) -> Option<usize> {
        let same = |table: &Table| {
            table.report.state != TableState::Waiting
                && (table.key, table.ticks) == (motion.key, motion.ticks)
        };
        if let Some(i) = self.tables.iter().position(same) {
            return Some(i);
        }
        let used = self.used();
        let waits = |table: &Table| table.report.state == TableState::Waiting;
        let i = self.tables.iter().position(waits)?;
        let most = ((POOL_POINTS - used) / 2).min(TRIAL_POINTS) as u64;
        let ticks = motion.ticks + TAIL_TICKS;
        // The finest that there is room for.
        let spacing = ticks.checked_div(most)? / u64::from(SPACING_TICKS) + 1;
        let spacing_ticks = u32::try_from(spacing).ok()?.checked_mul(SPACING_TICKS)?;
        let points = ticks.div_ceil(u64::from(spacing_ticks)) as usize;
        let table = &mut self.tables[i];
        (table.key, table.ticks, table.first) = (motion.key, motion.ticks, used);
        table.report.state = TableState::Learning;
        (table.report.points, table.report.spacing_ticks) = (points, spacing_ticks);
        trial.pool[used..used + 2 * points].fill([0; 3]);
        Some(i)
    }

    /// Learns from a trial that is over. To be called after every snapshot.
    pub fn take_result(&mut self, trial: &mut TrialControl<'_>) {
        if trial.is_done() {
            self.finish(trial);
        }
    }

    /// Ends the trial under way, and learns from it if it is over as far as its motion goes.
    pub fn finish(&mut self, trial: &mut TrialControl<'_>) {
        let (result, tried) = (trial.finish(), self.tried.take());
        if let (Some(result), Some(i)) = (result, tried) {
            let Table { report, ticks, .. } = &self.tables[i];
            if result.points as u64 * u64::from(report.spacing_ticks) >= *ticks {
                self.learn_from(i, &result, trial);
            }
        }
    }

    fn learn_from(&mut self, i: usize, result: &TrialResult, trial: &mut TrialControl<'_>) {
        let Table {
            report,
            first,
            worse,
            halvings,
            checks_best,
            ..
        } = &mut self.tables[i];
        let [without, best_counts, last] = &mut report.error_counts;
        *last = result.error_counts;
        if report.state != TableState::Learning {
            return;
        }
        if report.trials == 0 {
            (*without, *best_counts) = (*last, *last);
        }
        report.trials = report.trials.saturating_add(1);
        let points = report.points;
        let (best, tried) = (
            *first..*first + points,
            *first + points..*first + 2 * points,
        );
        if let Some(tried_counts) = checks_best.take() {
            if *last > OTHER * *best_counts {
                // It is another machine than it was: what it needs now is more than noise.
                *halvings = FIRST_HALVINGS;
            }
            *best_counts = *last;
            if tried_counts <= WORSE * *best_counts {
                // The start was another one: what was tried is tried again.
                return;
            }
            *worse += 1;
            *halvings = (*halvings + 1).min(MOST_HALVINGS);
            if *worse >= MOST_WORSE {
                report.state = TableState::Stopped;
            }
            for (best, tried) in best.zip(tried) {
                let [best, last] = [trial.pool[best], trial.pool[tried]];
                trial.pool[tried] = [0, 1, 2].map(|i| halfway(best[i], last[i]));
            }
            return;
        }
        if *last > WORSE * *best_counts {
            *checks_best = Some(*last);
            return;
        }
        *worse = 0;
        if report.trials > 1 {
            let step = 1.0 / (1_u32 << *halvings) as f32;
            let gain = (*best_counts - *last) / (step * *best_counts);
            if gain < HARDLY_GAINS {
                *halvings = (*halvings + 1).min(MOST_HALVINGS);
            } else if gain > GAINS_AS_TOLD {
                *halvings = halvings.saturating_sub(1);
            }
        }
        if *last < *best_counts {
            *best_counts = *last;
            (trial.pool).copy_within(tried.clone(), best.start);
        }
        for (point, place) in tried.enumerate() {
            let correction = smoothed(trial, point, result.points);
            let volts = &mut trial.pool[place];
            *volts = [0, 1, 2].map(|i| volts[i].saturating_add(halved(correction[i], *halvings)));
        }
    }

    pub(super) fn place(&self, name: &TableName) -> Option<usize> {
        self.tables
            .iter()
            .position(|table| table.report.name == *name)
    }

    /// Points of the pool that are taken.
    pub(super) fn used(&self) -> usize {
        self.tables
            .iter()
            .map(|table| 2 * table.report.points)
            .sum()
    }
}

/// What the feedback had to add about a point: what lies over the points' own frequency is not followed. The last two points know nothing.
fn smoothed(trial: &TrialControl<'_>, point: usize, points: usize) -> Point {
    let at = |point: usize| trial.correction(point.min(points.saturating_sub(3)));
    let [before, now, after] = [at(point.saturating_sub(1)), at(point), at(point + 1)];
    [0, 1, 2].map(|i| {
        let sum = i32::from(before[i]) + 2 * i32::from(now[i]) + i32::from(after[i]);
        (sum / 4) as i16
    })
}

/// Halved so many times, to the nearest.
fn halved(correction: i16, halvings: u8) -> i16 {
    let half = (1_i32 << halvings) >> 1;
    ((i32::from(correction) + half) >> halvings) as i16
}

fn halfway(a: i16, b: i16) -> i16 {
    ((i32::from(a) + i32::from(b)) / 2) as i16
}

impl fmt::Display for TableState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Waiting => "waiting",
            Self::Learning => "learning",
            Self::Frozen => "frozen",
            Self::Stopped => "stopped",
        })
    }
}
