//! The plant's state vector.

use nalgebra::Vector3;

/// Positions, rates and hidden states of the machine. Its time derivative has the same shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// Platform pose: x (m), y (m), theta (rad, multi-turn).
    pub pose: Vector3<f64>,
    /// Time derivative of the pose.
    pub twist: Vector3<f64>,
    /// Ring angles, rad, multi-turn. With rigid guides they follow from the pose.
    pub ring_rad: Vector3<f64>,
    /// Ring rates, rad/s.
    pub ring_rad_s: Vector3<f64>,
    /// Motor angles seen at the ring, rad, multi-turn.
    pub motor_rad: Vector3<f64>,
    /// Motor rates seen at the ring, rad/s.
    pub motor_rad_s: Vector3<f64>,
    /// Winding currents, A.
    pub current_a: Vector3<f64>,
    /// Bristle deflections of the rings' friction, rad.
    pub bristle_rad: Vector3<f64>,
    /// Bristle deflections of the motors' friction, rad.
    pub motor_bristle_rad: Vector3<f64>,
    /// Bristle deflections of the guides' friction, m.
    pub guide_bristle_m: Vector3<f64>,
}

impl State {
    /// At rest, currentless, springs and bristles relaxed.
    pub fn at_rest(pose: Vector3<f64>, ring_rad: Vector3<f64>) -> Self {
        Self {
            pose,
            ring_rad,
            motor_rad: ring_rad,
            ..Self::zeros()
        }
    }

    pub fn zeros() -> Self {
        let zeros = Vector3::zeros();
        Self {
            pose: zeros,
            twist: zeros,
            ring_rad: zeros,
            ring_rad_s: zeros,
            motor_rad: zeros,
            motor_rad_s: zeros,
            current_a: zeros,
            bristle_rad: zeros,
            motor_bristle_rad: zeros,
            guide_bristle_m: zeros,
        }
    }

    /// `self + factor * rate`.
    #[inline]
    pub fn plus(&self, factor: f64, rate: &Self) -> Self {
        Self {
            pose: self.pose + factor * rate.pose,
            twist: self.twist + factor * rate.twist,
            ring_rad: self.ring_rad + factor * rate.ring_rad,
            ring_rad_s: self.ring_rad_s + factor * rate.ring_rad_s,
            motor_rad: self.motor_rad + factor * rate.motor_rad,
            motor_rad_s: self.motor_rad_s + factor * rate.motor_rad_s,
            current_a: self.current_a + factor * rate.current_a,
            bristle_rad: self.bristle_rad + factor * rate.bristle_rad,
            motor_bristle_rad: self.motor_bristle_rad + factor * rate.motor_bristle_rad,
            guide_bristle_m: self.guide_bristle_m + factor * rate.guide_bristle_m,
        }
    }

    /// Whether every number is finite. A sum is: infinities and NaN do not cancel out of it.
    pub fn is_finite(&self) -> bool {
        let sum = self.pose.sum()
            + self.twist.sum()
            + self.ring_rad.sum()
            + self.ring_rad_s.sum()
            + self.motor_rad.sum()
            + self.motor_rad_s.sum()
            + self.current_a.sum()
            + self.bristle_rad.sum()
            + self.motor_bristle_rad.sum()
            + self.guide_bristle_m.sum();
        sum.is_finite()
    }
}
