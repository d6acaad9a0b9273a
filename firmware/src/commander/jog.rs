//! Constant velocities: kept until they are changed, another motion is commanded, or the way ends.

use super::axis::{Axis, AxisValues, Coordinates, replaced};
use super::coordinates::coordinates;
use super::error::CommandError;
use super::sent_plan::Goal;
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Commander {
    /// Moves at constant velocities, mm/s and deg/s: axes that are not named keep the velocity that an earlier one gave
    /// them; whatever else moves comes to rest.
    pub fn jog(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.check_ready()?;
        if self.pending.stream().is_some() {
            return Err(CommandError::Streaming);
        }
        let wanted = replaced(&self.jog_velocities, values);
        for axis in Axis::ALL {
            let velocity = wanted[axis.index()].abs();
            if axis.component().is_none() && velocity != 0.0 {
                return Err(CommandError::FrozenAxis(axis));
            }
            if velocity > self.axis_velocity(axis) {
                return Err(CommandError::VelocityOutOfRange { axis: Some(axis) });
            }
        }
        // A velocity of zero for what does not jog leaves a move alone, and one that is kept already is nothing new.
        let is_kept = wanted == [0.0; 6] || self.is_motion_commanded();
        if wanted == self.jog_velocities && is_kept {
            return Ok(());
        }
        let [x, y] = [Axis::X, Axis::Y].map(|axis| wanted[axis.index()]);
        let [x, y] = self.active_frames.work.turned([x, y]);
        self.request_goal(Goal::Velocity([x, y, wanted[Axis::W.index()]]), queues)?;
        for axis in Axis::ALL {
            if wanted[axis.index()] != 0.0 {
                self.moving_axes.insert(axis);
            }
        }
        self.jog_velocities = wanted;
        self.target_is_rest = true;
        Ok(())
    }

    fn is_jogging(&self) -> bool {
        self.jog_velocities != [0.0; 6]
    }

    /// The target: while jogging, where the stage is commanded to be now.
    pub(super) fn commanded(&self) -> Coordinates {
        let follows = self.is_jogging() || self.running_generators() != [false; 6];
        if follows && self.mode() == Mode::Moving {
            coordinates(
                &self.setpoint(),
                &self.active_frames,
                &self.base_constraints.geometry,
            )
        } else {
            self.target
        }
    }

    /// What a new target changes: the last one; while jogging, where the axes would come to rest.
    pub(super) fn base_target(&self) -> Coordinates {
        if !self.is_jogging() {
            return self.target;
        }
        let stopped = self.active_plan().and_then(|(sent_plan, at)| {
            sent_plan.with_stop(0, at, &self.constraints(), Stop::Smooth)
        });
        match stopped {
            Some(stop) => coordinates(
                &stop.plan.end,
                &self.active_frames,
                &self.base_constraints.geometry,
            ),
            None => self.commanded(),
        }
    }
}
