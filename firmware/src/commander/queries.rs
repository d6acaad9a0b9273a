//! What can be asked of the stage.

use super::axis::{Axis, AxisSet, AxisValues, Coordinates};
use super::coordinates::{coordinates, max_distance_mm, measured, position, target_travel, travel};
use super::error::CommandError;
use super::frames::ActiveFrames;
use super::furthest_target::furthest_target;
use super::in_flight::InFlight;
use super::quantity::Quantity;
use super::state::Commander;
use crate::calibration::MachineCalibration;
use crate::mode::Mode;
use crate::motion::{Position, check_line};
use kinematics::Angle;

/// What counts as a change of position, mm and deg: well over what an encoder's noise makes.
const CHANGE_TOLERANCE: f64 = 1e-4;

impl Commander {
    /// A value of an axis, in the unit of the quantity.
    pub fn value(&self, quantity: Quantity, axis: Axis) -> f64 {
        let index = axis.index();
        let servo = matches!(self.mode(), Mode::Holding | Mode::Moving);
        let referenced = self.snapshot.as_ref().is_some_and(|s| s.referenced);
        match quantity {
            Quantity::Position => self.measured()[index],
            Quantity::Target => self.commanded()[index],
            Quantity::Jog => self.jog_velocities[index],
            Quantity::OnTarget => flag(self.is_settled() || axis.component().is_none()),
            Quantity::Servo => flag(servo),
            Quantity::Referenced => flag(referenced),
            Quantity::Lowest => {
                target_travel(&self.active_frames, &self.base_constraints.geometry)[index][0]
            }
            Quantity::Highest => {
                target_travel(&self.active_frames, &self.base_constraints.geometry)[index][1]
            }
            Quantity::SoftLowest => self.soft_limit_range(axis)[0],
            Quantity::SoftHighest => self.soft_limit_range(axis)[1],
            Quantity::SoftActive => flag(self.soft_limits.active[index]),
            Quantity::Velocity => self.axis_velocity(axis),
            Quantity::LimitSwitch | Quantity::ReferenceSwitch | Quantity::HandControl => 0.0,
        }
    }

    /// Whether a move would take this target and go there, from where the stage is commanded to be, once referenced and
    /// with the servo on.
    pub fn is_reachable(&self, values: &AxisValues) -> bool {
        let last = self.base_target();
        let target = self.resolve_target(&last, values);
        self.is_line_allowed(&self.line_start(&last), &target)
    }

    /// Where a way begins that leaves `last`: exactly, when the stage stands there.
    fn line_start(&self, last: &Coordinates) -> Option<Position> {
        if self.mode() == Mode::Holding {
            Some(self.setpoint())
        } else {
            self.position_of(last).ok()
        }
    }

    /// Whether a target, and all of the straight line to it, can be moved to. Without a start the target alone counts.
    fn is_line_allowed(&self, from: &Option<Position>, target: &Coordinates) -> bool {
        let Ok(to) = self.position_of(target) else {
            return false;
        };
        from.is_none_or(|from| check_line(&from, &to, &self.constraints()).is_ok())
    }

    /// The position of a target that a move would take.
    pub(super) fn position_of(&self, target: &Coordinates) -> Result<Position, CommandError> {
        if !self
            .soft_limits
            .contain(&self.active_frames.travel_coordinates(target))
        {
            return Err(CommandError::OutsideSoftLimits);
        }
        position(
            target,
            &self.target,
            &self.active_frames,
            &self.constraints(),
        )
    }

    fn soft_limit_range(&self, axis: Axis) -> [f64; 2] {
        self.soft_limits.range(
            axis,
            &travel(&self.active_frames, &self.base_constraints.geometry),
        )
    }

    /// The furthest target in this direction from the last one; `None` when it is no direction.
    pub fn furthest_target(&self, values: &AxisValues) -> Option<Coordinates> {
        let direction = values.map(|value| value.unwrap_or(0.0));
        let last = self.base_target();
        let from = self.line_start(&last);
        let most = max_distance_mm(&self.active_frames, &self.base_constraints.geometry);
        let soft = |axis| self.soft_limit_range(axis);
        let allowed = |target: &Coordinates| self.is_line_allowed(&from, target);
        furthest_target(&last, &direction, &self.active_frames, most, soft, allowed)
    }

    /// Measured pose, in the frames in force. Without a reference there is none: 0. With pivots that are no pose (a
    /// fault) the setpoint stands for it.
    pub fn measured(&self) -> Coordinates {
        self.measured_on(self.built())
    }

    /// The same of a machine as drawn, whatever its calibration says.
    pub fn measured_as_drawn(&self) -> Coordinates {
        self.measured_on(None)
    }

    fn measured_on(&self, built: Option<&MachineCalibration>) -> Coordinates {
        let Some(snapshot) = self.snapshot.as_ref().filter(|s| s.referenced) else {
            return Coordinates::default();
        };
        measured(
            &snapshot.pivots,
            &self.active_frames,
            &self.base_constraints.geometry,
            built,
        )
        .unwrap_or_else(|| {
            coordinates(
                &snapshot.setpoint,
                &self.active_frames,
                &self.base_constraints.geometry,
            )
        })
    }

    /// Measured pose of the platform in the base frame, whatever frames are in force.
    pub fn platform_pose(&self) -> Coordinates {
        ActiveFrames::BASE.target_at(&self.active_frames.pose_at(&self.measured()))
    }

    /// The pivots measured last.
    pub fn pivots(&self) -> Option<[Angle; 3]> {
        self.snapshot.as_ref().map(|snapshot| snapshot.pivots)
    }

    /// The axes whose measured position has changed since the pivots were there; all when that is not known.
    pub fn changed_since(&self, pivots: Option<[Angle; 3]>) -> AxisSet {
        let then = pivots.and_then(|pivots| {
            measured(
                &pivots,
                &self.active_frames,
                &self.base_constraints.geometry,
                None,
            )
        });
        let now = self.pivots().and_then(|pivots| {
            measured(
                &pivots,
                &self.active_frames,
                &self.base_constraints.geometry,
                None,
            )
        });
        let (Some(then), Some(now)) = (then, now) else {
            return AxisSet::MOVABLE;
        };
        let mut changed = AxisSet::EMPTY;
        for axis in Axis::ALL {
            let i = axis.index();
            if (now[i] - then[i]).abs() > CHANGE_TOLERANCE {
                changed.insert(axis);
            }
        }
        changed
    }

    /// The axes that move or have not settled yet.
    pub fn moving_axes(&self) -> AxisSet {
        match (self.is_moving(), self.moving_axes.is_empty()) {
            (false, _) => AxisSet::EMPTY,
            (true, true) => AxisSet::MOVABLE,
            (true, false) => self.moving_axes,
        }
    }

    /// Whether referencing is under way, for whichever connection.
    pub fn is_referencing(&self) -> bool {
        matches!(self.in_flight, Some(InFlight::Reference))
            || self.tick() < self.referencing_deadline
    }

    /// The fault that is latched makes every motion an error.
    pub fn is_faulted(&self) -> bool {
        matches!(self.mode(), Mode::Fault | Mode::Stopping)
    }

    /// Commands sent to the tick so far.
    pub const fn commands_sent(&self) -> u32 {
        self.commands_sent
    }

    /// Speed of the platform's centre that moves keep to, mm/s.
    pub const fn velocity_mm_s(&self) -> f64 {
        self.base_constraints.limits.speed_mm_s
    }

    /// The pose that is commanded now.
    pub(super) fn setpoint(&self) -> Position {
        self.snapshot.as_ref().map_or([0; 3], |s| s.setpoint)
    }

    pub(super) fn mode(&self) -> Mode {
        self.snapshot.as_ref().map_or(Mode::Off, |s| s.mode)
    }

    fn is_settled(&self) -> bool {
        !self.is_moving() && self.mode() == Mode::Holding
    }

    pub(super) fn is_moving(&self) -> bool {
        let settled = self.snapshot.as_ref().is_some_and(|s| s.settled);
        self.is_referencing()
            || self.is_recovering()
            || self.is_motion_pending()
            || match self.mode() {
                Mode::Off | Mode::Fault => self.slides_since.is_some(),
                Mode::Holding => !settled,
                Mode::Moving | Mode::Stopping | Mode::Exciting => true,
            }
    }

    /// The setpoint moves, or is about to. At rest it does not, whether the stage has settled there or not.
    pub fn is_motion_commanded(&self) -> bool {
        self.is_referencing()
            || self.is_recovering()
            || self.is_motion_pending()
            || self.is_exciting()
            || self.mode() == Mode::Moving
    }

    /// A motion is pending or in flight that the snapshot does not show yet.
    pub const fn is_motion_pending(&self) -> bool {
        self.pending.is_motion()
            || self.approach.target.is_some()
            || matches!(self.in_flight, Some(InFlight::Plan(..)))
    }
}

fn flag(set: bool) -> f64 {
    if set { 1.0 } else { 0.0 }
}
