//! The units of a [`Position`] and of an [`AxisState`](super::axis_state::AxisState) as floats, and limits in those of
//! the latter and ticks.

use super::piece::Position;
use crate::motion::constraints::Constraints;

/// Limits of translation and of rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TickLimits {
    pub translation: AxisLimits<f32>,
    pub rotation: AxisLimits<f32>,
}

/// 2^32: units of a [`Position`] in a track radius or a turn, and the inverse.
pub(crate) const POSITION_UNITS: f32 = 4_294_967_296.0;
pub(crate) const PER_POSITION_UNIT: f32 = 1.0 / POSITION_UNITS;
/// 2^72: units of an [`AxisState`](super::axis_state::AxisState), and the inverse.
pub(crate) const AXIS_UNITS: f32 = 4_722_366_482_869_645_213_696.0;
pub(crate) const PER_AXIS_UNIT: f32 = 1.0 / AXIS_UNITS;

impl TickLimits {
    pub fn new(constraints: &Constraints) -> Self {
        let limits = &constraints.limits;
        let tick = 1.0 / limits.rate_hz as f32;
        let axis = |unit: f32, [speed, acceleration, jerk]: [f64; 3]| {
            let velocity = unit * tick;
            AxisLimits {
                velocity: speed as f32 * velocity,
                acceleration: acceleration as f32 * (velocity * tick),
                jerk: jerk as f32 * (velocity * tick * tick),
            }
        };
        Self {
            translation: axis(
                AXIS_UNITS / constraints.geometry.radius_mm as f32,
                [
                    limits.speed_mm_s,
                    limits.acceleration_mm_s2,
                    limits.jerk_mm_s3,
                ],
            ),
            rotation: axis(
                AXIS_UNITS / 360.0,
                [
                    limits.turn_speed_deg_s,
                    limits.turn_acceleration_deg_s2,
                    limits.turn_jerk_deg_s3,
                ],
            ),
        }
    }
}

impl AxisLimits<f32> {
    /// With speed, acceleration and jerk times these.
    pub(crate) fn scaled(&self, speed: f32, acceleration: f32, jerk: f32) -> Self {
        Self {
            velocity: self.velocity * speed,
            acceleration: self.acceleration * acceleration,
            jerk: self.jerk * jerk,
        }
    }
}

/// Limits of one axis, the same both ways, in any consistent units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisLimits<F> {
    /// Speed.
    pub velocity: F,
    /// Acceleration.
    pub acceleration: F,
    /// Jerk.
    pub jerk: F,
}

/// x and y of a position in track radii.
pub(crate) fn xy_radii(position: &Position) -> [f64; 2] {
    const UNIT: f64 = 1.0 / 4_294_967_296.0;
    [position[0] as f64 * UNIT, position[1] as f64 * UNIT]
}
