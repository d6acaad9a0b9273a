//! A plan as the command side knows it: with the state it starts from, so that it can be left from outside the tick.

use crate::gcs::error::ErrorCode;
use crate::motion::{
    Ahead, AxisState, Constraints, Leave, Plan, PlanStart, Position, Refusal, RetargetError, Stop,
    Tries, plan_jog, plan_line, plan_stop, try_retarget,
};

/// What a motion is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// Rest at a position.
    Place(Position),
    /// A velocity, kept as long as it can be: of x and y in the base frame (mm/s) and of theta (deg/s).
    Velocity([f64; 3]),
    /// What a stream's targets say.
    Stream,
}

/// A plan that was sent to the tick.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    /// The plan.
    pub plan: Plan,
    /// What it is for; of a stop, what the motion before it was for.
    pub goal: Goal,
    /// Of a stop, how it brakes.
    pub stop: Option<Stop>,
    /// The three axes at its first tick.
    start: [AxisState; 3],
}

impl Course {
    /// From rest at `from`.
    pub fn from_rest(
        id: u32,
        from: Position,
        goal: Goal,
        ground: &Constraints,
    ) -> Result<Self, ErrorCode> {
        let start = from.map(AxisState::at_rest);
        let plan = match goal {
            // It makes its plans itself.
            Goal::Stream => Err(ErrorCode::Busy),
            Goal::Place(to) => plan_line(id, from, to, ground).map_err(|refusal| code(&refusal)),
            Goal::Velocity(velocity) => {
                plan_jog(id, PlanStart::Rest(from), &start, &velocity, ground).map_err(
                    |no| match no {
                        RetargetError::Refused(refusal) => code(&refusal),
                        // At rest there is nothing to stop.
                        RetargetError::NeedsStop | RetargetError::TooFast => {
                            ErrorCode::PositionLimit
                        }
                    },
                )
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

    /// The way to another goal that leaves this course at its tick `at`, by the next of `tries`; what of it is not planned yet is
    /// left `ahead`.
    pub fn left_for(
        &self,
        goal: Goal,
        id: u32,
        at: u64,
        ground: &Constraints,
        tries: &mut Tries,
        ahead: &mut Option<Ahead>,
    ) -> Result<Self, RetargetError> {
        let mut next = Self {
            plan: Plan::default(),
            goal,
            stop: None,
            start: self.plan.state_after(&self.start, at),
        };
        match goal {
            // It makes its plans itself.
            Goal::Stream => Err(RetargetError::NeedsStop),
            Goal::Place(to) => {
                let (of, from) = (&self.plan, &self.start);
                let leave = Leave { of, from, at };
                try_retarget(&mut next.plan, id, leave, to, ground, tries, ahead)
            }
            // A plan that has ended by then leaves nothing to leave.
            Goal::Velocity(_) if at >= self.plan.ticks() => Err(RetargetError::NeedsStop),
            Goal::Velocity(velocity) => {
                let splice = PlanStart::Splice {
                    plan: self.plan.id,
                    tick: at,
                };
                plan_jog(id, splice, &next.start, &velocity, ground).map(|plan| next.plan = plan)
            }
        }?;
        Ok(next)
    }

    /// What lies `ahead` of this course, which is its head, from tick `at` on.
    pub fn gone_on(
        &self,
        ahead: &Ahead,
        id: u32,
        at: u64,
        ground: &Constraints,
        tries: &mut Tries,
    ) -> Result<Self, RetargetError> {
        Ok(Self {
            plan: ahead.go_on(id, at, ground, tries)?,
            start: self.plan.state_after(&self.start, at),
            ..*self
        })
    }

    /// Whether it takes over from another one in motion.
    pub fn is_splice(&self) -> bool {
        matches!(self.plan.start, PlanStart::Splice { .. })
    }

    /// The stop that leaves this course at its tick `at`; `None` when it comes to rest by itself as soon.
    pub fn stopped(&self, id: u32, at: u64, ground: &Constraints, stop: Stop) -> Option<Self> {
        Some(Self {
            plan: plan_stop(id, &self.plan, &self.start, at, ground, stop)?,
            start: self.plan.state_after(&self.start, at),
            stop: Some(stop),
            goal: self.goal,
        })
    }
}

/// What a connection is told of a refusal.
pub(crate) const fn code(refusal: &Refusal) -> ErrorCode {
    match refusal {
        Refusal::Velocity
        | Refusal::PivotRate { .. }
        | Refusal::InvalidLimits
        | Refusal::Acceleration
        | Refusal::Jerk
        | Refusal::Pivots => ErrorCode::VelocityLimit,
        _ => ErrorCode::PositionLimit,
    }
}
