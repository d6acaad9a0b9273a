//! From what is pending to the next plan: a stop or another goal for the motion under way, a plan from rest for the
//! stage that holds. The states are those of [`Pending`](super::pending).

use super::error::CommandError;
use super::in_flight::InFlight;
use super::pending::{Pending, Retarget};
use super::sent_plan::{Goal, SentPlan};
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::{RetargetError, Stop};
use crate::queues::{Command, CommandQueues};

impl Commander {
    /// Takes the next step of what is pending, if its time has come. To be called after every [`update`](Self::update).
    pub fn advance_pending(&mut self, queues: &mut CommandQueues<'_>) {
        if self.current_snapshot().is_none() {
            return;
        }
        self.advance_streaming(queues);
        let result = match (self.mode(), &self.pending) {
            (
                Mode::Moving,
                &(Pending::Stop(stop)
                | Pending::StopThenGoal(stop, _)
                | Pending::StopThenStream(stop, _)),
            ) => {
                self.send_stop(stop, queues);
                return;
            }
            (Mode::Moving, &(Pending::Goal(retarget) | Pending::HeadSent(retarget, _)))
                if !retarget.needs_rest =>
            {
                self.retarget(retarget, queues)
            }
            (Mode::Holding, pending) => match pending.goal() {
                Some(&retarget) => self.start_from_rest(retarget, queues),
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
        let (stop, retarget) = (self.pending.stop(), Retarget::new(goal));
        let before = core::mem::replace(&mut self.pending, Pending::with_goal(stop, retarget));
        let result = match (self.mode(), stop) {
            (Mode::Holding, _) => self.start_from_rest(retarget, queues),
            (Mode::Moving, None) => self.retarget(retarget, queues),
            _ => Ok(()),
        };
        if result.is_err() {
            self.pending = before;
        }
        result
    }

    /// Sends the motion from rest; nothing is sent when there is none to be made.
    fn start_from_rest(
        &mut self,
        retarget: Retarget,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let (from, goal) = (self.setpoint(), retarget.goal);
        let constraints = match goal {
            Goal::Position(to) => self.line_constraints(&from, &to),
            _ => self.constraints(),
        };
        let id = self.next_plan_id();
        let sent_plan = SentPlan::from_rest(id, from, goal, &constraints)?;
        if sent_plan.plan.ticks() > 0 {
            self.send_plan(sent_plan, Some(retarget), queues)?;
        }
        self.pending.drop_goal();
        Ok(())
    }

    /// Sends the way to another goal, slice by slice; where there is none the stage stops first. It also brakes while
    /// it is to be tried again: a stop that has just begun has hardly taken any speed, and is the way out if nothing
    /// comes of it.
    fn retarget(
        &mut self,
        retarget: Retarget,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let goal = retarget.goal;
        let constraints = match goal {
            Goal::Position(_) => self.curve_constraints(),
            _ => self.constraints(),
        };
        let id = self.next_plan_id();
        // What takes over soon is what will be left, and is not known to be under way yet.
        let Some((under_way, at)) = self.active_plan().filter(|_| self.next_plan.is_none()) else {
            return Ok(());
        };
        let head = match &self.pending {
            Pending::HeadSent(_, ahead) if ahead.follows(under_way.plan.id, at) => Some(ahead),
            _ => None,
        };
        // A stop that has begun, and a head, come to rest by themselves.
        let stops = under_way.stop.is_some() || head.is_some();
        let (mut tries, mut ahead) = (retarget.tries, None);
        let planned = match head {
            Some(head) => under_way.continued(head, id, at, &constraints, &mut tries),
            None => under_way.retargeted(goal, id, at, &constraints, &mut tries, &mut ahead),
        };
        let tried = Retarget { tries, ..retarget };
        match planned {
            Ok(sent_plan) => {
                let sent = self.send_plan(sent_plan, Some(tried), queues);
                self.pending = match (sent, ahead) {
                    (Err(_), _) => Pending::Goal(retarget),
                    (Ok(()), Some(ahead)) => Pending::HeadSent(tried, ahead),
                    (Ok(()), None) => Pending::Nothing,
                };
                sent
            }
            Err(RetargetError::Refused(refusal)) => Err(refusal.into()),
            Err(no) => {
                let tried = Retarget {
                    needs_rest: no == RetargetError::NeedsStop,
                    ..tried
                };
                self.pending = Pending::with_goal((!stops).then_some(Stop::Smooth), tried);
                Ok(())
            }
        }
    }

    fn send_stop(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
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
        retarget: Option<Retarget>,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let command = Command::Move(sent_plan.plan.clone());
        self.send(command, InFlight::Plan(sent_plan, retarget), queues)
    }

    pub(super) const fn next_plan_id(&mut self) -> u32 {
        self.last_plan_id = self.last_plan_id.wrapping_add(1);
        self.last_plan_id
    }
}
