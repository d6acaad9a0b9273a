//! How a target in the frames that are enabled is a pose of the platform.
//!
//! ```text
//!   base ---- work ----> work frame ---- target ----> tool frame <---- tool ---- platform
//!     \________________________ pose of the platform ______________________________/
//!
//!   pose tool = work target
//! ```
//!
//! The tool frame's origin is the point that moves and about which the platform turns. Its place in the base frame is
//! the work frame's transform of the target's x and y, whatever the tool is: that point is what the motion layer moves
//! in a straight line.

use super::transform::Transform;
use crate::commander::axis::{Axis, Coordinates};

/// The frames in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveFrames {
    /// The work frame in the base frame.
    pub work: Transform,
    /// The tool frame in the platform.
    pub tool: Transform,
    /// Where in the base frame the coordinates of the travel and of the soft limits count from, mm: where the commanded
    /// point lies when the platform is at the base frame's zero, if that point is a centre of rotation; else 0.
    pub zero: [f64; 2],
}

impl ActiveFrames {
    /// No frame: the platform centre in the base frame.
    pub const BASE: Self = Self {
        work: Transform::IDENTITY,
        tool: Transform::IDENTITY,
        zero: [0.0; 2],
    };

    /// The commanded point in the base frame (mm) and the platform's theta (deg) of a target.
    pub fn point_of(&self, target: &Coordinates) -> Transform {
        let at = self.work.then(&planar(target));
        Transform {
            w_deg: at.w_deg - self.tool.w_deg,
            ..at
        }
    }

    /// The target that [`point_of`](Self::point_of) turns into this point.
    pub fn target_of(&self, point: &Transform) -> Coordinates {
        let turned = Transform {
            w_deg: point.w_deg + self.tool.w_deg,
            ..*point
        };
        coordinates(&self.work.inverse().then(&turned))
    }

    /// The target at which the platform has this pose.
    pub fn target_at(&self, pose: &Transform) -> Coordinates {
        let [x_mm, y_mm] = pose.then(&self.tool).origin();
        self.target_of(&Transform {
            x_mm,
            y_mm,
            w_deg: pose.w_deg,
        })
    }

    /// The pose of the platform at a target.
    pub fn pose_at(&self, target: &Coordinates) -> Transform {
        self.work.then(&planar(target)).then(&self.tool.inverse())
    }

    /// A target as travel and soft limits count it: the commanded point in the base frame's axes, from
    /// [`zero`](Self::zero).
    pub fn travel_coordinates(&self, target: &Coordinates) -> Coordinates {
        let point = self.point_of(target);
        let mut limited = *target;
        limited[Axis::X.index()] = point.x_mm - self.zero[0];
        limited[Axis::Y.index()] = point.y_mm - self.zero[1];
        limited[Axis::W.index()] = point.w_deg;
        limited
    }

    /// How far the tool's origin is from the platform centre, mm.
    pub fn arm_mm(&self) -> f64 {
        let [x, y] = self.tool.origin();
        libm::hypot(x, y)
    }
}

fn planar(target: &Coordinates) -> Transform {
    Transform {
        x_mm: target[Axis::X.index()],
        y_mm: target[Axis::Y.index()],
        w_deg: target[Axis::W.index()],
    }
}

fn coordinates(at: &Transform) -> Coordinates {
    [at.x_mm, at.y_mm, 0.0, 0.0, 0.0, at.w_deg]
}
