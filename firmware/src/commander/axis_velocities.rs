//! Velocities of single axes (`VEL`), under that of the whole (`VLS`).

use super::Commander;
use super::axis::{Axis, AxisValues};
use super::moves::MIN_SPEED_MM_S;
use crate::gcs::error::ErrorCode;
use crate::motion::{Ground, Limits, Position};

impl Commander {
    /// `VEL`: of each axis of the work frame, mm/s and deg/s; frozen axes have none but 0.
    pub fn set_axis_velocity(&mut self, values: &AxisValues) -> Result<(), ErrorCode> {
        let good = |axis: Axis, value: f64| match axis.component() {
            Some(_) => {
                (MIN_SPEED_MM_S..=max_axis_velocity(&self.full_limits, axis)).contains(&value)
            }
            None => value == 0.0,
        };
        let mut named = Axis::ALL.into_iter().zip(values);
        if named.any(|(axis, value)| value.is_some_and(|value| !good(axis, value))) {
            return Err(ErrorCode::VelocityLimit);
        }
        for (velocity, value) in self.velocities.iter_mut().zip(values) {
            *velocity = value.or(*velocity);
        }
        Ok(())
    }

    /// What `VEL?` answers: as far as the limits of motion, which may have been lowered since, allow it.
    pub(super) fn axis_velocity(&self, axis: Axis) -> f64 {
        let most = max_axis_velocity(&self.full_limits, axis);
        self.velocities[axis.index()].map_or(most, |velocity| velocity.min(most))
    }

    /// What a line between two positions keeps to: no axis of the work frame is faster than `VEL` allows.
    pub(super) fn line_constraints(&self, from: &Position, to: &Position) -> Ground {
        let [x, y] = [0, 1].map(|i| to[i].wrapping_sub(from[i]) as f64);
        let length = libm::hypot(x, y);
        let way = self.active_frames.work.inverse().turned([x, y]);
        // An axis that does not move slows nothing down.
        self.constraints_with_shares(way.map(|way| way.abs() / length))
    }

    /// What a way of any shape keeps to: it may turn into any direction.
    pub(super) fn curve_constraints(&self) -> Ground {
        self.constraints_with_shares([1.0; 2])
    }

    fn constraints_with_shares(&self, shares: [f64; 2]) -> Ground {
        let mut constraints = self.constraints();
        let Limits {
            speed_mm_s,
            turn_speed_deg_s,
            ..
        } = &mut constraints.limits;
        for (axis, share) in [Axis::X, Axis::Y].into_iter().zip(shares) {
            // A share of 0, or of no length at all, gives no limit.
            if let Some(velocity) = self.velocities[axis.index()] {
                *speed_mm_s = speed_mm_s.min(velocity / share);
            }
        }
        if let Some(velocity) = self.velocities[Axis::W.index()] {
            *turn_speed_deg_s = turn_speed_deg_s.min(velocity);
        }
        constraints
    }
}

/// The limit of an axis' velocity, mm/s or deg/s.
const fn max_axis_velocity(limits: &Limits, axis: Axis) -> f64 {
    match axis {
        Axis::X | Axis::Y => limits.speed_mm_s,
        Axis::W => limits.turn_speed_deg_s,
        Axis::Z | Axis::U | Axis::V => 0.0,
    }
}
