//! Constant velocities (`JOG`): kept until they are changed, another motion is commanded, or the way ends.

use super::Stage;
use super::axis::{Axis, AxisValues};
use super::coordinates::{Coordinates, coordinates, replaced};
use super::sent_plan::Goal;
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Stage {
    /// `JOG`: axes that are not named keep the velocity that an earlier one gave them; whatever else moves comes to rest.
    pub fn jog(
        &mut self,
        values: &AxisValues,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_ready()?;
        if self.flow.is_some() {
            return Err(ErrorCode::NotAllowed);
        }
        let wanted = replaced(&self.jog, values);
        for axis in Axis::ALL {
            let velocity = wanted[axis.index()].abs();
            if axis.component().is_none() && velocity != 0.0 {
                return Err(ErrorCode::PositionLimit);
            }
            if velocity > self.axis_velocity(axis) {
                return Err(ErrorCode::VelocityLimit);
            }
        }
        // A velocity of zero for what does not jog leaves a move alone.
        if wanted == self.jog && wanted == [0.0; 6] {
            return Ok(());
        }
        let [x, y] = [Axis::X, Axis::Y].map(|axis| wanted[axis.index()]);
        let [x, y] = self.view.work.turned([x, y]);
        self.want(Goal::Velocity([x, y, wanted[Axis::W.index()]]), queues)?;
        for axis in Axis::ALL {
            if wanted[axis.index()] != 0.0 {
                self.moving.insert(axis);
            }
        }
        self.jog = wanted;
        self.target_is_rest = true;
        Ok(())
    }

    fn is_jogging(&self) -> bool {
        self.jog != [0.0; 6]
    }

    /// The target: while jogging, where the stage is commanded to be now.
    pub(super) fn commanded(&self) -> Coordinates {
        let follows = self.is_jogging() || self.generators_going() != [false; 6];
        if follows && self.mode() == Mode::Moving {
            coordinates(&self.setpoint(), &self.view, &self.base.geometry)
        } else {
            self.target
        }
    }

    /// What a new target changes: the last one; while jogging, where the axes would come to rest.
    pub(super) fn base_target(&self) -> Coordinates {
        if !self.is_jogging() {
            return self.target;
        }
        let stopped = self
            .under_way()
            .and_then(|(course, at)| course.stopped(0, at, &self.ground(), Stop::Smooth));
        match stopped {
            Some(stop) => coordinates(&stop.plan.end, &self.view, &self.base.geometry),
            None => self.commanded(),
        }
    }
}
