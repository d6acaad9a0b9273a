//! Targets that arrive one after the other, at a rate below the control rate, as one smooth motion.
//!
//! ```text
//!  sender      o  o   o o  o  o  o         at the sender's clock, with jitter
//!               \  \  | |  |  |  |
//!  queue        [ reserve | window ]       a few targets wait, so that one may be late
//!                            |
//!  curve          ~~~~~~~~~~~              a spline through them (`curve`)
//!                  |   |   |
//!  plans          [k k k|stop]             knots on the curve, three pieces of constant jerk each (`curve`), and a stop
//!                       [k k k|stop]       that the next plan takes the place of (`plans`)
//! ```
//!
//! Every plan ends in a stop of its own. A stream that dries up comes to rest by itself, with nobody's help, within the
//! limits and the workspace; so does one whose next target asks for too much, which is refused.
//!
//! Position, velocity and acceleration of the setpoint have no steps, as in any plan. What the targets ask for is held
//! against the limits of speed, acceleration, the pivots and the workspace all along ([`motion::check`]), with a tolerance of
//! a thousandth.
//! Jerk is the sender's own business within [`JERK_TOLERANCE`](motion::tolerances::JERK_TOLERANCE) times its limit: samples that are rounded, or a path
//! with corners in its acceleration, have no better.
//!
//! The distance of the samples in time is what the sender says it is, not when they arrive. A sender whose clock
//! differs a little (up to 0.05 %) is followed: the curve is passed as much faster or slower as keeps the reserve.
//!
//! | file | idea |
//! |---|---|
//! | here | the targets that wait, what has been sent of them, which plan is sent when; the sender's clock |
//! | `plans` | a plan: knots along the curve, held against every limit, and the stop at its end |
//! | `curve` | the curve through the targets, and the pieces from knot to knot |

mod curve;
mod plans;

use curve::{Knot, WINDOW};
use heapless::Deque;
use motion::check::workspace::check_target;
use motion::constraints::Constraints;
use motion::plan::axis_state::AxisState;
use motion::plan::{Plan, Position};
use motion::refusal::Refusal;

/// Whose clock the targets follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The sender, whose clock is followed.
    Sender,
    /// The control loop: targets are made as they are asked for.
    Own,
}

/// Why no target is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PushError {
    /// As many wait as can: the sender is too fast.
    Full,
    /// The stream is over, or its end has been announced.
    Over,
    /// The target lies outside of the workspace. The stream ends before it.
    Refused(Refusal),
}

/// How a stream came to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StreamEnd {
    /// At its last target, as announced.
    Done,
    /// No target came in time: a stop is under way, or done.
    Starved,
    /// A target asked for too much: a stop before it is under way, or done.
    Refused(Refusal),
}

/// What is to be done next.
#[derive(Clone, Debug, PartialEq)]
// A plan is what it is all about; there is no heap to box it in.
#[allow(clippy::large_enum_variant)]
pub enum StreamStep {
    /// Nothing yet.
    Wait,
    /// This plan is to be sent to the tick at once; it starts from these axes.
    Send(Plan, [AxisState; 3]),
    /// The stream is over.
    Over(StreamEnd),
}

/// The plan that the tick was on when last heard of, ticks of it done, and whether it is under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanProgress {
    /// Identity.
    pub plan: u32,
    /// Ticks.
    pub tick: u64,
    /// Whether anything is under way.
    pub moving: bool,
}

/// Targets that can wait.
pub const STREAM_CAPACITY: usize = 32;

/// Ticks between two targets: from 2 kHz at a control rate of 20 kHz down to a target in 100 ms.
pub const PERIOD_RANGE: core::ops::RangeInclusive<f64> = 10.0..=2_000.0;

/// Ticks that a plan lasts at least before its stop: time to send the next.
const LEAST_AHEAD: u32 = 60;

/// Knots of a plan at most: three pieces each, and four of the stop, have to fit.
const MOST_KNOTS: u32 = 6;

/// Targets that may be late.
const RESERVE: usize = 2;

/// Copies of the start in the window at first: the curve then leaves it at rest.
const BEFORE: usize = WINDOW - 1;

/// Fraction bits of a place between two targets.
const PART_BITS: u32 = 48;
const ONE: f32 = (1_u64 << PART_BITS) as f32;

/// A clock of the sender's own: how much faster the curve is passed for a target too many, as a share; how much at
/// most; and over how many plans the number of targets is averaged.
const FOLLOWING: f32 = 5e-4;

const MOST_FOLLOWING: f32 = 2e-3;

const AVERAGED: f32 = 32.0;

/// A plan that was sent.
#[derive(Clone, Copy, Debug)]
struct SentPlan {
    id: u32,
    /// Its tick at which the stop begins, or the next plan.
    splice: u64,
    /// The axes there.
    state: [AxisState; 3],
}

/// A stream of targets, from rest.
#[derive(Clone, Debug)]
pub struct Stream {
    /// The window of the curve in front.
    targets: Deque<Position, STREAM_CAPACITY>,
    knot: Knot,
    knots: u32,
    clock: Clock,
    /// Targets a tick, 2^-48: what the sender says, and as it is followed.
    nominal: u64,
    rate: u64,
    /// Place between the window's third target and the fourth, 2^-48.
    part: u64,
    /// Targets more than there should be, averaged.
    surplus: f32,
    sent: Option<SentPlan>,
    before: Option<SentPlan>,
    announced: bool,
    /// The curve has come to its last target.
    complete: bool,
    end: Option<StreamEnd>,
}

impl Stream {
    /// A stream from rest at `start`, of targets `period` ticks apart; `None` unless that is in [`PERIOD_RANGE`].
    pub fn new(start: Position, period: f64, clock: Clock) -> Option<Self> {
        if !PERIOD_RANGE.contains(&period) {
            return None;
        }
        let ticks = libm::rint(period) as u32;
        let nominal = ((1_u64 << PART_BITS) as f64 / period) as u64;
        let mut targets = Deque::new();
        for _ in 0..BEFORE {
            // There is room.
            let _ = targets.push_back(start);
        }
        Some(Self {
            targets,
            knot: Knot::new(ticks),
            knots: LEAST_AHEAD.div_ceil(ticks).clamp(1, MOST_KNOTS),
            clock,
            nominal,
            rate: nominal,
            part: 0,
            surplus: 0.0,
            sent: None,
            before: None,
            announced: false,
            complete: false,
            end: None,
        })
    }

    /// Targets that have to wait before the motion starts: two plans' worth, and the reserve.
    pub fn targets_to_start(&self) -> usize {
        2 * self.knots as usize + 1 + RESERVE
    }

    /// From the arrival of a target to the setpoint's passing it, in periods.
    pub fn latency(&self) -> usize {
        // The curve is three samples behind the newest of its window.
        self.targets_to_start() + 2
    }

    /// Room for targets.
    pub fn free_places(&self) -> usize {
        STREAM_CAPACITY - self.targets.len()
    }

    /// Takes a target.
    pub fn push(&mut self, target: Position, constraints: &Constraints) -> Result<(), PushError> {
        if self.announced || self.end.is_some() {
            return Err(PushError::Over);
        }
        if let Err(refusal) = check_target(&target, constraints) {
            self.end = Some(StreamEnd::Refused(refusal));
            return Err(PushError::Refused(refusal));
        }
        self.targets.push_back(target).map_err(|_| PushError::Full)
    }

    /// The last target has been sent: the motion ends there.
    pub fn finish(&mut self) {
        self.announced = true;
    }

    /// Whether there is nothing to be done yet: a plan has been sent, and the tick is still on the one before, or on the last of
    /// all. Asked first, it spares the way to [`next`](Self::next).
    pub fn waits(&self, progress: &PlanProgress) -> bool {
        self.end.is_none()
            && self.sent.is_some_and(|sent| {
                if progress.plan == sent.id {
                    self.complete && progress.moving
                } else {
                    !self.is_late(progress)
                }
            })
    }

    /// Whether the last plan that was sent has come too late: the one before is past its end.
    fn is_late(&self, progress: &PlanProgress) -> bool {
        (self.before)
            .is_some_and(|before| progress.plan == before.id && progress.tick > before.splice)
    }

    /// What is to be done, `id` being the identity of a plan to come. To be asked whenever there is news of the tick.
    pub fn next(
        &mut self,
        id: u32,
        progress: &PlanProgress,
        constraints: &Constraints,
    ) -> StreamStep {
        if let Some(end) = self.end {
            return StreamStep::Over(end);
        }
        let Some(sent) = self.sent else {
            let waiting = self.targets.len() - BEFORE;
            return if waiting >= self.targets_to_start() || (self.announced && waiting > 0) {
                self.send(id, None, constraints)
            } else if self.announced {
                self.over(StreamEnd::Done)
            } else {
                StreamStep::Wait
            };
        };
        if progress.plan != sent.id {
            return if self.is_late(progress) {
                self.over(StreamEnd::Starved)
            } else {
                StreamStep::Wait
            };
        }
        if self.complete {
            return if progress.moving {
                StreamStep::Wait
            } else {
                self.over(StreamEnd::Done)
            };
        }
        if progress.tick > sent.splice || !progress.moving {
            return self.over(StreamEnd::Starved);
        }
        self.follow(sent.splice - progress.tick);
        self.send(id, Some(sent), constraints)
    }

    fn over(&mut self, end: StreamEnd) -> StreamStep {
        self.end = Some(end);
        StreamStep::Over(end)
    }

    /// Follows the sender's clock by the number of targets that are left `ticks` before the end of what is planned.
    fn follow(&mut self, ticks: u64) {
        if self.clock == Clock::Own || self.announced {
            return;
        }
        let ahead = self.targets.len() as f32
            + (ticks as f32 * self.rate as f32 - self.part as f32) / ONE
            - (BEFORE + self.targets_to_start()) as f32;
        self.surplus += (ahead - self.surplus) / AVERAGED;
        let faster = (self.surplus * FOLLOWING).clamp(-MOST_FOLLOWING, MOST_FOLLOWING);
        // Of a small share single precision is enough.
        let more = (self.nominal as f32 * faster) as i64;
        self.rate = self.nominal.wrapping_add_signed(more);
    }

    /// The next plan, if there are targets enough for it.
    fn send(&mut self, id: u32, sent: Option<SentPlan>, constraints: &Constraints) -> StreamStep {
        let ahead = self.part + u64::from(self.knots) * self.knot.whole() * self.rate;
        let needed = (ahead >> PART_BITS) as usize + WINDOW;
        if self.targets.len() < needed && !self.announced {
            return StreamStep::Wait;
        }
        match self.plan(id, sent, constraints) {
            Ok((plan, start, sent)) => {
                self.before = self.sent.replace(sent);
                StreamStep::Send(plan, start)
            }
            Err(refusal) => self.over(StreamEnd::Refused(refusal)),
        }
    }
}
