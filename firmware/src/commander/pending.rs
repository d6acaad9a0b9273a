//! What is asked of the stage and not handed over to the tick yet: the command side's state machine.
//!
//! A request for motion is carried out at once where that can be. What has to wait, because the stage moves or because
//! the planning takes several steps, waits here as one of the variants of [`Pending`]. There is room for one thing to
//! do and one to follow it; what is asked later takes the place of what was asked before.
//!
//! | state | what happens next, as soon as nothing is in flight |
//! |---|---|
//! | `Nothing` | nothing |
//! | `Goal` | at rest: a plan from rest; in motion: a jog at once; for a target a stop, and then a first way that takes its place |
//! | `Improving` | the soonest way to the goal, which takes over from the first if it saves enough |
//! | `GoalInStop` | the soonest way to the goal, once the stop is under way, or out of the end of the motion itself |
//! | `GoalFromRest` | a plan from rest, once the stage holds |
//! | `Stop` | a stop for the plan under way |
//! | `StopThenGoal` | the same, and the goal stays |
//! | `Stream` | plans of the stream, one after the other, until it is over |
//! | `GoalThenStream` | a plan from rest to where the waveforms begin |
//!
//! | event | `Nothing` | `Goal` | `Improving` | `GoalInStop` | `GoalFromRest` | `Stop` | `StopThenGoal` | `Stream` |
//! |---|---|---|---|---|---|---|---|---|
//! | a goal, at rest | sent: `Nothing` | sent: `Nothing` | sent: `Nothing` | sent: `Nothing` | sent: `Nothing` | sent: `Stop` | | refused |
//! | a goal, in motion | as `Goal` here | `Goal`, the new one | `Goal`, the new one | `Goal`, the new one | `Goal`, the new one | `StopThenGoal` | `StopThenGoal`, the new one | refused |
//! | a stop | `Stop` | `Stop` | `Stop` | `Stop` | `Stop` | `Stop`, the more urgent | `Stop`, the more urgent | `Stop` |
//! | planned: the stop before a target | | sent: `Goal` | | | | | | |
//! | planned: a way to it | | a target's sent: `Improving`, a jog: `Nothing` | sent: `Nothing` | sent: `Nothing` | | | | |
//! | planned: none without rest | | `GoalInStop`, a jog `StopThenGoal` or in a stop `GoalFromRest` | `Nothing` | `GoalFromRest` | | | | |
//! | planned: refused | | `Nothing`, and an error | `Nothing` | `GoalFromRest` | `Nothing`, and an error | | | |
//! | the tick takes a plan | the same | the same | the same | the same | the same | the same | the same | the same |
//! | the tick takes the stop | | | | | | `Nothing` | `Goal` | |
//! | the tick refuses a plan | `Goal` again; a better way: the same | | `Goal` again | | | | | `GoalThenStream`; of the stream: `Nothing`, and an error |
//! | the tick refuses the stop | | the same | | | | the same | the same | |
//! | the stage holds | | sent: `Nothing` | `Nothing` | sent: `Nothing` | sent: `Nothing` | `Nothing` | `Goal` | |
//! | the stage is off or at fault | | `Nothing` | `Nothing` | `Nothing` | `Nothing` | `Nothing` | `Nothing` | `Nothing` |
//!
//! What is in flight ([`InFlight`](super::in_flight::InFlight)) and what is under way (the plans that the tick has
//! taken) are apart from this: a stop, a goal or a servo switched off may come at any moment of either, so every
//! combination with the states above occurs. While something is in flight nothing is decided; only requests and
//! acknowledgements change the state.

use super::sent_plan::Goal;
use super::stream_source::Streaming;
use crate::motion::Stop;

/// See the module.
// There is no heap to box a stream in, and there is one of these.
#[allow(clippy::large_enum_variant)]
pub(super) enum Pending {
    /// Nothing is asked.
    Nothing,
    /// To get to a goal, or to keep a velocity.
    Goal(Goal),
    /// On the way to a goal; there may be a sooner one.
    Improving(Goal),
    /// To get to a goal, to which no first way has been found: out of the stop, or of the end of the motion, under way.
    GoalInStop(Goal),
    /// To get to a goal, to which there is no way without coming to rest before.
    GoalFromRest(Goal),
    /// To come to rest.
    Stop(Stop),
    /// To stop, and to get to a goal from there: from the stop as soon as there is a way, from rest at the latest.
    StopThenGoal(Stop, Goal),
    /// To follow targets.
    Stream(Streaming),
    /// The tick has refused the way to where waveforms begin: once more, then the waveforms.
    GoalThenStream(Goal, Streaming),
}

impl Pending {
    /// The stop that is pending.
    pub const fn stop(&self) -> Option<Stop> {
        match self {
            Self::Stop(stop) | Self::StopThenGoal(stop, _) => Some(*stop),
            _ => None,
        }
    }

    /// The goal that is pending.
    pub const fn goal(&self) -> Option<&Goal> {
        match self {
            Self::Goal(goal)
            | Self::GoalInStop(goal)
            | Self::GoalFromRest(goal)
            | Self::StopThenGoal(_, goal)
            | Self::GoalThenStream(goal, _) => Some(goal),
            _ => None,
        }
    }

    /// The stream that is under way, or about to be.
    pub const fn stream(&self) -> Option<&Streaming> {
        match self {
            Self::Stream(streaming) | Self::GoalThenStream(_, streaming) => Some(streaming),
            _ => None,
        }
    }

    /// The same, to be changed.
    pub const fn stream_mut(&mut self) -> Option<&mut Streaming> {
        match self {
            Self::Stream(streaming) | Self::GoalThenStream(_, streaming) => Some(streaming),
            _ => None,
        }
    }

    /// Whether a motion is asked for.
    pub const fn is_motion(&self) -> bool {
        !matches!(self, Self::Nothing | Self::Improving(_) | Self::Stop(_))
    }

    /// A stop is asked for: whatever else was is over. An urgent one stays urgent.
    pub fn request_stop(&mut self, stop: Stop) {
        let stop = match self.stop() {
            Some(Stop::Urgent) => Stop::Urgent,
            _ => stop,
        };
        *self = Self::Stop(stop);
    }

    /// The stream, if its next plan can be asked for. Waveforms wait until the stage stands where they begin.
    pub fn take_stream(&mut self) -> Option<Streaming> {
        if !matches!(self, Self::Stream(_)) {
            return None;
        }
        match self.take() {
            Self::Stream(streaming) => Some(streaming),
            _ => None,
        }
    }

    /// The goal, a stop before it if that is pending already.
    pub const fn with_goal(stop: Option<Stop>, goal: Goal) -> Self {
        match stop {
            None => Self::Goal(goal),
            Some(stop) => Self::StopThenGoal(stop, goal),
        }
    }

    /// The goal is reached, or sent, or given up.
    pub fn drop_goal(&mut self) {
        match self {
            Self::Goal(_) | Self::GoalInStop(_) | Self::GoalFromRest(_) => *self = Self::Nothing,
            Self::StopThenGoal(stop, _) => *self = Self::Stop(*stop),
            Self::GoalThenStream(..) => {
                if let Self::GoalThenStream(_, streaming) = self.take() {
                    *self = Self::Stream(streaming);
                }
            }
            Self::Nothing | Self::Improving(_) | Self::Stop(_) | Self::Stream(_) => {}
        }
    }

    /// There is nothing to stop any more, or it is being stopped.
    pub fn drop_stop(&mut self) {
        match self {
            Self::Stop(_) => *self = Self::Nothing,
            Self::StopThenGoal(_, goal) => *self = Self::Goal(*goal),
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
    pub fn plan_refused(&mut self, goal: Goal) {
        match self {
            Self::Nothing | Self::Improving(_) => *self = Self::Goal(goal),
            Self::Stream(_) => {
                if let Self::Stream(streaming) = self.take() {
                    *self = Self::GoalThenStream(goal, streaming);
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
