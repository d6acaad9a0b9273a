//! Wishes whose time has come: a stop or another target for the motion under way, a move for the stage at rest.

use super::super::course::Course;
use super::super::error::ErrorCode;
use super::{Flight, Stage};
use crate::link::{Command, Mode, PanelLink};
use crate::motion::{Bounds, Position, Stop};

/// 2^32: units of a [`Position`] in a track radius.
const UNITS: f64 = 4_294_967_296.0;

impl Stage {
    /// Takes the next step of what is still wanted, if its time has come.
    pub fn carry_on(&mut self, link: &mut PanelLink<'_>) {
        let Some(snapshot) = self.present() else {
            return;
        };
        let (mode, plan, plan_tick, from) = (
            snapshot.mode,
            snapshot.plan,
            snapshot.plan_tick,
            snapshot.setpoint,
        );
        match (mode, self.stop_wanted, self.move_wanted) {
            (Mode::Moving, Some(stop), _) => self.send_stop(stop, plan, plan_tick, link),
            (Mode::Moving, None, Some(to)) if !self.rest_first => {
                self.send_retarget(to, plan, plan_tick, link);
            }
            (Mode::Holding, _, Some(to)) => match self.start(from, to, link) {
                Ok(()) => self.move_wanted = None,
                Err(ErrorCode::Busy) => {}
                // Every connection is told: the one that asked has had its silence, which means yes, long since.
                Err(code) => {
                    self.move_wanted = None;
                    self.target_is_rest = true;
                    self.news = (self.news.0.wrapping_add(1), code);
                }
            },
            _ => {}
        }
    }

    /// Sends the line from rest at `from`; nothing is sent when it has no length.
    pub(super) fn start(
        &mut self,
        from: Position,
        to: Position,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        if from == to {
            return Ok(());
        }
        let id = self.next_id();
        let course = Course::line(id, from, to, &self.limits, &self.geometry)
            .map_err(|_| ErrorCode::PositionLimit)?;
        self.send(
            Command::Move(course.plan.clone()),
            Flight::Move(course),
            link,
        )
    }

    fn send_stop(&mut self, stop: Stop, plan: u32, plan_tick: u64, link: &mut PanelLink<'_>) {
        let id = self.next_id();
        // A plan that is not the one sent last is about to be: `next`, or what the next snapshot tells.
        let Some(course) = self.course.as_ref().filter(|course| course.plan.id == plan) else {
            return;
        };
        let at = plan_tick + self.look_ahead;
        match course.stopped(id, at, &self.limits, &self.geometry, stop) {
            // A full queue: again at the next snapshot.
            Some(stopped) => {
                let _ = self.send(
                    Command::Move(stopped.plan.clone()),
                    Flight::Move(stopped),
                    link,
                );
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

    /// Sends the transition to another target; where there is none the stage stops first.
    fn send_retarget(&mut self, to: Position, plan: u32, plan_tick: u64, link: &mut PanelLink<'_>) {
        // What takes over soon is what will be left, and is not known to be under way yet.
        if self.next.is_some() {
            return;
        }
        let id = self.next_id();
        let bounds = self.bounds();
        let Some(course) = self.course.as_ref().filter(|course| course.plan.id == plan) else {
            return;
        };
        let at = plan_tick + self.look_ahead;
        match course.retargeted(id, at, to, &self.limits, &self.geometry, &bounds) {
            Ok(course) => {
                let command = Command::Move(course.plan.clone());
                // A full queue: again at the next snapshot.
                if self.send(command, Flight::Move(course), link).is_ok() {
                    self.move_wanted = None;
                }
            }
            Err(_) => {
                self.rest_first = true;
                if course.stop.is_none() {
                    self.stop_wanted = Some(Stop::Smooth);
                }
            }
        }
    }

    /// Where x and y may go, 2^-32 track radii.
    fn bounds(&self) -> Bounds {
        [0, 1].map(|i| {
            let units = |mm: f64| libm::rint(mm / self.geometry.radius_mm * UNITS) as i64;
            if self.soft.active[i] {
                [units(self.soft.lowest[i]), units(self.soft.highest[i])]
            } else {
                [
                    units(-self.geometry.radius_mm),
                    units(self.geometry.radius_mm),
                ]
            }
        })
    }

    const fn next_id(&mut self) -> u32 {
        self.ids = self.ids.wrapping_add(1);
        self.ids
    }
}
