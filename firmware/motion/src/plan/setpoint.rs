//! What the control loop follows at a tick, and the factors that make it of the integers of a plan.

use super::piece::Position;
use kinematics::{Acceleration, Twist};

/// Where the point that is moved, or the platform's centre, should be at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Pose.
    pub position: Position,
    /// Velocity, track radii and rad per second.
    pub twist: Twist<f32>,
    /// Acceleration, track radii and rad per second squared.
    pub acceleration: Acceleration<f32>,
}

/// Factors from the integers of [`AxisState`](super::axis_state::AxisState) to physical rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointScale {
    pub(super) velocity: f32,
    pub(super) turn_velocity: f32,
    pub(super) acceleration: f32,
    pub(super) turn_acceleration: f32,
    pub(super) rate_hz: f32,
}

/// Bits cut from a velocity and from an acceleration to make them 32 bits wide: full range 39 turns per second and
/// 3,050 per second squared at 20 kHz, resolution 1e-7 rad/s and 9e-6 rad/s^2. An urgent stop brakes as hard as a pivot
/// can, 300 rad/s^2 by default: some 350 track radii per second squared.
pub const VELOCITY_CUT: u32 = 32;
/// The same of an acceleration.
pub const ACCELERATION_CUT: u32 = 24;

impl SetpointScale {
    /// For `rate_hz` ticks a second.
    pub fn new(rate_hz: f64) -> Self {
        let unit = |cut: u32| libm::exp2(f64::from(cut) - 72.0);
        let velocity = unit(VELOCITY_CUT) * rate_hz;
        let acceleration = unit(ACCELERATION_CUT) * rate_hz * rate_hz;
        Self {
            velocity: velocity as f32,
            turn_velocity: (velocity * core::f64::consts::TAU) as f32,
            acceleration: acceleration as f32,
            turn_acceleration: (acceleration * core::f64::consts::TAU) as f32,
            rate_hz: rate_hz as f32,
        }
    }
}
