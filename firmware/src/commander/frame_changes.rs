//! Frames and the centre of rotation: changes to what targets mean, at rest, by which nothing moves.

use super::axis::Coordinates;
use super::axis::{Axis, AxisValues};
use super::error::CommandError;
use super::frames::{
    ActiveFrames, FrameChange, FrameError, FrameKind, FrameName, FrameSelection, FrameTree,
    Transform,
};
use super::in_flight::InFlight;
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::{MAX_CENTRE_OFFSET, RotationCentre};
use crate::queues::{Command, CommandQueues};

impl Commander {
    /// The frames there are, and which are in force.
    pub const fn frames(&self) -> &FrameTree {
        &self.frames
    }

    /// Makes, links, forgets and enables frames, and sets the centre of rotation.
    pub fn change_frames(
        &mut self,
        action: &FrameChange,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        match *action {
            FrameChange::Define(kind, name, values) => {
                Ok(self.frames.define(name, kind, planar(&values)?)?)
            }
            FrameChange::Here(name) => self.define_here(name),
            FrameChange::Link(child, parent) => Ok(self.frames.link(child, parent)?),
            FrameChange::Remove(name) => Ok(self.frames.remove(name)?),
            FrameChange::Enable(name) => {
                self.check_at_rest()?;
                self.select_frames(self.frames.with_enabled(name)?, queues)
            }
            FrameChange::RotationCentre(values) => self.set_rotation_centre(values, queues),
        }
    }

    /// A frame where the platform is commanded to be, or is, when nobody commands it.
    fn define_here(&mut self, name: FrameName) -> Result<(), CommandError> {
        self.check_at_rest()?;
        if !self.snapshot().is_some_and(|snapshot| snapshot.referenced) {
            return Err(CommandError::NotReady);
        }
        let pose = self.active_frames.pose_at(&self.rest_target());
        Ok(self.frames.define(name, FrameKind::Here, pose)?)
    }

    /// The point lies in the platform's own axes, so that its orientation does not matter. What changes where it is
    /// turned is X and Y: those of another point, which is where the platform has it.
    fn set_rotation_centre(
        &mut self,
        values: [Option<f64>; 3],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.check_at_rest()?;
        let [r, s, t] = values;
        if t.is_some_and(|t| t != 0.0) {
            return Err(FrameError::CentreNotPlanar.into());
        }
        let [old_r, old_s] = self.frames.rotation_centre();
        let wanted = [r.unwrap_or(old_r), s.unwrap_or(old_s)];
        self.select_frames(self.frames.with_rotation_centre(wanted)?, queues)
    }

    /// Puts other frames in force. Where the tool's origin changes, the tick has to know it: what moves is that point.
    fn select_frames(
        &mut self,
        selection: FrameSelection,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        if self.is_faulted() {
            return Err(CommandError::Faulted);
        }
        let most_arm_mm = MAX_CENTRE_OFFSET * self.base_constraints.geometry.radius_mm;
        let active_frames = self.frames.active_frames(&selection, most_arm_mm)?;
        let target = self.rest_target_in(&active_frames);
        let referenced = self.snapshot().is_some_and(|snapshot| snapshot.referenced);
        if referenced
            && !self
                .soft_limits
                .contain(&active_frames.travel_coordinates(&target))
        {
            return Err(FrameError::OutsideSoftLimits.into());
        }
        if active_frames.tool.origin() == self.active_frames.tool.origin() {
            self.apply_frames(selection, active_frames);
            return Ok(());
        }
        let centre = RotationCentre::new(self.radii(active_frames.tool.origin()))
            .ok_or(FrameError::TooFar)?;
        self.send(
            Command::Centre(centre),
            InFlight::SelectFrames(selection, active_frames),
            queues,
        )
    }

    /// The frames are in force from now on.
    pub(super) fn apply_frames(&mut self, selection: FrameSelection, active_frames: ActiveFrames) {
        self.target = self.rest_target_in(&active_frames);
        self.frames.selection = selection;
        self.active_frames = active_frames;
    }

    /// Where the stage is commanded to stand, seen through other frames.
    fn rest_target_in(&self, active_frames: &ActiveFrames) -> Coordinates {
        active_frames.target_at(&self.active_frames.pose_at(&self.rest_target()))
    }

    /// Where the stage stands: as commanded, or as measured when nobody commands it.
    fn rest_target(&self) -> Coordinates {
        if self.mode() == Mode::Holding {
            self.target
        } else {
            self.measured()
        }
    }

    fn check_at_rest(&self) -> Result<(), CommandError> {
        if self.mode() == Mode::Moving || self.is_recovering() || self.is_motion_pending() {
            return Err(FrameError::InMotion.into());
        }
        Ok(())
    }
}

/// The transform of values, those that are not given 0: in the plane.
fn planar(values: &AxisValues) -> Result<Transform, FrameError> {
    let value = |axis: Axis| values[axis.index()].unwrap_or(0.0);
    if [Axis::Z, Axis::U, Axis::V]
        .iter()
        .any(|&axis| value(axis) != 0.0)
    {
        return Err(FrameError::NotPlanar);
    }
    Ok(Transform {
        x_mm: value(Axis::X),
        y_mm: value(Axis::Y),
        w_deg: value(Axis::W),
    })
}
