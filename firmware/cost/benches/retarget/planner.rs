//! The planner under test. Only [`retargeted`] knows how the way to a new target in motion is planned: another planner
//! is put there, and nothing else changes.
//!
//! As the commander does it: a first way leaves the motion where a stop would, and the soonest way leaves the first one, or
//! the stop where there is none, `LEAD` ticks later (80 unless the environment says otherwise), if it is over sooner.
//! Durations count from the tick at which the motion is left.

use crate::motion_bench::at_rest;
use crate::motion_bench::setting::setting;
use firmware::motion::{
    AxisState, Constraints, Effort, Plan, Position, Refusal, RetargetError, Stop, plan_line,
    plan_retarget, plan_stop,
};
use std::sync::LazyLock;

static LEAD_TICKS: LazyLock<u64> = LazyLock::new(lead_ticks);

/// How much later than the first way the soonest one takes over: twice the command side's time for planning.
pub fn lead_ticks() -> u64 {
    setting("LEAD", 80)
}

/// A sooner way is taken if it saves this part of what is left, as by the commander.
const WORTH_TAKING: u64 = 64;

/// A plan, and the axes at its start.
#[derive(Clone)]
pub struct Motion {
    pub plan: Plan,
    pub from: [AxisState; 3],
}

impl Motion {
    pub fn state_after(&self, ticks: u64) -> [AxisState; 3] {
        self.plan.state_after(&self.from, ticks)
    }
}

/// What a plan of a way is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Stop,
    /// To the target out of the motion.
    Transition,
    /// To the target from rest.
    Line,
}

/// A plan of a way.
pub struct Step {
    /// The tick at which what was under way before is left for it.
    pub left: u64,
    pub motion: Motion,
    pub kind: Kind,
}

/// The plans that lead to a target, in order; the last one ends there.
#[derive(Default)]
pub struct Way {
    pub steps: Vec<Step>,
}

/// The way to rest at `to` that leaves `of` at its tick `at`, as the stage goes it: where there is none without a stop
/// before, the stop and a line from where it ends.
///
/// # Errors
/// Why there is no way at all.
pub fn retargeted(
    of: &Motion,
    at: u64,
    to: Position,
    constraints: &Constraints,
) -> Result<Way, Refusal> {
    let mut way = Way::default();
    let stop = stopped(of, at, constraints);
    let lead = *LEAD_TICKS;
    let id = of.plan.id + 1;
    match plan_retarget(id, &of.plan, &of.from, at, to, constraints, Effort::FIRST) {
        Ok(plan) => {
            let first = Motion {
                plan,
                from: of.state_after(at),
            };
            if let Some(better) = soonest(&first, lead, to, constraints)
                && let left = first.plan.ticks().saturating_sub(lead)
                && better.plan.ticks() + left / WORTH_TAKING < left
            {
                way.push(at, first, Kind::Transition);
                way.push(lead, better, Kind::Transition);
            } else {
                way.push(at, first, Kind::Transition);
            }
            Ok(way)
        }
        Err(RetargetError::Refused(no)) => Err(no),
        Err(RetargetError::NeedsStop) => {
            if let Some(stop) = &stop
                && let Some(plan) = soonest(stop, lead, to, constraints)
            {
                way.push(at, stop.clone(), Kind::Stop);
                way.push(lead, plan, Kind::Transition);
                return Ok(way);
            }
            from_rest(of, at, stop, to, constraints)
        }
    }
}

/// The soonest way that leaves a motion at its tick `at`.
fn soonest(of: &Motion, at: u64, to: Position, constraints: &Constraints) -> Option<Motion> {
    let id = of.plan.id + 1;
    Some(Motion {
        plan: plan_retarget(id, &of.plan, &of.from, at, to, constraints, Effort::ALL).ok()?,
        from: of.state_after(at),
    })
}

/// The stop, or what is left of a motion that comes to rest by itself, and the line from there.
fn from_rest(
    of: &Motion,
    at: u64,
    stop: Option<Motion>,
    to: Position,
    constraints: &Constraints,
) -> Result<Way, Refusal> {
    let mut way = Way::default();
    let (end, rests) = match stop {
        Some(stop) => {
            let rest = (stop.plan.end, stop.plan.ticks());
            way.push(at, stop, Kind::Stop);
            rest
        }
        None => (of.plan.end, of.plan.ticks().max(at)),
    };
    let line = Motion {
        plan: plan_line(of.plan.id + 2, end, to, constraints)?,
        from: at_rest(end),
    };
    way.push(rests, line, Kind::Line);
    Ok(way)
}

/// The stop out of a motion; none where it comes to rest as soon by itself.
fn stopped(of: &Motion, at: u64, constraints: &Constraints) -> Option<Motion> {
    let id = of.plan.id + 1;
    Some(Motion {
        plan: plan_stop(id, &of.plan, &of.from, at, constraints, Stop::Smooth)?,
        from: of.state_after(at),
    })
}

impl Way {
    fn push(&mut self, left: u64, motion: Motion, kind: Kind) {
        self.steps.push(Step { left, motion, kind });
    }

    /// Ticks from tick `at` of the motion that was left to rest at the target.
    pub fn ticks(&self, at: u64) -> u64 {
        let until_last: u64 = self.steps.iter().map(|step| step.left).sum();
        let last = self.steps.last().map_or(0, |step| step.motion.plan.ticks());
        until_last - at + last
    }

    /// Whether its last plan ends at a target.
    pub fn leads_to(&self, to: &Position) -> bool {
        (self.steps.last()).is_some_and(|step| step.motion.plan.end == *to)
    }

    /// Whether it comes to rest before.
    pub fn rests_before(&self) -> bool {
        self.steps.iter().any(|step| step.kind == Kind::Line)
    }

    /// What is under way at tick `tick` of the motion that was left, counted on from there, and its own tick.
    pub fn under_way<'a>(&'a self, of: &'a Motion, mut tick: u64) -> (&'a Motion, u64) {
        let mut now = of;
        for step in &self.steps {
            if tick < step.left {
                break;
            }
            tick -= step.left;
            now = &step.motion;
        }
        (now, tick)
    }
}
