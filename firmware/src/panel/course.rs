//! A plan as the command side knows it: with the state it starts from, so that it can be stopped from outside the tick.

use crate::motion::{
    Axis, Bounds, Limits, NoTransition, Plan, Position, Refusal, Start, Stop, plan_curved_stop,
    plan_line, plan_stop, plan_transition,
};
use kinematics::Geometry;

/// A plan that was sent to the tick.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The plan.
    pub plan: Plan,
    /// The three axes at its first tick.
    start: [Axis; 3],
    /// Whether it leaves the straight line: velocity and acceleration point anywhere.
    curved: bool,
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
            curved: false,
            stop: None,
        })
    }

    /// The way to another target that leaves this course at its tick `at`.
    pub fn retargeted(
        &self,
        id: u32,
        at: u64,
        to: Position,
        limits: &Limits,
        geometry: &Geometry,
        bounds: &Bounds,
    ) -> Result<Self, NoTransition> {
        let (plan, start) = (&self.plan, &self.start);
        Ok(Self {
            plan: plan_transition(id, plan, start, at, to, limits, geometry, bounds)?,
            start: plan.state_after(start, at),
            curved: true,
            stop: None,
        })
    }

    /// Whether it takes over from another one in motion.
    pub fn is_splice(&self) -> bool {
        matches!(self.plan.start, Start::Splice { .. })
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
        let plan_it = if self.curved {
            plan_curved_stop
        } else {
            plan_stop
        };
        Some(Self {
            plan: plan_it(id, &self.plan, &self.start, at, limits, geometry, stop)?,
            start: self.plan.state_after(&self.start, at),
            curved: self.curved,
            stop: Some(stop),
        })
    }
}
