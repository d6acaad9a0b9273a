//! From what is pending to the next plan: a stop or another goal for the motion under way, a plan from rest for the
//! stage that holds. The states are those of [`Pending`](super::pending).

use super::error::CommandError;
use super::in_flight::InFlight;
use super::pending::Pending;
use super::sent_plan::{Goal, SentPlan};
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::{Constraints, Effort, PlanStart, RetargetError, Stop, check_target};
use crate::queues::CommandQueues;

/// A sooner way takes over from the one under way if it saves this part of what is left: each has more pieces than the one
/// before.
const WORTH_TAKING: u64 = 64;

impl Commander {
    /// Takes the next step of what is pending, if its time has come. To be called after every [`update`](Self::update).
    pub fn advance_pending(&mut self, queues: &mut CommandQueues<'_>) {
        if self.current_snapshot().is_none() {
            return;
        }
        self.tables.take_result(&mut queues.trial);
        self.switch_off_at_rest(queues);
        self.advance_end_of_excitation(queues);
        self.advance_streaming(queues);
        self.begin_last_way();
        let result = match (self.mode(), &self.pending) {
            (Mode::Moving, &(Pending::Stop(stop) | Pending::StopThenGoal(stop, _))) => {
                self.send_stop(stop, queues);
                return;
            }
            (Mode::Moving, &Pending::Goal(goal)) => self.retarget(goal, queues),
            (Mode::Moving, &Pending::Improving(goal)) => self.take_soonest_way(goal, true, queues),
            (Mode::Moving, &Pending::GoalInStop(goal)) => {
                self.take_soonest_way(goal, false, queues)
            }
            (Mode::Holding, pending) => match pending.goal() {
                Some(&goal) => self.start_from_rest(goal, queues),
                None => return,
            },
            _ => return,
        };
        match result {
            // A full queue: again at the next snapshot.
            Ok(()) | Err(CommandError::Busy) => {}
            // Who asked has been told that it was accepted, long since.
            Err(error) => {
                self.pending = self.pending.stop().map_or(Pending::Nothing, Pending::Stop);
                self.approach.target = None;
                self.target_is_rest = true;
                self.report_late(error);
            }
        }
    }

    /// Makes `goal` what is pending, and carries it out as far as that can be; with an error everything is as it was.
    pub(super) fn request_goal(
        &mut self,
        goal: Goal,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        if self.pending.stream().is_some() {
            return Err(CommandError::Streaming);
        }
        let stop = self.pending.stop();
        let before = core::mem::replace(&mut self.pending, Pending::with_goal(stop, goal));
        let result = match (self.mode(), stop) {
            (Mode::Holding, _) => self.start_from_rest(goal, queues),
            (Mode::Moving, None) => self.retarget(goal, queues),
            _ => Ok(()),
        };
        match result {
            Ok(()) => self.approach.target = None,
            Err(_) => self.pending = before,
        }
        result
    }

    /// The stage rests where its last way to a target begins: that comes next.
    fn begin_last_way(&mut self) {
        if matches!(
            (self.mode(), &self.pending),
            (Mode::Holding, Pending::Nothing)
        ) && let Some(target) = self.approach.target.take()
        {
            self.pending = Pending::Goal(Goal::Position(target));
        }
    }

    /// Sends the motion from rest; nothing is sent when there is none to be made.
    fn start_from_rest(
        &mut self,
        goal: Goal,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let from = self.setpoint();
        let constraints = match goal {
            Goal::Position(to) => self.line_constraints(&from, &to),
            _ => self.constraints(),
        };
        let id = self.next_plan_id();
        let sent_plan = SentPlan::from_rest(id, from, goal, &constraints)?;
        if sent_plan.plan.ticks() > 0 {
            match goal {
                Goal::Position(_) => self.prepare_move(&sent_plan, queues),
                _ => self.end_trial(queues),
            }
            self.send_plan(sent_plan, Some(goal), queues)?;
        }
        self.pending.drop_goal();
        Ok(())
    }

    /// Sends a way to another goal. For a target in steps: a stop, so that the stage reacts soon and whatever becomes of
    /// the next step has a way to rest; at the same tick of the plan under way, a first way to the target that takes the
    /// stop's place; and [the soonest](Self::take_soonest_way), which takes longer to find.
    fn retarget(&mut self, goal: Goal, queues: &mut CommandQueues<'_>) -> Result<(), CommandError> {
        let constraints = self.goal_constraints(&goal);
        if let Goal::Position(to) = &goal {
            check_target(to, &constraints)?;
        }
        let id = self.next_plan_id();
        let Some((under_way, at)) = self.plan_to_leave() else {
            return Ok(());
        };
        let stops = under_way.stop.is_some() || self.next_plan.is_some();
        let is_target = matches!(goal, Goal::Position(_));
        if !stops
            && is_target
            && let Some(stop) = under_way.with_stop(id, at, &self.constraints(), Stop::Smooth)
        {
            return self.send_plan(stop, None, queues);
        }
        match under_way.retargeted(goal, id, at, &constraints, Effort::FIRST) {
            Ok(sent_plan) => {
                self.send_plan(sent_plan, Some(goal), queues)?;
                self.pending = if is_target {
                    Pending::Improving(goal)
                } else {
                    Pending::Nothing
                };
                Ok(())
            }
            Err(RetargetError::Refused(refusal)) => Err(refusal.into()),
            Err(RetargetError::NeedsStop) => {
                self.pending = match (is_target, stops) {
                    (true, _) => Pending::GoalInStop(goal),
                    (false, true) => Pending::GoalFromRest(goal),
                    (false, false) => Pending::StopThenGoal(Stop::Smooth, goal),
                };
                Ok(())
            }
        }
    }

    /// Sends the soonest way to a target. When a first one `is_under_way`, only if it saves enough; it does not matter then
    /// if it comes too late. Where there is none out of what is under way, there is nothing else to do but to wait for rest.
    fn take_soonest_way(
        &mut self,
        goal: Goal,
        is_under_way: bool,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        if self.next_plan.is_some() {
            return Ok(());
        }
        let constraints = self.goal_constraints(&goal);
        let id = self.next_plan_id();
        let lead = self.planning_lead_ticks;
        let Some((under_way, at)) = self.active_plan() else {
            return Ok(());
        };
        let at = at + lead;
        let left = under_way.plan.ticks().saturating_sub(at);
        let way = under_way.retargeted(goal, id, at, &constraints, Effort::ALL);
        let way = way.ok().filter(|way| {
            !is_under_way || way.plan.ticks().saturating_add(left / WORTH_TAKING) < left
        });
        self.pending = match way {
            Some(way) => {
                self.send_plan(way, (!is_under_way).then_some(goal), queues)?;
                Pending::Nothing
            }
            None if is_under_way => Pending::Nothing,
            None => Pending::GoalFromRest(goal),
        };
        Ok(())
    }

    fn goal_constraints(&self, goal: &Goal) -> Constraints {
        match goal {
            Goal::Position(to) => self.curve_constraints(to),
            _ => self.constraints(),
        }
    }

    /// The plan that a way to another goal leaves, and the tick of it: where the stop before it leaves it, if there is
    /// time; not one that is about to be left for something else, which is not known to be under way yet.
    fn plan_to_leave(&self) -> Option<(&SentPlan, u64)> {
        let Some(next) = &self.next_plan else {
            return self.active_plan();
        };
        let snapshot = self.snapshot()?;
        match (next.plan.start, &self.sent_plan) {
            (PlanStart::Splice { plan, tick }, Some(under_way))
                if next.stop == Some(Stop::Smooth)
                    && under_way.plan.id == plan
                    && snapshot.plan == plan
                    && snapshot.plan_tick + self.planning_lead_ticks / 2 <= tick =>
            {
                Some((under_way, tick))
            }
            _ => None,
        }
    }

    fn send_stop(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        // What was learnt is for the motion that this ends.
        self.end_trial(queues);
        let id = self.next_plan_id();
        let constraints = self.constraints();
        let Some((under_way, at)) = self.active_plan() else {
            return;
        };
        match under_way.with_stop(id, at, &constraints, stop) {
            // A full queue: again at the next snapshot.
            Some(stopped) => {
                let _ = self.send_plan(stopped, None, queues);
            }
            // Not by itself, when another goal takes over before: that motion is what has to be stopped.
            None if self.next_plan.is_some() => {}
            // It comes to rest as soon by itself.
            None => {
                let end = under_way.plan.end;
                self.pending.drop_stop();
                self.set_target_to_rest(&end);
            }
        }
    }

    /// The plan under way, and the tick of it at which another one can take over. A plan that is not the one sent last
    /// is about to be: `next_plan`, or what the next snapshot tells.
    pub(super) fn active_plan(&self) -> Option<(&SentPlan, u64)> {
        let snapshot = self.snapshot()?;
        let sent_plan = self.sent_plan.as_ref()?;
        (sent_plan.plan.id == snapshot.plan)
            .then_some((sent_plan, snapshot.plan_tick + self.planning_lead_ticks))
    }

    pub(super) fn send_plan(
        &mut self,
        sent_plan: SentPlan,
        goal: Option<Goal>,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let goes_on = sent_plan.goal == Goal::Stream && sent_plan.stop.is_none();
        if sent_plan.takes_over() && !goes_on {
            // The motion will be another one than the table under way is of.
            queues.trial.cancel();
        }
        (queues.send_plan(&sent_plan.plan)).map_err(|_| CommandError::Busy)?;
        self.note_sent(InFlight::Plan(sent_plan, goal));
        Ok(())
    }

    pub(super) const fn next_plan_id(&mut self) -> u32 {
        self.last_plan_id = self.last_plan_id.wrapping_add(1);
        self.last_plan_id
    }
}
