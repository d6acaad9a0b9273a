//! What goes between a stream, its sender and the tick.

use motion::plan::Plan;
use motion::plan::axis_state::AxisState;
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
