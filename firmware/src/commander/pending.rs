//! What is asked of the stage and not handed over to the tick yet: the command side's state machine.
//!
//! A request for motion is carried out at once where that can be. What has to wait, because the stage moves or because
//! the planning takes several slices, waits here as one of the variants of [`Pending`]. There is room for one thing to
//! do and one to follow it; what is asked later takes the place of what was asked before.
//!
//! | state | what happens next, as soon as nothing is in flight |
//! |---|---|
//! | `Nothing` | nothing |
//! | `Goal` | at rest: a plan from rest; in motion: a plan that leaves the one under way, unless the goal needs rest first |
//! | `HeadSent` | the rest of that plan, of which the head is with the tick already |
//! | `Stop` | a stop for the plan under way |
//! | `StopThenGoal` | the same, and the goal stays |
//! | `Stream` | plans of the stream, one after the other, until it is over |
//! | `GoalThenStream` | a plan from rest to where the waveforms begin |
//! | `StopThenStream` | a plan of the stream, and then its stop: see there |
//!
//! | event | `Nothing` | `Goal`, `HeadSent` | `Stop` | `StopThenGoal` | `Stream` |
//! |---|---|---|---|---|---|
//! | a goal, at rest | sent: `Nothing` | sent: `Nothing` | sent: `Stop` | | refused |
//! | a goal, in motion | as `Goal` below | the new one's | `StopThenGoal` | `StopThenGoal`, the new goal | refused |
//! | a stop | `Stop` | `Stop` | `Stop`, the more urgent | `Stop`, the more urgent | `Stop` |
//! | planned: the whole way | | sent: `Nothing` | | | |
//! | planned: a head | | sent: `HeadSent` | | | |
//! | planned: too fast, or not without rest | | `StopThenGoal`; `Goal` if a stop or a head is under way | | | |
//! | planned: refused | | `Nothing`, and an error | | | |
//! | the tick takes a plan | the same | the same | the same | the same | the same |
//! | the tick takes the stop | | | `Nothing` | `Goal` | |
//! | the tick refuses a plan | `Goal` again | | | | `GoalThenStream`; of the stream: `Nothing`, and an error |
//! | the tick refuses the stop | | | the same | the same | |
//! | the stage holds | | | `Nothing` | `Goal` | |
//! | the stage is off or at fault | | `Nothing` | `Nothing` | `Nothing` | `Nothing` |
//!
//! What is in flight ([`InFlight`](super::in_flight::InFlight)) and what is under way (the plans that the tick has
//! taken) are apart from this: a stop, a goal or a servo switched off may come at any moment of either, so every
//! combination with the states above occurs. While something is in flight nothing is decided; only requests and
//! acknowledgements change the state.

use super::sent_plan::Goal;
use super::stream_source::Streaming;
use crate::motion::{Ahead, Stop, Tries};

/// A goal for a stage in motion, and how far the planning of the way to it has come.
#[derive(Clone, Copy)]
pub(super) struct Retarget {
    pub goal: Goal,
    /// There is no way to it without coming to rest before.
    pub needs_rest: bool,
    /// What has been tried.
    pub tries: Tries,
}

impl Retarget {
    /// Nothing has been tried yet.
    pub const fn new(goal: Goal) -> Self {
        Self {
            goal,
            needs_rest: false,
            tries: Tries::NONE,
        }
    }
}

/// See the module.
// There is no heap to box a stream or the rest of a plan in, and there is one of these.
#[allow(clippy::large_enum_variant)]
pub(super) enum Pending {
    /// Nothing is asked.
    Nothing,
    /// To get to a goal, or to keep a velocity.
    Goal(Retarget),
    /// The same; the head of the way is sent, this is what follows it.
    HeadSent(Retarget, Ahead),
    /// To come to rest.
    Stop(Stop),
    /// To stop, and to get to a goal from there: from the stop as soon as there is a way, from rest at the latest.
    StopThenGoal(Stop, Retarget),
    /// To follow targets.
    Stream(Streaming),
    /// The tick has refused the way to where waveforms begin: once more, then the waveforms.
    GoalThenStream(Retarget, Streaming),
    /// A stop came while the stage held, and stays pending until the next snapshot shows that there is nothing to stop.
    /// A stream that begins before that snapshot and sends a plan at once is stopped by it. (A goal that is sent then
    /// is stopped too: its state is `Stop`.)
    StopThenStream(Stop, Streaming),
}

impl Pending {
    /// The stop that is pending.
    pub const fn stop(&self) -> Option<Stop> {
        match self {
            Self::Stop(stop) | Self::StopThenGoal(stop, _) | Self::StopThenStream(stop, _) => {
                Some(*stop)
            }
            _ => None,
        }
    }

    /// The goal that is pending.
    pub const fn goal(&self) -> Option<&Retarget> {
        match self {
            Self::Goal(retarget)
            | Self::HeadSent(retarget, _)
            | Self::StopThenGoal(_, retarget)
            | Self::GoalThenStream(retarget, _) => Some(retarget),
            _ => None,
        }
    }

    /// The stream that is under way, or about to be.
    pub const fn stream(&self) -> Option<&Streaming> {
        match self {
            Self::Stream(streaming)
            | Self::GoalThenStream(_, streaming)
            | Self::StopThenStream(_, streaming) => Some(streaming),
            _ => None,
        }
    }

    /// The same, to be changed.
    pub const fn stream_mut(&mut self) -> Option<&mut Streaming> {
        match self {
            Self::Stream(streaming)
            | Self::GoalThenStream(_, streaming)
            | Self::StopThenStream(_, streaming) => Some(streaming),
            _ => None,
        }
    }

    /// Whether a motion is asked for.
    pub const fn is_motion(&self) -> bool {
        !matches!(self, Self::Nothing | Self::Stop(_))
    }

    /// A stop is asked for: whatever else was is over. An urgent one stays urgent.
    pub fn request_stop(&mut self, stop: Stop) {
        let stop = match self.stop() {
            Some(Stop::Urgent) => Stop::Urgent,
            _ => stop,
        };
        *self = Self::Stop(stop);
    }

    /// The stream, if its next plan can be asked for; a stop stays. Waveforms wait until the stage stands where they
    /// begin.
    pub fn take_stream(&mut self) -> Option<Streaming> {
        if !matches!(self, Self::Stream(_) | Self::StopThenStream(..)) {
            return None;
        }
        let stop = self.stop().map_or(Self::Nothing, Self::Stop);
        match core::mem::replace(self, stop) {
            Self::Stream(streaming) | Self::StopThenStream(_, streaming) => Some(streaming),
            _ => None,
        }
    }

    /// The goal, a stop before it if that is pending already.
    pub const fn with_goal(stop: Option<Stop>, retarget: Retarget) -> Self {
        match stop {
            None => Self::Goal(retarget),
            Some(stop) => Self::StopThenGoal(stop, retarget),
        }
    }

    /// A stream begins; a stop that is still pending stays.
    pub fn begin_stream(&mut self, streaming: Streaming) {
        *self = match self.stop() {
            None => Self::Stream(streaming),
            Some(stop) => Self::StopThenStream(stop, streaming),
        };
    }

    /// The goal is reached, or sent, or given up.
    pub fn drop_goal(&mut self) {
        match self {
            Self::Goal(_) | Self::HeadSent(..) => *self = Self::Nothing,
            Self::StopThenGoal(stop, _) => *self = Self::Stop(*stop),
            Self::GoalThenStream(..) => {
                if let Self::GoalThenStream(_, streaming) = self.take() {
                    *self = Self::Stream(streaming);
                }
            }
            Self::Nothing | Self::Stop(_) | Self::Stream(_) | Self::StopThenStream(..) => {}
        }
    }

    /// There is nothing to stop any more, or it is being stopped.
    pub fn drop_stop(&mut self) {
        match self {
            Self::Stop(_) => *self = Self::Nothing,
            Self::StopThenGoal(_, retarget) => *self = Self::Goal(*retarget),
            Self::StopThenStream(..) => {
                if let Self::StopThenStream(_, streaming) = self.take() {
                    *self = Self::Stream(streaming);
                }
            }
            _ => {}
        }
    }

    /// The tick has taken a stop: a more urgent one that has been asked for meanwhile is still to come.
    pub fn stop_taken(&mut self, stop: Stop) {
        if (self.stop(), stop) != (Some(Stop::Urgent), Stop::Smooth) {
            self.drop_stop();
        }
    }

    /// The tick has refused the plan to a goal, which is not where the setpoint was: once more from where it is, unless
    /// something else has been asked for meanwhile.
    pub fn plan_refused(&mut self, retarget: Retarget) {
        match self {
            Self::Nothing => *self = Self::Goal(retarget),
            Self::Stream(_) => {
                if let Self::Stream(streaming) = self.take() {
                    *self = Self::GoalThenStream(retarget, streaming);
                }
            }
            _ => {}
        }
    }

    /// What is pending; nothing is from now on.
    pub const fn take(&mut self) -> Self {
        core::mem::replace(self, Self::Nothing)
    }
}
