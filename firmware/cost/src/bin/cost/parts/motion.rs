//! Planning: what the command side computes for a new target or a stop.

use crate::bench::Bench;
use crate::table::CallResult;
use firmware::motion::{
    AxisState, Effort, Plan, PlanStart, RetargetError, Stop, StreamStep, plan_jog, plan_line,
};
use firmware_cost::random::Random;
use firmware_cost::states::{Moving, ground, position, way};
use firmware_cost::streaming::Streaming;

/// Counts the planners.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    bench.part(
        "motion: line from rest",
        1,
        way,
        |(from, to)| plan_line(3, *from, *to, ground()),
        |_, plan| of_plan(plan.as_ref().ok()),
    );
    for (name, effort) in [
        ("motion: new target in motion, first way", Effort::FIRST),
        ("motion: new target in motion, soonest way", Effort::ALL),
    ] {
        bench.part(
            name,
            1,
            |random| (Moving::new(random), position(random)),
            |(now, to)| now.retargeted(*to, effort),
            |_, plan| of_plan(plan.as_ref().ok()),
        );
    }
    bench.part(
        "motion: jog from rest",
        1,
        |random| (position(random), velocity(random)),
        |(from, velocity)| {
            let state = from.map(AxisState::at_rest);
            plan_jog(3, PlanStart::Rest(*from), &state, velocity, ground())
        },
        |_, plan| of_plan(plan.as_ref().ok()),
    );
    bench.part(
        "motion: jog in motion",
        1,
        |random| (Moving::new(random), velocity(random)),
        |(now, velocity)| jog(now, velocity),
        |_, plan| of_plan(plan.as_ref()),
    );
    for (name, stop) in [
        ("motion: smooth stop", Stop::Smooth),
        ("motion: urgent stop", Stop::Urgent),
    ] {
        bench.part(
            name,
            1,
            Moving::new,
            |now| now.stopped(stop),
            |_, plan| of_plan(plan.as_ref()),
        );
    }
}

/// On at another velocity, or to a stop where that is no way.
fn jog(now: &Moving, velocity: &[f64; 3]) -> Option<Plan> {
    let state = now.state();
    let start = PlanStart::Splice {
        plan: now.plan.id,
        tick: now.at,
    };
    match plan_jog(3, start, &state, velocity, ground()) {
        Ok(plan) => Some(plan),
        Err(RetargetError::NeedsStop) => now.stopped(Stop::Smooth),
        Err(RetargetError::Refused(_)) => None,
    }
}

/// mm/s, mm/s and deg/s of a jog; some axes have none.
fn velocity(random: &mut Random) -> [f64; 3] {
    let limits = &ground().limits;
    [
        limits.speed_mm_s / 2.0,
        limits.speed_mm_s / 2.0,
        limits.turn_speed_deg_s / 2.0,
    ]
    .map(|most| {
        if random.once_in(3) {
            0.0
        } else {
            random.within(-most, most)
        }
    })
}

/// Counts targets that come one after the other.
#[inline(never)]
pub fn run_stream(bench: &mut Bench) {
    // One plan a target at up to 333 Hz; faster ones share plans, six at 2 kHz.
    for (name, periods) in [
        ("motion: streamed target", [60, 100, 200]),
        ("motion: plan of six streamed targets", [10, 11, 11]),
    ] {
        bench.part_with(
            name,
            1,
            &mut Streaming::default(),
            |streaming, random| streaming.prepare(random, periods),
            |streaming, target| streaming.take(*target),
            |_, next| match next {
                Some(StreamStep::Send(plan, _)) => of_plan(Some(plan)),
                _ => of_plan(None),
            },
        );
    }
}

fn of_plan(plan: Option<&Plan>) -> CallResult {
    CallResult {
        refused: plan.is_none(),
        ticks: plan.map_or(0, Plan::ticks),
    }
}
