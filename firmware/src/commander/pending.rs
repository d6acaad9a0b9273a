//! Wishes whose time has come: a stop or another target for the motion under way, a move for the stage at rest.

use super::axis::Axis;
use super::coordinates::UNITS;
use super::sent_plan::{Course, Goal, code};
use super::{Flight, Stage};
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{Constraints, RetargetError, Stop, Tries};
use crate::queues::{Command, CommandQueues};

const DEGREES_A_TURN: f64 = 360.0;

impl Stage {
    /// Takes the next step of what is still wanted, if its time has come.
    pub fn carry_on(&mut self, queues: &mut CommandQueues<'_>) {
        if self.present().is_none() {
            return;
        }
        self.carry_flow_on(queues);
        let result = match (self.mode(), self.stop_wanted, self.wanted) {
            (Mode::Moving, Some(stop), _) => {
                self.send_stop(stop, queues);
                return;
            }
            (Mode::Moving, None, Some(goal)) if !self.rest_first => self.leave_for(goal, queues),
            (Mode::Holding, _, Some(goal)) => self.start(goal, queues),
            _ => return,
        };
        match result {
            // A full queue: again at the next snapshot.
            Ok(()) | Err(ErrorCode::Busy) => {}
            // Every connection is told: the one that asked has had its silence, which means yes, long since.
            Err(code) => {
                self.wanted = None;
                self.flow = None;
                self.target_is_rest = true;
                self.tell(code);
            }
        }
    }

    /// Makes `goal` what is wanted, at once as far as that can be; with an error everything is as it was.
    pub(super) fn want(
        &mut self,
        goal: Goal,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let before = (self.wanted, self.rest_first, self.stop_wanted, self.tries);
        (self.wanted, self.rest_first, self.tries) = (Some(goal), false, Tries::NONE);
        let ahead = self.ahead.take();
        let result = match (self.mode(), self.stop_wanted) {
            (Mode::Holding, _) => self.start(goal, queues),
            (Mode::Moving, None) => self.leave_for(goal, queues),
            _ => Ok(()),
        };
        if result.is_err() {
            (self.wanted, self.rest_first, self.stop_wanted, self.tries) = before;
            self.ahead = ahead;
        }
        result
    }

    /// Sends the motion from rest; nothing is sent when there is none to be made.
    fn start(&mut self, goal: Goal, queues: &mut CommandQueues<'_>) -> Result<(), ErrorCode> {
        let from = self.setpoint();
        let ground = match goal {
            Goal::Place(to) => self.ground_of_line(&from, &to),
            _ => self.ground(),
        };
        let id = self.next_id();
        let course = Course::from_rest(id, from, goal, &ground)?;
        if course.plan.ticks() > 0 {
            self.send_course(course, queues)?;
        }
        self.wanted = None;
        Ok(())
    }

    /// Sends the way to another goal, slice by slice; where there is none the stage stops first. It also brakes while it is to be
    /// tried again: a stop that has just begun has hardly taken any speed, and is the way out if nothing comes of it.
    fn leave_for(&mut self, goal: Goal, queues: &mut CommandQueues<'_>) -> Result<(), ErrorCode> {
        let ground = match goal {
            Goal::Place(_) => self.ground_of_curve(),
            _ => self.ground(),
        };
        let id = self.next_id();
        // What takes over soon is what will be left, and is not known to be under way yet.
        let Some((course, at)) = self.under_way().filter(|_| self.next.is_none()) else {
            return Ok(());
        };
        let (mut tries, mut ahead) = (self.tries, None);
        let before = (self.ahead.as_ref()).filter(|ahead| ahead.follows(course.plan.id, at));
        // A stop that has begun, and a head, come to rest by themselves.
        let stops = course.stop.is_some() || before.is_some();
        let left = match before {
            Some(before) => course.gone_on(before, id, at, &ground, &mut tries),
            None => course.left_for(goal, id, at, &ground, &mut tries, &mut ahead),
        };
        self.ahead = ahead;
        match left {
            Ok(left) => {
                self.send_course(left, queues)?;
                self.wanted = self.wanted.filter(|_| self.ahead.is_some());
            }
            Err(RetargetError::Refused(refusal)) => return Err(code(&refusal)),
            Err(no) => {
                self.rest_first = no == RetargetError::NeedsStop;
                if !stops {
                    self.stop_wanted = Some(Stop::Smooth);
                }
            }
        }
        self.tries = tries;
        Ok(())
    }

    fn send_stop(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        let id = self.next_id();
        let ground = self.ground();
        let Some((course, at)) = self.under_way() else {
            return;
        };
        match course.stopped(id, at, &ground, stop) {
            // A full queue: again at the next snapshot.
            Some(stopped) => {
                let _ = self.send_course(stopped, queues);
            }
            // Not by itself, when another target takes over before: that motion is what has to be stopped.
            None if self.next.is_some() => {}
            // It comes to rest as soon by itself.
            None => {
                let end = course.plan.end;
                self.stop_wanted = None;
                self.will_rest_at(&end);
            }
        }
    }

    /// The course under way, and the tick of it at which another one can take over. A plan that is not the one sent last is
    /// about to be: `next`, or what the next snapshot tells.
    pub(super) fn under_way(&self) -> Option<(&Course, u64)> {
        let snapshot = self.snapshot()?;
        let course = self.course.as_ref()?;
        (course.plan.id == snapshot.plan).then_some((course, snapshot.plan_tick + self.look_ahead))
    }

    /// Tells every connection.
    pub(super) const fn tell(&mut self, code: ErrorCode) {
        self.news = (self.news.0.wrapping_add(1), code);
    }

    pub(super) fn send_course(
        &mut self,
        course: Course,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let command = Command::Move(course.plan.clone());
        self.send(command, Flight::Move(course), queues)
    }

    /// What plans keep to now.
    pub(super) fn ground(&self) -> Constraints {
        let radius_mm = self.base.geometry.radius_mm;
        let mut ground = self.base;
        ground.rotation_centre = self.radii(self.view.tool.origin());
        let [x, y] = self.view.zero;
        for (bounds, (axis, zero, per_unit)) in (ground.bounds.iter_mut()).zip([
            (Axis::X, x, radius_mm),
            (Axis::Y, y, radius_mm),
            (Axis::W, 0.0, DEGREES_A_TURN),
        ]) {
            for (bound, set) in bounds.iter_mut().zip(self.soft.set_range(axis)) {
                if let Some(value) = set {
                    *bound = libm::rint((value + zero) / per_unit * UNITS) as i64;
                }
            }
        }
        ground
    }

    /// mm to track radii.
    pub(super) fn radii(&self, mm: [f64; 2]) -> [f64; 2] {
        mm.map(|mm| mm / self.base.geometry.radius_mm)
    }

    pub(super) const fn next_id(&mut self) -> u32 {
        self.ids = self.ids.wrapping_add(1);
        self.ids
    }
}
