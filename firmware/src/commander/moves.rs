//! What is commanded: checked as a whole, then sent, or kept until its time comes. All but [`Commander::stop`] are to
//! be called only when [`Commander::current_snapshot`] is known.

use super::axis::{Axis, AxisValues, Coordinates, replaced};
use super::coordinates::travel;
use super::error::CommandError;
use super::frames::Transform;
use super::in_flight::InFlight;
use super::sent_plan::Goal;
use super::soft_limits::SoftLimitChange;
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::Stop;
use crate::queues::{Command, CommandQueues, Snapshot};
use kinematics::Angle;

impl Commander {
    /// Moves to a target in the frames in force, mm and deg; axes without a value keep theirs. Everything is checked
    /// before anything changes.
    pub fn move_to(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.move_to_target(self.resolve_target(&self.base_target(), values), queues)
    }

    /// The target that these values mean when `last` is the one before.
    pub(super) fn resolve_target(&self, last: &Coordinates, values: &AxisValues) -> Coordinates {
        let mut target = replaced(last, values);
        if values[Axis::W.index()].is_some() {
            self.apply_turn_direction(last, &mut target);
        }
        target
    }

    /// Changes W of a target by whole turns, as the parameter asks for: it may be the orientation only that is meant.
    fn apply_turn_direction(&self, last: &Coordinates, target: &mut Coordinates) {
        let w = Axis::W.index();
        let units = |deg: f64| Angle::from_degrees(deg).map(Angle::units);
        // What is no angle is refused later.
        let (Some(from), Some(to)) = (units(last[w]), units(target[w])) else {
            return;
        };
        let turns = (self.targets.turn_direction.resolve(from, to) - to) >> 32;
        target[w] += turns as f64 * 360.0;
    }

    /// Moves relative to the last target.
    pub fn move_by(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let mut target = self.base_target();
        for (coordinate, value) in target.iter_mut().zip(values) {
            *coordinate += value.unwrap_or(0.0);
        }
        self.move_to_target(target, queues)
    }

    /// Moves relative to the last target, along the axes of the tool as it is turned there.
    pub fn move_in_tool(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
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

    fn move_to_target(
        &mut self,
        target: Coordinates,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.check_ready()?;
        let from = self.setpoint();
        let to = self.position_of(&target)?;
        if self.targets.streamed {
            return self.stream(target, to);
        }
        let first = self.approach_from(&to)?;
        self.request_goal(Goal::Position(first), queues)?;
        self.approach.target = (first != to).then_some(to);
        for axis in Axis::ALL {
            if axis.component().is_some_and(|i| from[i] != to[i]) {
                self.moving_axes.insert(axis);
            }
        }
        self.target = target;
        self.target_is_rest = false;
        self.jog_velocities = [0.0; 6];
        Ok(())
    }

    /// Whether motion can be commanded.
    pub(super) fn check_ready(&self) -> Result<(), CommandError> {
        if self.is_faulted() {
            return Err(CommandError::Faulted);
        }
        self.check_may_drive()?;
        if self.is_recovering() {
            return Err(CommandError::InMotion);
        }
        if self.running_generators() != [false; 6] {
            return Err(CommandError::GeneratorsRunning);
        }
        if self.off_at_rest {
            return Err(CommandError::NotReady);
        }
        let held = matches!(self.mode(), Mode::Holding | Mode::Moving);
        let ready = |snapshot: &Snapshot| snapshot.referenced && held;
        if self.current_snapshot().is_some_and(ready) {
            Ok(())
        } else {
            Err(CommandError::NotReady)
        }
    }

    /// Brings the motion to rest, if there is one; whatever else was asked is over. A recovery ends with the servo off.
    pub fn stop(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        self.give_up_recovery();
        self.end_excitation(queues);
        if self.mode() != Mode::Moving && !self.is_motion_pending() {
            return;
        }
        self.approach.target = None;
        self.jog_velocities = [0.0; 6];
        self.target_is_rest = true;
        self.pending.request_stop(stop);
        // At rest, with nothing sent: what was asked for is over, and what is asked for next is not to be stopped by this.
        if self.mode() == Mode::Holding && !self.is_motion_pending() {
            self.pending.drop_stop();
        }
        self.advance_pending(queues);
    }

    /// Acknowledges the latched fault; without one nothing is done.
    pub fn acknowledge_fault(
        &mut self,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        if self.mode() == Mode::Stopping {
            return Err(CommandError::InMotion);
        }
        if self.is_faulted() {
            self.send(Command::Acknowledge, InFlight::Other, queues)?;
        }
        Ok(())
    }

    /// Changes the soft limits; only to ones that leave the target inside.
    pub fn set_soft_limits(&mut self, change: &SoftLimitChange) -> Result<(), CommandError> {
        let target = self.active_frames.travel_coordinates(&self.target);
        let travel = travel(&self.active_frames, &self.base_constraints.geometry);
        self.soft_limits.apply(change, &target, &travel)
    }
}
