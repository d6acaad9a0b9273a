//! Moves that are repeated: what makes one the same as another, and the table of iterative learning that goes with it.

use super::sent_plan::SentPlan;
use super::state::Commander;
use crate::iterative_learning::{LearningError, Repeated, TableName, TableReport};
use crate::motion::{PlanStart, RotationCentre};
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
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), LearningError> {
        self.tables.forget(name)?;
        queues.trial.cancel();
        queues.trial.hold_model(!self.tables.is_empty());
        Ok(())
    }

    /// What is told of the tables.
    pub fn repeated_moves(&self) -> impl Iterator<Item = &TableReport> {
        self.tables.reports()
    }

    /// A move from rest is about to be sent: opens its table, if it has one.
    pub(super) fn prepare_trial(&mut self, sent_plan: &SentPlan, queues: &mut CommandQueues<'_>) {
        let plan = &sent_plan.plan;
        let motion = Repeated {
            key: key(sent_plan, self.snapshot().map(|snapshot| snapshot.centre)),
            ticks: plan.ticks(),
        };
        self.tables.prepare(plan.id, &motion, &mut queues.trial);
    }
}

/// Of where a plan starts, all that it does, and about which point.
fn key(sent_plan: &SentPlan, centre: Option<RotationCentre>) -> u64 {
    let plan = &sent_plan.plan;
    let mut hash = HASH_START;
    let mut add = |word: i64| hash = (hash ^ word as u64).wrapping_mul(HASH_FACTOR);
    if let PlanStart::Rest(from) = plan.start {
        from.into_iter().for_each(&mut add);
    }
    for piece in &plan.pieces {
        add(piece.ticks as i64);
        piece.jerk.into_iter().for_each(&mut add);
    }
    plan.nudge.into_iter().for_each(&mut add);
    for part in centre.map_or([0.0; 2], |centre| centre.point()) {
        add(part.to_bits() as i64);
    }
    hash
}
