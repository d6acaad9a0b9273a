//! A plan as the command side knows it: with the state it starts from, so that it can be left from outside the tick.

use super::error::CommandError;
use crate::motion::{
    AxisState, Constraints, Effort, Plan, PlanStart, Position, RetargetError, Stop, plan_jog,
    plan_line, plan_retarget, plan_stop,
};

/// What a motion is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// Rest at a position.
    Position(Position),
    /// A velocity, kept as long as it can be: of x and y in the base frame (mm/s) and of theta (deg/s).
    Velocity([f64; 3]),
    /// What a stream's targets say.
    Stream,
}

/// A plan that was sent to the tick.
#[derive(Clone, Debug)]
pub(crate) struct SentPlan {
    /// The plan.
    pub plan: Plan,
    /// What it is for; of a stop, what the motion before it was for.
    pub goal: Goal,
    /// Of a stop, how it brakes.
    pub stop: Option<Stop>,
    /// The three axes at its first tick.
    start: [AxisState; 3],
}

impl SentPlan {
    /// From rest at `from`.
    pub fn from_rest(
        id: u32,
        from: Position,
        goal: Goal,
        constraints: &Constraints,
    ) -> Result<Self, CommandError> {
        let start = from.map(AxisState::at_rest);
        let plan = match goal {
            // It makes its plans itself.
            Goal::Stream => Err(CommandError::Busy),
            Goal::Position(to) => {
                plan_line(id, from, to, constraints).map_err(CommandError::Refused)
            }
            Goal::Velocity(velocity) => {
                plan_jog(id, PlanStart::Rest(from), &start, &velocity, constraints).map_err(|no| {
                    match no {
                        RetargetError::Refused(refusal) => CommandError::Refused(refusal),
                        // At rest there is nothing to stop.
                        RetargetError::NeedsStop => CommandError::NoMotion,
                    }
                })
            }
        };
        Ok(Self {
            plan: plan?,
            goal,
            stop: None,
            start,
        })
    }

    /// A plan of a stream, from these axes.
    pub const fn streamed(plan: Plan, start: [AxisState; 3]) -> Self {
        Self {
            plan,
            goal: Goal::Stream,
            stop: None,
            start,
        }
    }

    /// The way to another goal that leaves this plan at its tick `at`; a target's with so much effort.
    pub fn retargeted(
        &self,
        goal: Goal,
        id: u32,
        at: u64,
        constraints: &Constraints,
        effort: Effort,
    ) -> Result<Self, RetargetError> {
        // An urgent stop is not softened: what is asked in it waits until it is over.
        if self.stop == Some(Stop::Urgent) {
            return Err(RetargetError::NeedsStop);
        }
        let start = self.plan.state_after(&self.start, at);
        let plan = match goal {
            // It makes its plans itself.
            Goal::Stream => Err(RetargetError::NeedsStop),
            Goal::Position(to) => {
                plan_retarget(id, &self.plan, &self.start, at, to, constraints, effort)
            }
            // A plan that has ended by then leaves nothing to leave.
            Goal::Velocity(_) if at >= self.plan.ticks() => Err(RetargetError::NeedsStop),
            Goal::Velocity(velocity) => {
                let splice = PlanStart::Splice {
                    plan: self.plan.id,
                    tick: at,
                };
                plan_jog(id, splice, &start, &velocity, constraints)
            }
        }?;
        Ok(Self {
            plan,
            goal,
            stop: None,
            start,
        })
    }

    /// Whether it takes over from another one in motion.
    pub fn takes_over(&self) -> bool {
        matches!(self.plan.start, PlanStart::Splice { .. })
    }

    /// The stop that leaves this plan at its tick `at`; `None` when it comes to rest by itself as soon, as a stop does that
    /// is no less urgent.
    pub fn with_stop(
        &self,
        id: u32,
        at: u64,
        constraints: &Constraints,
        stop: Stop,
    ) -> Option<Self> {
        if self.stop == Some(stop) || self.stop == Some(Stop::Urgent) {
            return None;
        }
        Some(Self {
            plan: plan_stop(id, &self.plan, &self.start, at, constraints, stop)?,
            start: self.plan.state_after(&self.start, at),
            stop: Some(stop),
            goal: self.goal,
        })
    }
}
