//! What can not be done with frames.

use super::FrameName;
use core::fmt;

/// Why frames, or the centre of rotation, stay as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// There is no frame of this name.
    Unknown(FrameName),
    /// No room for another frame.
    Full,
    /// The frame is enabled, or one that is enabled lies in it; or it is the base frame.
    InUse(FrameName),
    /// Frames lie in it.
    HasChildren(FrameName),
    /// The parent is the frame itself, or lies in it.
    Circular,
    /// A tool frame lies in the platform, all others in the base frame: no chain goes through both.
    KindsDoNotMix,
    /// A value of a frozen axis that is not 0: frames lie in the plane.
    NotPlanar,
    /// A third coordinate of the centre of rotation that is not 0.
    CentreNotPlanar,
    /// A work or tool frame is enabled: the tool's origin is the centre of rotation.
    CentreGivenByTool,
    /// The tool's origin is too far from the platform's centre, or the work frame out of any laboratory.
    TooFar,
    /// The soft limits would leave out where the stage stands.
    OutsideSoftLimits,
    /// Not while the stage moves.
    InMotion,
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "no frame {name}"),
            Self::Full => f.write_str("no room for another frame"),
            Self::InUse(name) => write!(f, "frame {name} is in use"),
            Self::HasChildren(name) => write!(f, "frames lie in {name}"),
            Self::Circular => f.write_str("the parent lies in the frame"),
            Self::KindsDoNotMix => {
                f.write_str("a tool frame lies in the platform, others in the base frame")
            }
            Self::NotPlanar => f.write_str("frames lie in the plane"),
            Self::CentreNotPlanar => f.write_str("the centre of rotation lies in the plane"),
            Self::CentreGivenByTool => f.write_str("a work or tool frame is enabled"),
            Self::TooFar => f.write_str("a frame's origin is too far away"),
            Self::OutsideSoftLimits => f.write_str("the stage would stand outside the soft limits"),
            Self::InMotion => f.write_str("not while the stage moves"),
        }
    }
}

impl core::error::Error for FrameError {}
