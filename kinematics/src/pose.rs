//! Where the platform is and how it moves. Lengths are in track radii, in the base frame.

use crate::scalar::Scalar;

/// Pose of the platform: its centre C and its orientation, multi-turn.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pose<T: Scalar> {
    /// Centre along the base frame's x, track radii.
    pub x: T,
    /// Centre along the base frame's y, track radii.
    pub y: T,
    /// Orientation, multi-turn.
    pub theta: T::Angle,
}

/// Velocity of the platform.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Twist<T> {
    /// Track radii per second.
    pub x: T,
    /// Track radii per second.
    pub y: T,
    /// rad/s.
    pub theta: T,
}

/// Acceleration of the platform.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Acceleration<T> {
    /// Track radii per second squared.
    pub x: T,
    /// Track radii per second squared.
    pub y: T,
    /// rad/s^2.
    pub theta: T,
}
