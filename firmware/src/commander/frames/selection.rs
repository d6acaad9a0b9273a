//! Which frames are in force.

use super::name::FrameName;

/// Which frames are in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnabledFrames {
    /// The base frame.
    Zero,
    /// A directed frame, or one that was made where the platform was.
    Alone(FrameName),
    /// A work frame, a tool frame, or both.
    Pair {
        /// `None`: the base frame.
        work: Option<FrameName>,
        /// `None`: the platform's own.
        tool: Option<FrameName>,
    },
}

/// The frames that are in force, and the centre of rotation: what is chosen of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSelection {
    /// Which frames.
    pub enabled: EnabledFrames,
    /// The centre of rotation in the platform, mm.
    pub rotation_centre: [f64; 2],
}
