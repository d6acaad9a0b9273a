//! What can be changed about frames.

use super::frame::FrameKind;
use super::name::FrameName;
use crate::commander::axis::AxisValues;

/// A change to the frames or to the centre of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrameChange {
    /// A frame of this kind and name lies at the values, mm and deg; 0 where there is none.
    Define(FrameKind, FrameName, AxisValues),
    /// A frame of this name lies where the platform is commanded to be, or is, when nobody commands it.
    Here(FrameName),
    /// The first lies in the second.
    Link(FrameName, FrameName),
    /// In force from now on.
    Enable(FrameName),
    /// Forgotten.
    Remove(FrameName),
    /// The centre of rotation: x, y and z, mm, as far as they change.
    RotationCentre([Option<f64>; 3]),
}
