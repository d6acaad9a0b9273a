//! What is commanded: checked as a whole, then sent or kept as a wish. All but [`Stage::stop`] and [`Stage::set_velocity`]
//! are to be called only when [`Stage::present`] is known.

use super::super::axis::{Axis, AxisValues};
use super::super::error::ErrorCode;
use super::super::soft::SoftLimits;
use super::super::target::{Coordinates, position, replaced};
use super::{Flight, Stage};
use crate::link::{Command, Mode, PanelLink};
use crate::motion::{Limits, Stop};
use kinematics::Geometry;

/// Slowest `VLS`. The longest move then still has a duration that the motion layer can count.
const SLOWEST_MM_S: f64 = 1e-3;

impl Stage {
    /// `MOV`: everything is checked before anything changes.
    pub fn move_to(
        &mut self,
        values: &AxisValues,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        self.aim(replaced(&self.target, values), link)
    }

    /// `MVR`: relative to the last target.
    pub fn move_by(
        &mut self,
        values: &AxisValues,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        let mut target = self.target;
        for (coordinate, value) in target.iter_mut().zip(values) {
            *coordinate += value.unwrap_or(0.0);
        }
        self.aim(target, link)
    }

    fn aim(&mut self, target: Coordinates, link: &mut PanelLink<'_>) -> Result<(), ErrorCode> {
        if self.is_faulted() {
            return Err(ErrorCode::MotionError);
        }
        let Some(snapshot) = self
            .present()
            .filter(|s| s.referenced && matches!(s.mode, Mode::Holding | Mode::Moving))
        else {
            return Err(ErrorCode::NotReady);
        };
        if !self.soft.allow(&target) {
            return Err(ErrorCode::PositionLimit);
        }
        let to = position(&target, &self.geometry)?;
        let (mode, from) = (snapshot.mode, snapshot.setpoint);
        if mode == Mode::Holding {
            self.start(from, to, link)?;
        } else {
            self.move_wanted = Some(to);
            self.rest_first = false;
        }
        for axis in Axis::ALL {
            if axis.component().is_some_and(|i| from[i] != to[i]) {
                self.moving.insert(axis);
            }
        }
        self.target = target;
        self.target_is_rest = false;
        Ok(())
    }

    /// `STP`, `#24`, `HLT`.
    pub fn stop(&mut self, stop: Stop, link: &mut PanelLink<'_>) {
        if self.mode() != Mode::Moving && !self.motion_is_due() {
            return;
        }
        self.move_wanted = None;
        self.target_is_rest = true;
        if self.stop_wanted != Some(Stop::Urgent) {
            self.stop_wanted = Some(stop);
        }
        self.carry_on(link);
    }

    /// `SVO`. Before referencing there is no pose to hold: servo on is accepted, as clients send it first, and comes about
    /// with `FRF`.
    pub fn set_servo(&mut self, on: bool, link: &mut PanelLink<'_>) -> Result<(), ErrorCode> {
        let Some(snapshot) = self.present() else {
            return Err(ErrorCode::Busy);
        };
        match (on, snapshot.mode) {
            (true, Mode::Fault) => Err(ErrorCode::MotionError),
            (true, Mode::Off) if snapshot.referenced => {
                self.send(Command::Servo(true), Flight::Other, link)
            }
            (false, Mode::Holding | Mode::Moving) => {
                self.send(Command::Servo(false), Flight::Other, link)
            }
            _ => Ok(()),
        }
    }

    /// `FLC`.
    pub fn acknowledge(&mut self, link: &mut PanelLink<'_>) -> Result<(), ErrorCode> {
        if self.is_faulted() {
            self.send(Command::Acknowledge, Flight::Other, link)?;
        }
        Ok(())
    }

    /// Changes the soft limits; only by ones that leave the target inside.
    pub fn set_soft(
        &mut self,
        change: fn(&mut SoftLimits, &AxisValues, &Coordinates, &Geometry) -> Result<(), ErrorCode>,
        values: &AxisValues,
    ) -> Result<(), ErrorCode> {
        change(&mut self.soft, values, &self.target, &self.geometry)
    }

    /// Other limits of motion, for the plans to come. `VLS` stays, as far as they allow it.
    pub fn set_limits(&mut self, limits: Limits) {
        let mm_s = self.limits.speed_mm_s.min(limits.speed_mm_s);
        self.full = limits;
        self.limits = limits;
        // Not refused: it is inside the new limits, which are far over the slowest.
        let _ = self.set_velocity(mm_s);
    }

    /// `VLS`: speed of the platform centre; rotation goes down with it in proportion, so that a slow move is slow in W too.
    pub fn set_velocity(&mut self, mm_s: f64) -> Result<(), ErrorCode> {
        if !(SLOWEST_MM_S..=self.full.speed_mm_s).contains(&mm_s) {
            return Err(ErrorCode::VelocityLimit);
        }
        self.limits.speed_mm_s = mm_s;
        self.limits.turn_speed_deg_s = self.full.turn_speed_deg_s * (mm_s / self.full.speed_mm_s);
        Ok(())
    }
}
