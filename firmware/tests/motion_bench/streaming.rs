//! A stream between a sender and the tick: what is sent when, what the tick makes of it.

use super::exact::Worst;
use super::follower;
use super::{AXIS_UNIT, LIMITS, at_rest};
use firmware::motion::{
    AxisState, Clock, Constraints, Plan, PlanProgress, Position, PushError, Stream, StreamEnd,
    StreamStep,
};

/// How targets arrive.
pub struct Sender {
    /// Ticks between two of them, as the stream is told.
    pub period: f64,
    /// The same by the sender's own clock.
    pub true_period: f64,
    /// Ticks by which each is late.
    pub late: fn(u64) -> f64,
    pub clock: Clock,
}

impl Sender {
    /// In time, by the loop's clock.
    pub fn steady(period: f64) -> Self {
        Self {
            period,
            true_period: period,
            late: |_| 0.0,
            clock: Clock::Sender,
        }
    }
}

/// What came of it.
pub struct Run {
    /// Position of the three axes at every tick, track radii and turns.
    pub path: Vec<[f64; 3]>,
    /// Tick at which the motion started.
    pub started: u64,
    pub end: Option<StreamEnd>,
    /// Everything that was set, against exact kinematics.
    pub worst: Worst,
    /// Largest steps of velocity and acceleration between ticks: of x, y and theta, per tick.
    pub steps: [f64; 2],
    pub rest: Position,
    /// Fewest and most targets that were waiting, once the motion was under way for a while.
    pub waiting: [usize; 2],
    pub plans: u32,
}

/// Runs a stream of `targets` from rest at `start` until it is over and at rest. With `quiet` the end is not announced.
pub fn run(
    start: Position,
    targets: impl Iterator<Item = Position>,
    sender: &Sender,
    constraints: &Constraints,
    quiet: bool,
) -> Run {
    let mut targets = targets.peekable();
    let mut stream = Stream::new(start, sender.period, sender.clock).expect("a period");
    let mut motion = follower();
    motion.rest_at(start);
    let mut course: Option<(Plan, [AxisState; 3])> = None;
    let mut pending: Option<(Plan, [AxisState; 3])> = None;
    let mut out = Run {
        path: Vec::new(),
        started: 0,
        end: None,
        worst: Worst::default(),
        steps: [0.0; 2],
        rest: start,
        waiting: [usize::MAX, 0],
        plans: 0,
    };
    let mut sent = 0;
    let mut last = at_rest(start);
    for tick in 0.. {
        while targets.peek().is_some()
            && sent as f64 * sender.true_period + (sender.late)(sent) <= tick as f64
        {
            match stream.push(*targets.peek().unwrap(), constraints) {
                Ok(()) | Err(PushError::Refused(_)) => {}
                Err(PushError::Full) => panic!("full after {sent}"),
                Err(PushError::Over) => {}
            }
            targets.next();
            sent += 1;
            if targets.peek().is_none() && !quiet {
                stream.finish();
            }
        }
        let (plan, done) = motion.progress();
        let progress = PlanProgress {
            plan,
            tick: done,
            moving: motion.is_moving(),
        };
        match stream.next(out.plans + 1, &progress, constraints) {
            StreamStep::Wait => {}
            StreamStep::Send(plan, start) => {
                out.plans += 1;
                if out.plans == 1 {
                    out.started = tick;
                }
                motion.accept(&plan).expect("in time");
                // What the tick would do if nothing came any more.
                if out.plans % 7 == 1 {
                    out.worst.walk(&plan, &start, constraints);
                }
                pending = Some((plan, start));
            }
            StreamStep::Over(end) => {
                out.end = Some(end);
                if !motion.is_moving() {
                    break;
                }
            }
        }
        motion.advance();
        if pending
            .as_ref()
            .is_some_and(|(plan, _)| plan.id == motion.progress().0)
        {
            course = pending.take();
        }
        let state = match &course {
            Some((plan, start)) => plan.state_after(start, motion.progress().1),
            None => at_rest(start),
        };
        assert_eq!(state.map(|axis| axis.rounded()), motion.position());
        // What is worst lasts longer than a millisecond.
        if tick % 8 == 0 {
            out.worst.look(&state, constraints);
        }
        for i in 0..3 {
            let step = (state[i].velocity - last[i].velocity) as f64 / AXIS_UNIT * LIMITS.rate_hz;
            let force = (state[i].acceleration - last[i].acceleration) as f64 / AXIS_UNIT
                * LIMITS.rate_hz.powi(2);
            out.steps = [out.steps[0].max(step.abs()), out.steps[1].max(force.abs())];
        }
        last = state;
        out.path
            .push(state.map(|axis| axis.position as f64 / AXIS_UNIT));
        if out.started > 0 && tick > out.started + 20_000 && targets.peek().is_some() {
            let waiting = firmware::motion::STREAM_CAPACITY - stream.free_places();
            out.waiting = [out.waiting[0].min(waiting), out.waiting[1].max(waiting)];
        }
    }
    out.rest = motion.position();
    out
}
