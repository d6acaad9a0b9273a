//! A stream: the targets that wait, what has been sent of them, the sender's clock; and what goes between a stream, its sender and
//! the tick.

use super::knot::Knot;
use super::spline::WINDOW;
use heapless::Deque;
use motion::check::target::check_target;
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
pub(super) const BEFORE: usize = WINDOW - 1;

/// Fraction bits of a place between two targets.
pub(super) const PART_BITS: u32 = 48;

/// A plan that was sent.
#[derive(Clone, Copy, Debug)]
pub(super) struct SentPlan {
    pub(super) id: u32,
    /// Its tick at which the stop begins, or the next plan.
    pub(super) splice: u64,
    /// The axes there.
    pub(super) state: [AxisState; 3],
}

/// A stream of targets, from rest.
#[derive(Clone, Debug)]
pub struct Stream {
    /// The window of the curve in front.
    pub(super) targets: Deque<Position, STREAM_CAPACITY>,
    pub(super) knot: Knot,
    pub(super) knots: u32,
    pub(super) clock: Clock,
    /// Targets a tick, 2^-48: what the sender says, and as it is followed.
    pub(super) nominal: u64,
    pub(super) rate: u64,
    /// Place between the window's third target and the fourth, 2^-48.
    pub(super) part: u64,
    /// Targets more than there should be, averaged.
    pub(super) surplus: f32,
    pub(super) sent: Option<SentPlan>,
    pub(super) before: Option<SentPlan>,
    pub(super) announced: bool,
    /// The curve has come to its last target.
    pub(super) complete: bool,
    pub(super) end: Option<StreamEnd>,
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
}
