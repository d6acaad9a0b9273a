//! A plan as the command side knows it: with the state it starts from, so that it can be stopped from outside the tick.

use crate::motion::Refusal;
use crate::motion::{Axis, Limits, Plan, Position, Stop, plan_line, plan_stop};
use kinematics::Geometry;

/// A plan that was sent to the tick.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The plan.
    pub plan: Plan,
    /// The three axes at its first tick.
    start: [Axis; 3],
    /// Of a stop, how it brakes.
    pub stop: Option<Stop>,
}

impl Course {
    /// The straight line between two positions.
    pub fn line(
        id: u32,
        from: Position,
        to: Position,
        limits: &Limits,
        geometry: &Geometry,
    ) -> Result<Self, Refusal> {
        Ok(Self {
            plan: plan_line(id, from, to, limits, geometry)?,
            start: from.map(Axis::at_rest),
            stop: None,
        })
    }

    /// The stop that leaves this course at its tick `at`; `None` when it comes to rest by itself as soon.
    pub fn stopped(
        &self,
        id: u32,
        at: u64,
        limits: &Limits,
        geometry: &Geometry,
        stop: Stop,
    ) -> Option<Self> {
        Some(Self {
            plan: plan_stop(id, &self.plan, &self.start, at, limits, geometry, stop)?,
            start: self.plan.state_after(&self.start, at),
            stop: Some(stop),
        })
    }
}
