//! Tables that outlive a restart: what is stored of one, and how it is one again.

use super::memory::{POOL_POINTS, Point, TrialControl};
use super::tables::{
    MOST_HALVINGS, SPACING_TICKS, TAIL_TICKS, Table, TableName, TableReport, TableState, Tables,
};

/// What is stored of a table besides its points.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptTable {
    /// What is told of it.
    pub report: TableReport,
    /// See [`Repeated::key`](super::Repeated::key).
    pub key: u64,
    /// See [`Repeated::ticks`](super::Repeated::ticks).
    pub ticks: u64,
    /// What is learnt at a time is this power of a half.
    pub halvings: u8,
}

impl Tables {
    /// A table is kept over a restart from now on, or no more.
    ///
    /// # Errors
    /// [`LearningError::Unknown`](super::LearningError::Unknown), also for one that waits for its move.
    pub fn keep(&mut self, name: &TableName, kept: bool) -> Result<(), super::LearningError> {
        self.learnt_mut(name)?.report.kept = kept;
        Ok(())
    }

    /// Whether there is such a table (any, when none is named) and it is kept.
    pub fn is_kept(&self, name: Option<&TableName>) -> bool {
        self.reports()
            .any(|report| report.kept && name.is_none_or(|name| report.name == *name))
    }

    /// The tables to be kept, each at its best.
    pub fn kept<'a>(
        &'a self,
        trial: &'a TrialControl<'_>,
    ) -> impl Iterator<Item = (KeptTable, &'a [Point])> {
        let kept = self.tables.iter().filter(|table| table.report.kept);
        kept.filter_map(|table| {
            let points = trial.pool.get(table.first..)?.get(..table.report.points)?;
            let kept = KeptTable {
                report: table.report.clone(),
                key: table.key,
                ticks: table.ticks,
                halvings: table.halvings,
            };
            Some((kept, points))
        })
    }

    /// A table is what was stored. It is followed at its best first: the machine may have changed. `None` when it is none that
    /// [`Self::kept`] gives, or `points` has not as many: there is no such table then.
    pub fn restore(
        &mut self,
        kept: KeptTable,
        mut points: impl FnMut() -> Option<Point>,
        trial: &mut TrialControl<'_>,
    ) -> Option<()> {
        let KeptTable {
            report,
            key,
            ticks,
            halvings,
        } = kept;
        let first = self.used();
        let count = report.points;
        let fits = report.kept
            && report.state != TableState::Waiting
            && halvings <= MOST_HALVINGS
            && self.place(&report.name).is_none()
            && report.error_counts.iter().all(|counts| *counts >= 0.0)
            && report.spacing_ticks > 0
            && report.spacing_ticks.is_multiple_of(SPACING_TICKS)
            && (ticks.checked_add(TAIL_TICKS)?).div_ceil(report.spacing_ticks.into())
                == count as u64
            && count <= (POOL_POINTS - first) / 2;
        fits.then_some(())?;
        let (best, tried) = trial.pool[first..first + 2 * count].split_at_mut(count);
        for (best, tried) in best.iter_mut().zip(tried) {
            *best = points()?;
            *tried = *best;
        }
        let table = Table {
            report,
            key,
            ticks,
            first,
            worse: 0,
            halvings,
            // Nothing is to be tried against it yet: what comes of this trial is what the next ones are to be better than.
            checks_best: Some(0.0),
        };
        self.tables.push(table).ok()
    }
}
