//! From a selection of frames to the transforms it means.

use super::active_frames::ActiveFrames;
use super::error::FrameError;
use super::frame::FrameKind;
use super::name::FrameName;
use super::selection::{EnabledFrames, FrameSelection};
use super::transform::Transform;
use super::tree::FrameTree;

/// Furthest that a work frame may lie from the base frame's origin, mm: far beyond any laboratory, near enough for f64.
const MAX_WORK_FRAME_MM: f64 = 1e5;

impl FrameTree {
    /// What would be in force once `name` is enabled.
    pub fn with_enabled(&self, name: FrameName) -> Result<FrameSelection, FrameError> {
        let (work, tool) = match self.selection.enabled {
            EnabledFrames::Pair { work, tool } => (work, tool),
            _ => (None, None),
        };
        let enabled = if name == FrameName::ZERO {
            EnabledFrames::Zero
        } else {
            match self.find(name).ok_or(FrameError::Unknown(name))?.kind {
                FrameKind::Directed | FrameKind::Here => EnabledFrames::Alone(name),
                FrameKind::Work => EnabledFrames::Pair {
                    work: Some(name),
                    tool,
                },
                FrameKind::Tool => EnabledFrames::Pair {
                    work,
                    tool: Some(name),
                },
            }
        };
        Ok(FrameSelection {
            enabled,
            ..self.selection
        })
    }

    /// What would be in force with another centre of rotation.
    pub fn with_rotation_centre(
        &self,
        rotation_centre: [f64; 2],
    ) -> Result<FrameSelection, FrameError> {
        if matches!(self.selection.enabled, EnabledFrames::Pair { .. }) {
            return Err(FrameError::CentreGivenByTool);
        }
        Ok(FrameSelection {
            rotation_centre,
            ..self.selection
        })
    }

    /// The centre of rotation that has been set, as far as it counts, mm.
    pub fn rotation_centre(&self) -> [f64; 2] {
        match self.selection.enabled {
            EnabledFrames::Pair { .. } => [0.0; 2],
            _ => self.selection.rotation_centre,
        }
    }

    /// How targets are poses with these frames; [`FrameError::TooFar`] for a tool that is more than `most_arm_mm` from
    /// the platform centre, or a work frame out of any laboratory.
    pub fn active_frames(
        &self,
        selection: &FrameSelection,
        most_arm_mm: f64,
    ) -> Result<ActiveFrames, FrameError> {
        let rotation_centre = Transform::to(selection.rotation_centre);
        let active_frames = match selection.enabled {
            EnabledFrames::Zero => ActiveFrames {
                work: rotation_centre,
                tool: rotation_centre,
                zero: rotation_centre.origin(),
            },
            EnabledFrames::Alone(name) => {
                let work = self.in_base(name).then(&rotation_centre);
                match self.find(name).map(|frame| frame.kind) {
                    Some(FrameKind::Here) => ActiveFrames {
                        work,
                        tool: rotation_centre,
                        zero: rotation_centre.origin(),
                    },
                    _ => ActiveFrames {
                        work,
                        tool: work,
                        zero: work.origin(),
                    },
                }
            }
            EnabledFrames::Pair { work, tool } => {
                let in_base = |name: Option<FrameName>| {
                    name.map_or(Transform::IDENTITY, |name| self.in_base(name))
                };
                ActiveFrames {
                    work: in_base(work),
                    tool: in_base(tool),
                    zero: [0.0; 2],
                }
            }
        };
        let [x, y] = active_frames.work.origin();
        if active_frames.arm_mm() > most_arm_mm || libm::hypot(x, y) > MAX_WORK_FRAME_MM {
            return Err(FrameError::TooFar);
        }
        Ok(active_frames)
    }
}
