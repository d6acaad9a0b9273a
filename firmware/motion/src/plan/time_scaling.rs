//! How fast the time of a plan runs in the stop of a fault: what is given, and where the stop is.

/// How a motion is slowed down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultStop {
    /// Part of the stop that is a tick.
    pub(super) step: f32,
    pub(super) rate_hz: f32,
}

/// Where in its stop a motion is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TimeScaling {
    /// Part of the stop that is over.
    pub(super) progress: f32,
    /// Part of the plan's tick that has begun.
    pub(super) part: f32,
    pub(super) rate: f32,
    /// Change of the rate, 1/s.
    pub(super) rate_change: f32,
}

impl FaultStop {
    /// A stop that takes so long.
    pub fn new(duration_s: f64, rate_hz: f64) -> Self {
        Self {
            step: (1.0 / (duration_s * rate_hz)) as f32,
            rate_hz: rate_hz as f32,
        }
    }
}
