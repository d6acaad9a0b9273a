//! Moves that are repeated: what makes one the same as another, and the table of iterative learning that goes with it.

use super::sent_plan::SentPlan;
use super::state::Commander;
use super::wave::GeneratorRun;
use crate::iterative_learning::{
    KeptTable, LearningError, Point, Repeated, TableName, TableReport, TrialControl,
};
use crate::motion::{Plan, PlanStart};
use crate::queues::CommandQueues;

/// Fowler, Noll and Vo's hash, 64 bits, 1a.
const HASH_START: u64 = 0xCBF2_9CE4_8422_2325;
const HASH_FACTOR: u64 = 0x0000_0100_0000_01B3;

impl Commander {
    /// A table of this name learns: from the next move that has none, or goes on.
    ///
    /// # Errors
    /// See [`LearningError`].
    pub fn learn_move(
        &mut self,
        name: TableName,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), LearningError> {
        self.tables.learn(name)?;
        queues.trial.hold_model(true);
        Ok(())
    }

    /// A table stays as it is at its best.
    ///
    /// # Errors
    /// See [`LearningError`].
    pub fn freeze_move(&mut self, name: &TableName) -> Result<(), LearningError> {
        self.tables.freeze(name)
    }

    /// Forgets a table, or all.
    ///
    /// # Errors
    /// See [`LearningError`].
    pub fn forget_move(
        &mut self,
        name: Option<&TableName>,
        trial: &mut TrialControl<'_>,
    ) -> Result<(), LearningError> {
        self.tables.forget(name, trial)?;
        trial.cancel();
        trial.hold_model(!self.tables.is_empty());
        Ok(())
    }

    /// A table is kept over a restart from now on, or no more.
    ///
    /// # Errors
    /// See [`LearningError`].
    pub fn keep_move(&mut self, name: &TableName, kept: bool) -> Result<(), LearningError> {
        self.tables.keep(name, kept)
    }

    /// Whether there is such a table (any, when none is named) and it is kept.
    pub fn is_move_kept(&self, name: Option<&TableName>) -> bool {
        self.tables.is_kept(name)
    }

    /// The tables to be kept, each at its best.
    pub fn kept_moves<'a>(
        &'a self,
        trial: &'a TrialControl<'_>,
    ) -> impl Iterator<Item = (KeptTable, &'a [Point])> {
        self.tables.kept(trial)
    }

    /// A table is what was stored; `None` when it is none that was, or `points` has not as many.
    pub fn restore_move(
        &mut self,
        kept: KeptTable,
        points: impl FnMut() -> Option<Point>,
        trial: &mut TrialControl<'_>,
    ) -> Option<()> {
        self.tables.restore(kept, points, trial)?;
        trial.hold_model(true);
        Some(())
    }

    /// What is told of the tables.
    pub fn repeated_moves(&self) -> impl Iterator<Item = &TableReport> {
        self.tables.reports()
    }

    /// A move from rest is about to be sent: opens its table, if it has one.
    pub(super) fn prepare_move(&mut self, sent_plan: &SentPlan, queues: &mut CommandQueues<'_>) {
        let plan = &sent_plan.plan;
        let mut hash = self.start_hash(&plan.start);
        for piece in &plan.pieces {
            hash.add(piece.ticks as i64);
            piece.jerk.into_iter().for_each(|jerk| hash.add(jerk));
        }
        plan.nudge.into_iter().for_each(|nudge| hash.add(nudge));
        self.prepare(plan.id, hash, plan.ticks(), queues);
    }

    /// The first plan of waves is about to be sent: opens their table, if they have one. Waves without end have none.
    pub(super) fn prepare_waves(
        &mut self,
        run: &GeneratorRun,
        plan: &Plan,
        queues: &mut CommandQueues<'_>,
    ) {
        let Some(samples) = run.samples().filter(|_| !self.tables.is_empty()) else {
            return self.end_trial(queues);
        };
        let mut hash = self.start_hash(&plan.start);
        for (axis, table) in (0..).zip(run.tables()) {
            let length = table.map_or(0, |table| self.waves.length(table));
            hash.add(axis);
            hash.add(length.into());
            for point in 0..length {
                let value = table.map_or(0.0, |table| self.waves.value(table, point));
                hash.add(value.to_bits() as i64);
            }
        }
        hash.add(self.waves.ticks.into());
        let ticks = samples * u64::from(self.waves.ticks);
        self.prepare(plan.id, hash, ticks, queues);
    }

    /// Another motion is about to be sent: a table that is still followed is not for it.
    pub(super) fn end_trial(&mut self, queues: &mut CommandQueues<'_>) {
        self.tables.finish(&mut queues.trial);
    }

    fn prepare(&mut self, plan: u32, hash: Hash, ticks: u64, queues: &mut CommandQueues<'_>) {
        let motion = Repeated { key: hash.0, ticks };
        self.tables.prepare(plan, &motion, &mut queues.trial);
    }

    /// From where, and about which point.
    fn start_hash(&self, start: &PlanStart) -> Hash {
        let mut hash = Hash(HASH_START);
        if let PlanStart::Rest(from) = start {
            from.iter().for_each(|part| hash.add(*part));
        }
        let centre = self.snapshot().map(|snapshot| snapshot.centre);
        for part in centre.map_or([0.0; 2], |centre| centre.point()) {
            hash.add(part.to_bits() as i64);
        }
        hash
    }
}

/// Of what makes a motion.
struct Hash(u64);

impl Hash {
    fn add(&mut self, word: i64) {
        self.0 = (self.0 ^ word as u64).wrapping_mul(HASH_FACTOR);
    }
}
