//! Random motions under way, on the reference stage.

use crate::motion_bench::at_rest;
use crate::motion_bench::random::Random;
use crate::planner::{Kind, Motion, retargeted};
use firmware::motion::{Constraints, PlanStart, Stop, plan_jog, plan_line, plan_stop};
use std::f64::consts::TAU;

/// One time in two.
pub fn either(random: &mut Random) -> bool {
    random.unit() < 0.5
}

/// One of so many ticks, but not the first: nothing moves there yet.
pub fn tick(random: &mut Random, of: u64) -> u64 {
    1 + (random.unit() * of.saturating_sub(1) as f64) as u64
}

/// From anywhere in the disk to anywhere, at any orientations.
pub fn line(random: &mut Random, constraints: &Constraints) -> Option<Motion> {
    let [from, to] = [0; 2].map(|_| random.place(constraints));
    let plan = plan_line(1, from, to, constraints).ok()?;
    let from = at_rest(from);
    (plan.ticks() > 0).then_some(Motion { plan, from })
}

/// A stop, as often smooth as urgent, at any tick of a line; none where the line comes to rest as soon.
pub fn stop(random: &mut Random, constraints: &Constraints) -> Option<Motion> {
    let line = line(random, constraints)?;
    let at = tick(random, line.plan.ticks());
    let how = if either(random) {
        Stop::Smooth
    } else {
        Stop::Urgent
    };
    Some(Motion {
        plan: plan_stop(2, &line.plan, &line.from, at, constraints, how)?,
        from: line.state_after(at),
    })
}

/// A jog, as often from rest anywhere as out of any tick of a line.
pub fn jog(random: &mut Random, constraints: &Constraints) -> Option<Motion> {
    let line = line(random, constraints)?;
    let (at, start) = if either(random) {
        (0, PlanStart::Rest(line.from.map(|axis| axis.rounded())))
    } else {
        let tick = tick(random, line.plan.ticks());
        (tick, PlanStart::Splice { plan: 1, tick })
    };
    let from = line.state_after(at);
    let velocity = velocity(random, constraints);
    let plan = plan_jog(2, start, &from, &velocity, constraints).ok()?;
    (plan.ticks() > 0).then_some(Motion { plan, from })
}

/// Within the limits of speed, mm/s and deg/s; an axis in three has none.
fn velocity(random: &mut Random, constraints: &Constraints) -> [f64; 3] {
    let speed = constraints.limits.speed_mm_s * random.unit();
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    let turning = constraints.limits.turn_speed_deg_s * (2.0 * random.unit() - 1.0);
    [speed * cos, speed * sin, turning].map(|velocity| {
        let is_still = random.unit() < 1.0 / 3.0;
        if is_still { 0.0 } else { velocity }
    })
}

/// The way to another target out of any tick of a motion, as the planner under test plans it; none where that comes to
/// rest before.
pub fn retarget(random: &mut Random, of: &Motion, constraints: &Constraints) -> Option<Motion> {
    let at = tick(random, of.plan.ticks());
    let to = random.place(constraints);
    let mut way = retargeted(of, at, to, constraints).ok()?;
    way.steps
        .pop()
        .filter(|step| step.kind == Kind::Transition)
        .map(|step| step.motion)
}
