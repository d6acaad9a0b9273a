//! A ramp of the acceleration, before it is rounded.

use super::segments::MAX_SEGMENTS;
use heapless::Vec;

/// A ramp of the acceleration.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct JerkRamp {
    /// Where its middle is, ticks.
    pub middle: i32,
    /// How long it is, ticks: even.
    pub ticks: i32,
    /// How much the acceleration changes, s per tick squared.
    pub change: f32,
}

/// Ramps that make a motion.
pub(super) type JerkRamps = Vec<JerkRamp, { MAX_SEGMENTS + 1 }>;
