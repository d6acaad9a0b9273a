//! What planning and following cost on this machine, beside rsruckig: `cargo bench -p firmware-cost --bench planning`.
//!
//! Both are given the same random states, those of `cargo cost`, which counts instructions on the chip. They are asked
//! in turn, some states at a time, again and again, and for each state the fastest counts: what disturbs a timing only
//! ever adds to it. What matters is the ratio. `STATES=10000` in the environment takes more states, `SEED` others.
//!
//! rsruckig takes the axes by themselves: it knows neither the mechanism, whose limits the planners look after along
//! the whole way, nor a straight line. Under way, what it takes to find the setpoint is timed over many ticks in a row:
//! one is over before a clock is read.
//!
//! Where a target needs a stop first, ours is the plan of the stop; none where the plan under way is that stop already.

mod reference;

use firmware::motion::{
    AxisState, Effort, LoneFollower, Plan, PlanSlots, Position, SetpointScale, StreamStep,
    plan_line, plan_retarget,
};
use firmware_cost::random::Random;
use firmware_cost::states::{Moving, ground, position, way};
use firmware_cost::streaming::Streaming;
use reference::asked;
use rsruckig::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// States after which it is the other's turn.
const BLOCK: usize = 25;
const ROUNDS: u32 = 40;
/// Ticks in a row, and plans that last as long.
const TICKS: u32 = 500;
const PERIOD_S: f64 = 50e-6;
/// Ticks between two streamed targets, as in `cargo cost`: 333, 200 and 100 Hz.
const STREAM: [u64; 3] = [60, 100, 200];

type Reference = Ruckig<3, ThrowErrorHandler>;

fn main() {
    let run = Run {
        seed: setting("SEED", 1) as u32,
        states: setting("STATES", 2_000).max(1) as u32,
    };
    println!("seed {}, {} states each", run.seed, run.states);
    println!(
        "{:<42}{:>10}{:>10}{:>8}",
        "ns, median", "ours", "rsruckig", "ratio"
    );
    let (mut ruckig, mut trajectory) = (Reference::new(None, PERIOD_S), Trajectory::new(None));
    let mut asks = |input: &_| ruckig.calculate(input, black_box(&mut trajectory)).is_ok();
    run.compare(
        "straight line from rest",
        1,
        |random| {
            let (from, to) = way(random);
            (from, to, asked(&from.map(AxisState::at_rest), &to))
        },
        |(from, to, _)| plan_line(3, *from, *to, ground()).is_ok(),
        |(.., input)| asks(input),
    );
    run.compare(
        "new target in motion",
        1,
        |random| loop {
            let (now, to) = (Moving::new(random), position(random));
            // Where a stop is sooner there is nothing to compare.
            if retargeted(&now, to) {
                let input = asked(&now.state(), &to);
                return (now, to, input);
            }
        },
        |(now, to, _)| retargeted(now, *to),
        |(.., input)| asks(input),
    );
    run.compare(
        "streamed target",
        1,
        |random| {
            let mut streaming = Streaming::default();
            let to = streaming.prepare(random, STREAM);
            // Through it about as fast as it is now, to be fair: at rest there it would have to turn back.
            let mut input = asked(&streaming.state, &to);
            input.target_velocity = input.current_velocity.clone();
            (streaming, to, input)
        },
        |(streaming, to, _)| matches!(streaming.take(*to), Some(StreamStep::Send(..))),
        |(.., input)| asks(input),
    );
    let scale = SetpointScale::new(ground().limits.rate_hz);
    run.compare(
        "next setpoint in the tick",
        TICKS,
        under_way,
        |(motion, _)| {
            for _ in 0..TICKS {
                motion.advance();
                black_box(motion.setpoint(&scale));
            }
            motion.is_moving()
        },
        |(_, trajectory)| {
            for tick in 1..=TICKS {
                black_box(setpoint(trajectory, f64::from(tick) * PERIOD_S));
            }
            true
        },
    );
}

/// What is asked for.
struct Run {
    seed: u32,
    states: u32,
}

impl Run {
    /// Times both on the same states, `calls` calls a state, and prints a line. Each says whether it has found
    /// anything.
    fn compare<S>(
        &self,
        what: &str,
        calls: u32,
        prepare: impl Fn(&mut Random) -> S,
        ours: impl Fn(&mut S) -> bool,
        mut theirs: impl FnMut(&mut S) -> bool,
    ) {
        let [mut own, mut beside] = [0; 2].map(|none| Times {
            fastest_s: vec![f64::INFINITY; self.states as usize],
            none,
        });
        for _ in 0..ROUNDS {
            for first in (0..self.states).step_by(BLOCK) {
                let calls = first..self.states.min(first + BLOCK as u32);
                let mut block: Vec<_> = calls
                    .map(|call| (call as usize, prepare(&mut Random::new(self.seed, call))))
                    .collect();
                own.take(&mut block, &ours);
                beside.take(&mut block, &mut theirs);
            }
        }
        let [ours, theirs] = [&mut own, &mut beside].map(|times| times.median_ns(calls));
        let ratio = theirs / ours;
        println!("{what:<42}{ours:>10.0}{theirs:>10.0}{ratio:>8.2}");
        let [own, beside] = [own.none, beside.none].map(|none| none / ROUNDS);
        if own + beside > 0 {
            let name = format!("    of {}, without a plan", self.states);
            println!("{name:<42}{own:>10}{beside:>10}");
        }
    }
}

/// Of one of the two: the fastest of all rounds for each state, and how often nothing was found in them.
struct Times {
    fastest_s: Vec<f64>,
    none: u32,
}

impl Times {
    fn take<S>(&mut self, block: &mut [(usize, S)], mut work: impl FnMut(&mut S) -> bool) {
        for (call, state) in block {
            let start = Instant::now();
            let found = work(black_box(state));
            let fastest = &mut self.fastest_s[*call];
            *fastest = fastest.min(start.elapsed().as_secs_f64());
            self.none += u32::from(!found);
        }
    }

    fn median_ns(&mut self, calls: u32) -> f64 {
        self.fastest_s.sort_by(f64::total_cmp);
        self.fastest_s[self.fastest_s.len() / 2] * 1e9 / f64::from(calls)
    }
}

/// A plan that the tick has taken, and rsruckig's from the same state to the same end.
fn under_way(random: &mut Random) -> (LoneFollower<'static>, Trajectory<3>) {
    loop {
        let now = Moving::new(random);
        let input = asked(&now.start, &now.plan.end);
        let mut trajectory = Trajectory::new(None);
        let planned = Reference::new(None, PERIOD_S).calculate(&input, &mut trajectory);
        let (plan, from): (Plan, _) = now.begun_at_rest();
        let mut motion = LoneFollower::new(Box::leak(Box::new(PlanSlots::new())));
        motion.rest_at(from);
        if plan.ticks() > u64::from(TICKS) && planned.is_ok() && motion.accept(&plan).is_ok() {
            return (motion, trajectory);
        }
    }
}

/// Position, velocity and acceleration.
fn setpoint(trajectory: &Trajectory<3>, time_s: f64) -> [DataArrayOrVec<f64, 3>; 3] {
    let mut all = [const { DataArrayOrVec::Stack([0.0; 3]) }; 3];
    let [position, velocity, acceleration] = &mut all;
    trajectory.at_time(
        time_s,
        &mut Some(position),
        &mut Some(velocity),
        &mut Some(acceleration),
        &mut None,
        &mut None,
    );
    all
}

/// All slices of a new target; whether there is a way to it without a stop before.
fn retargeted(now: &Moving, to: Position) -> bool {
    plan_retarget(
        3,
        &now.plan,
        &now.start,
        now.at,
        to,
        ground(),
        Effort::FIRST,
    )
    .is_ok()
}

/// A number from the environment.
fn setting(name: &str, otherwise: u64) -> u64 {
    let set = std::env::var(name).ok().and_then(|text| text.parse().ok());
    set.unwrap_or(otherwise)
}
