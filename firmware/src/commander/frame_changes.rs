//! Frames and the centre of rotation: changes to what targets mean, at rest, by which nothing moves.

use super::axis::{Axis, AxisValues};
use super::coordinates::Coordinates;
use super::frames::{Choice, FrameAction, FrameName, Frames, Kind, Transform, View};
use super::{Flight, Stage};
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{MAX_CENTRE_OFFSET, RotationCentre};
use crate::queues::{Command, CommandQueues};

/// What of W counts as a whole number of turns when the centre of rotation is set, deg: less than a position tells apart.
const WHOLE_TURN_DEG: f64 = 1e-7;

impl Stage {
    pub const fn frames(&self) -> &Frames {
        &self.frames
    }

    /// `KSD`, `KSF`, `KST`, `KSW`, `KLN`, `KRM`, `KEN`, `SPI`.
    pub fn change_frames(
        &mut self,
        action: &FrameAction,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        match *action {
            FrameAction::Define(kind, name, values) => {
                self.frames.define(name, kind, planar(&values)?)
            }
            FrameAction::Here(name) => self.define_here(name),
            FrameAction::Link(child, parent) => self.frames.link(child, parent),
            FrameAction::Remove(name) => self.frames.remove(name),
            FrameAction::Enable(name) => {
                self.check_at_rest()?;
                self.choose(self.frames.with_enabled(name)?, queues)
            }
            FrameAction::Pivot(values) => self.set_pivot(values, queues),
        }
    }

    /// `KSF`: where the platform is commanded to be, or is, when nobody commands it.
    fn define_here(&mut self, name: FrameName) -> Result<(), ErrorCode> {
        self.check_at_rest()?;
        if !self.snapshot().is_some_and(|snapshot| snapshot.referenced) {
            return Err(ErrorCode::NotReady);
        }
        let pose = self.view.pose_at(&self.standing());
        self.frames.define(name, Kind::Here, pose)
    }

    fn set_pivot(
        &mut self,
        values: [Option<f64>; 3],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_at_rest()?;
        let [r, s, t] = values;
        if t.is_some_and(|t| t != 0.0) {
            return Err(ErrorCode::OutOfRange);
        }
        let w_deg = libm::remainder(self.standing()[Axis::W.index()], 360.0);
        if w_deg.abs() > WHOLE_TURN_DEG {
            return Err(ErrorCode::PivotNotSettable);
        }
        let [old_r, old_s] = self.frames.pivot();
        let wanted = [r.unwrap_or(old_r), s.unwrap_or(old_s)];
        self.choose(self.frames.with_pivot(wanted)?, queues)
    }

    /// Puts other frames in force. Where the tool's origin changes, the tick has to know it: what moves is that point.
    fn choose(&mut self, choice: Choice, queues: &mut CommandQueues<'_>) -> Result<(), ErrorCode> {
        if self.is_faulted() {
            return Err(ErrorCode::MotionError);
        }
        let most_arm_mm = MAX_CENTRE_OFFSET * self.base.geometry.radius_mm;
        let view = self.frames.view(&choice, most_arm_mm)?;
        let target = self.seen_from(&view);
        let referenced = self.snapshot().is_some_and(|snapshot| snapshot.referenced);
        if referenced && !self.soft.allow(&view.limited(&target)) {
            return Err(ErrorCode::SoftLimit);
        }
        if view.tool.origin() == self.view.tool.origin() {
            self.take_frames(choice, view);
            return Ok(());
        }
        let centre =
            RotationCentre::new(self.radii(view.tool.origin())).ok_or(ErrorCode::OutOfRange)?;
        self.send(
            Command::Centre(centre),
            Flight::Frames(choice, view),
            queues,
        )
    }

    /// The frames are in force from now on.
    pub(super) fn take_frames(&mut self, choice: Choice, view: View) {
        self.target = self.seen_from(&view);
        self.frames.choice = choice;
        self.view = view;
    }

    /// Where the stage is commanded to stand, seen through other frames.
    fn seen_from(&self, view: &View) -> Coordinates {
        view.target_at(&self.view.pose_at(&self.standing()))
    }

    /// Where the stage stands: as commanded, or as measured when nobody commands it.
    fn standing(&self) -> Coordinates {
        if self.mode() == Mode::Holding {
            self.target
        } else {
            self.measured()
        }
    }

    fn check_at_rest(&self) -> Result<(), ErrorCode> {
        if self.mode() == Mode::Moving || self.motion_is_due() {
            return Err(ErrorCode::WhileMoving);
        }
        Ok(())
    }
}

/// The transform of values, those that are not given 0: in the plane.
fn planar(values: &AxisValues) -> Result<Transform, ErrorCode> {
    let value = |axis: Axis| values[axis.index()].unwrap_or(0.0);
    if [Axis::Z, Axis::U, Axis::V]
        .iter()
        .any(|&axis| value(axis) != 0.0)
    {
        return Err(ErrorCode::NotForStage);
    }
    Ok(Transform {
        x_mm: value(Axis::X),
        y_mm: value(Axis::Y),
        w_deg: value(Axis::W),
    })
}
