//! What a plan breaks.

use number::float::FloatMinMax;

/// What a plan breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// Disk or bounds, on the way or in a stop.
    Workspace,
    /// Speed, by this factor.
    Speed(f32),
    /// Acceleration or jerk, by this factor.
    Acceleration(f32),
    /// The pivots' rate, by this factor.
    PivotRate(f32),
    /// The pivots' acceleration, by this factor.
    PivotAcceleration(f32),
    /// Disk or bounds, in a stop from an instant on the way.
    NoRoomToStop,
}

impl Violation {
    pub(super) fn is_of_pivots(&self) -> bool {
        matches!(self, Self::PivotRate(_) | Self::PivotAcceleration(_))
    }

    /// This, or what was seen of the same before, when that was worse.
    pub(super) fn or_worse(self, before: Option<Self>) -> Self {
        match (self, before) {
            (Self::Speed(now), Some(Self::Speed(over))) => Self::Speed(now.fmax(over)),
            (Self::Acceleration(now), Some(Self::Acceleration(over))) => {
                Self::Acceleration(now.fmax(over))
            }
            (Self::PivotRate(now), Some(Self::PivotRate(over))) => Self::PivotRate(now.fmax(over)),
            (Self::PivotAcceleration(now), Some(Self::PivotAcceleration(over))) => {
                Self::PivotAcceleration(now.fmax(over))
            }
            _ => self,
        }
    }
}
