//! What is commanded: checked as a whole, then sent or kept as a wish. All but [`Stage::stop`] and [`Stage::set_velocity`]
//! are to be called only when [`Stage::present`] is known.

use super::axis::{Axis, AxisValues};
use super::coordinates::{Coordinates, Travel, replaced, travel};
use super::frames::Transform;
use super::sent_plan::Goal;
use super::soft_limits::SoftLimits;
use super::{Flight, Stage};
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::Stop;
use crate::queues::{Command, CommandQueues, Snapshot};
use kinematics::Angle;

/// Slowest `VLS`. The longest move then still has a duration that the motion layer can count.
pub(super) const SLOWEST_MM_S: f64 = 1e-3;

impl Stage {
    /// `MOV`: everything is checked before anything changes.
    pub fn move_to(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.aim(self.meant_by(&self.base_target(), values), queues)
    }

    /// The target that `MOV` means when `last` is the one before.
    pub(super) fn meant_by(&self, last: &Coordinates, values: &AxisValues) -> Coordinates {
        let mut target = replaced(last, values);
        if values[Axis::W.index()].is_some() {
            self.turn_as_meant(last, &mut target);
        }
        target
    }

    /// Changes W of a target by whole turns, as the parameter asks for: it may be the orientation only that is meant.
    fn turn_as_meant(&self, last: &Coordinates, target: &mut Coordinates) {
        let w = Axis::W.index();
        let units = |deg: f64| Angle::from_degrees(deg).map(Angle::units);
        // What is no angle is refused later.
        let (Some(from), Some(to)) = (units(last[w]), units(target[w])) else {
            return;
        };
        let turns = (self.targets.turn_direction.resolve(from, to) - to) >> 32;
        target[w] += turns as f64 * 360.0;
    }

    /// `MVR`: relative to the last target.
    pub fn move_by(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let mut target = self.base_target();
        for (coordinate, value) in target.iter_mut().zip(values) {
            *coordinate += value.unwrap_or(0.0);
        }
        self.aim(target, queues)
    }

    /// `MRT`: relative to the last target, along the axes of the tool as it is turned there.
    pub fn move_in_tool(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let (x, y) = (Axis::X.index(), Axis::Y.index());
        let turned = Transform {
            w_deg: self.base_target()[Axis::W.index()],
            ..Transform::IDENTITY
        };
        let [along, across] = turned.turned([x, y].map(|i| values[i].unwrap_or(0.0)));
        let mut values = *values;
        (values[x], values[y]) = (Some(along), Some(across));
        self.move_by(&values, queues)
    }

    fn aim(
        &mut self,
        target: Coordinates,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_ready()?;
        let from = self.setpoint();
        let to = self.place_of(&target)?;
        if self.targets.streamed {
            return self.stream(target, to);
        }
        self.want(Goal::Place(to), queues)?;
        for axis in Axis::ALL {
            if axis.component().is_some_and(|i| from[i] != to[i]) {
                self.moving.insert(axis);
            }
        }
        self.target = target;
        self.target_is_rest = false;
        self.jog = [0.0; 6];
        Ok(())
    }

    /// Whether motion can be commanded.
    pub(super) fn check_ready(&self) -> Result<(), ErrorCode> {
        if self.is_faulted() {
            return Err(ErrorCode::MotionError);
        }
        if self.generators_going() != [false; 6] {
            return Err(ErrorCode::GeneratorActive);
        }
        let held = matches!(self.mode(), Mode::Holding | Mode::Moving);
        let ready = |snapshot: &Snapshot| snapshot.referenced && held;
        if self.present().is_some_and(ready) {
            Ok(())
        } else {
            Err(ErrorCode::NotReady)
        }
    }

    /// `STP`, `#24`, `HLT`.
    pub fn stop(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        if self.mode() != Mode::Moving && !self.motion_is_due() {
            return;
        }
        self.wanted = None;
        self.flow = None;
        self.jog = [0.0; 6];
        self.target_is_rest = true;
        if self.stop_wanted != Some(Stop::Urgent) {
            self.stop_wanted = Some(stop);
        }
        self.carry_on(queues);
    }

    /// `SVO`. Before referencing there is no pose to hold: servo on is accepted, as clients send it first, and comes about
    /// with `FRF`.
    pub fn set_servo(&mut self, on: bool, queues: &mut CommandQueues<'_>) -> Result<(), ErrorCode> {
        let Some(snapshot) = self.present() else {
            return Err(ErrorCode::Busy);
        };
        match (on, snapshot.mode) {
            (true, Mode::Fault | Mode::Stopping) => Err(ErrorCode::MotionError),
            (true, Mode::Off) if snapshot.referenced => {
                self.send(Command::Servo(true), Flight::Other, queues)
            }
            (false, Mode::Holding | Mode::Moving) => {
                self.send(Command::Servo(false), Flight::Other, queues)
            }
            _ => Ok(()),
        }
    }

    /// `FLC`.
    pub fn acknowledge(&mut self, queues: &mut CommandQueues<'_>) -> Result<(), ErrorCode> {
        if self.mode() == Mode::Stopping {
            return Err(ErrorCode::InMotion);
        }
        if self.is_faulted() {
            self.send(Command::Acknowledge, Flight::Other, queues)?;
        }
        Ok(())
    }

    /// Changes the soft limits; only by ones that leave the target inside.
    pub fn set_soft(
        &mut self,
        change: fn(&mut SoftLimits, &AxisValues, &Coordinates, &Travel) -> Result<(), ErrorCode>,
        values: &AxisValues,
    ) -> Result<(), ErrorCode> {
        let limited = self.view.limited(&self.target);
        let travel = travel(&self.view, &self.base.geometry);
        change(&mut self.soft, values, &limited, &travel)
    }

    /// `VLS`: speed of the platform centre; rotation goes down with it in proportion, so that a slow move is slow in W too.
    pub fn set_velocity(&mut self, mm_s: f64) -> Result<(), ErrorCode> {
        if !(SLOWEST_MM_S..=self.full.speed_mm_s).contains(&mm_s) {
            return Err(ErrorCode::VelocityLimit);
        }
        self.base.limits.speed_mm_s = mm_s;
        self.base.limits.turn_speed_deg_s =
            self.full.turn_speed_deg_s * (mm_s / self.full.speed_mm_s);
        Ok(())
    }
}
