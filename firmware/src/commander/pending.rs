//! Wishes whose time has come: a stop or another target for the motion under way, a move for the stage at rest.

use super::axis::Axis;
use super::coordinates::UNITS_PER_RADIUS;
use super::sent_plan::{Goal, SentPlan, code};
use super::{Commander, InFlight};
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{Ground, NoTransition, Stop, Tries};
use crate::queues::{Command, PanelLink};

const DEGREES_A_TURN: f64 = 360.0;

impl Commander {
    /// Takes the next step of what is still wanted, if its time has come.
    pub fn advance_pending(&mut self, link: &mut PanelLink<'_>) {
        if self.current_snapshot().is_none() {
            return;
        }
        self.advance_streaming(link);
        let result = match (self.mode(), self.pending_stop, self.pending_goal) {
            (Mode::Moving, Some(stop), _) => {
                self.send_stop(stop, link);
                return;
            }
            (Mode::Moving, None, Some(goal)) if !self.needs_stop_first => self.retarget(goal, link),
            (Mode::Holding, _, Some(goal)) => self.start_from_rest(goal, link),
            _ => return,
        };
        match result {
            // A full queue: again at the next snapshot.
            Ok(()) | Err(ErrorCode::Busy) => {}
            // Every connection is told: the one that asked has had its silence, which means yes, long since.
            Err(code) => {
                self.pending_goal = None;
                self.streaming = None;
                self.target_is_rest = true;
                self.report_error(code);
            }
        }
    }

    /// Makes `goal` what is wanted, at once as far as that can be; with an error everything is as it was.
    pub(super) fn request_goal(
        &mut self,
        goal: Goal,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        let before = (
            self.pending_goal,
            self.needs_stop_first,
            self.pending_stop,
            self.tries,
        );
        (self.pending_goal, self.needs_stop_first, self.tries) = (Some(goal), false, Tries::NONE);
        let ahead = self.ahead.take();
        let result = match (self.mode(), self.pending_stop) {
            (Mode::Holding, _) => self.start_from_rest(goal, link),
            (Mode::Moving, None) => self.retarget(goal, link),
            _ => Ok(()),
        };
        if result.is_err() {
            (
                self.pending_goal,
                self.needs_stop_first,
                self.pending_stop,
                self.tries,
            ) = before;
            self.ahead = ahead;
        }
        result
    }

    /// Sends the motion from rest; nothing is sent when there is none to be made.
    fn start_from_rest(&mut self, goal: Goal, link: &mut PanelLink<'_>) -> Result<(), ErrorCode> {
        let from = self.setpoint();
        let constraints = match goal {
            Goal::Position(to) => self.line_constraints(&from, &to),
            _ => self.constraints(),
        };
        let id = self.next_plan_id();
        let sent_plan = SentPlan::from_rest(id, from, goal, &constraints)?;
        if sent_plan.plan.ticks() > 0 {
            self.send_plan(sent_plan, link)?;
        }
        self.pending_goal = None;
        Ok(())
    }

    /// Sends the way to another goal, slice by slice; where there is none the stage stops first. It also brakes while it is to be
    /// tried again: a stop that has just begun has hardly taken any speed, and is the way out if nothing comes of it.
    fn retarget(&mut self, goal: Goal, link: &mut PanelLink<'_>) -> Result<(), ErrorCode> {
        let constraints = match goal {
            Goal::Position(_) => self.curve_constraints(),
            _ => self.constraints(),
        };
        let id = self.next_plan_id();
        // What takes over soon is what will be left, and is not known to be under way yet.
        let Some((sent_plan, at)) = self.active_plan().filter(|_| self.next_plan.is_none()) else {
            return Ok(());
        };
        let (mut tries, mut ahead) = (self.tries, None);
        let before = (self.ahead.as_ref()).filter(|ahead| ahead.follows(sent_plan.plan.id, at));
        // A stop that has begun, and a head, come to rest by themselves.
        let stops = sent_plan.stop.is_some() || before.is_some();
        let left = match before {
            Some(before) => sent_plan.continued(before, id, at, &constraints, &mut tries),
            None => sent_plan.retargeted(goal, id, at, &constraints, &mut tries, &mut ahead),
        };
        self.ahead = ahead;
        match left {
            Ok(left) => {
                self.send_plan(left, link)?;
                self.pending_goal = self.pending_goal.filter(|_| self.ahead.is_some());
            }
            Err(NoTransition::Refused(refusal)) => return Err(code(&refusal)),
            Err(no) => {
                self.needs_stop_first = no == NoTransition::NeedsStop;
                if !stops {
                    self.pending_stop = Some(Stop::Smooth);
                }
            }
        }
        self.tries = tries;
        Ok(())
    }

    fn send_stop(&mut self, stop: Stop, link: &mut PanelLink<'_>) {
        let id = self.next_plan_id();
        let constraints = self.constraints();
        let Some((sent_plan, at)) = self.active_plan() else {
            return;
        };
        match sent_plan.with_stop(id, at, &constraints, stop) {
            // A full queue: again at the next snapshot.
            Some(stopped) => {
                let _ = self.send_plan(stopped, link);
            }
            // Not by itself, when another target takes over before: that motion is what has to be stopped.
            None if self.next_plan.is_some() => {}
            // It comes to rest as soon by itself.
            None => {
                let end = sent_plan.plan.end;
                self.pending_stop = None;
                self.set_target_to_rest(&end);
            }
        }
    }

    /// The sent_plan under way, and the tick of it at which another one can take over. A plan that is not the one sent last is
    /// about to be: `next`, or what the next snapshot tells.
    pub(super) fn active_plan(&self) -> Option<(&SentPlan, u64)> {
        let snapshot = self.snapshot()?;
        let sent_plan = self.sent_plan.as_ref()?;
        (sent_plan.plan.id == snapshot.plan)
            .then_some((sent_plan, snapshot.plan_tick + self.planning_lead_ticks))
    }

    pub(super) fn send_plan(
        &mut self,
        sent_plan: SentPlan,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        let command = Command::Move(sent_plan.plan.clone());
        self.send(command, InFlight::Move(sent_plan), link)
    }

    /// What plans keep to now.
    pub(super) fn constraints(&self) -> Ground {
        let radius_mm = self.base_constraints.geometry.radius_mm;
        let mut constraints = self.base_constraints;
        constraints.centre = self.radii(self.active_frames.tool.origin());
        let [x, y] = self.active_frames.zero;
        for (bounds, (axis, zero, per_unit)) in (constraints.bounds.iter_mut()).zip([
            (Axis::X, x, radius_mm),
            (Axis::Y, y, radius_mm),
            (Axis::W, 0.0, DEGREES_A_TURN),
        ]) {
            for (bound, set) in bounds.iter_mut().zip(self.soft_limits.active_range(axis)) {
                if let Some(value) = set {
                    *bound = libm::rint((value + zero) / per_unit * UNITS_PER_RADIUS) as i64;
                }
            }
        }
        constraints
    }

    /// mm to track radii.
    pub(super) fn radii(&self, mm: [f64; 2]) -> [f64; 2] {
        mm.map(|mm| mm / self.base_constraints.geometry.radius_mm)
    }

    pub(super) const fn next_plan_id(&mut self) -> u32 {
        self.last_plan_id = self.last_plan_id.wrapping_add(1);
        self.last_plan_id
    }
}
