//! Velocities: of the whole, and of single axes, which are under it.

use super::axis::{Axis, AxisValues};
use super::error::CommandError;
use super::state::Commander;
use crate::motion::Limits;

/// Slowest velocity. The longest move then still has a duration that the motion layer can count.
const MIN_SPEED_MM_S: f64 = 1e-3;

impl Commander {
    /// Speed of the platform's centre, mm/s; rotation goes down with it in proportion, so that a slow move is slow in W
    /// too. A move that only turns keeps to the same number of deg/s.
    pub fn set_velocity(&mut self, mm_s: f64) -> Result<(), CommandError> {
        self.limit_velocity(mm_s)?;
        self.velocity_is_set = true;
        Ok(())
    }

    /// The speed that the parameters allow, as at the start.
    pub fn reset_velocity(&mut self) {
        // Not refused: it is their own.
        let _ = self.limit_velocity(self.full_limits.speed_mm_s);
        self.velocity_is_set = false;
    }

    /// What a move that only turns keeps to, deg/s.
    pub(super) fn turn_velocity_deg_s(&self) -> f64 {
        let limits = &self.base_constraints.limits;
        if self.velocity_is_set {
            limits.speed_mm_s.min(self.full_limits.turn_speed_deg_s)
        } else {
            limits.turn_speed_deg_s
        }
    }

    pub(super) fn limit_velocity(&mut self, mm_s: f64) -> Result<(), CommandError> {
        if !(MIN_SPEED_MM_S..=self.full_limits.speed_mm_s).contains(&mm_s) {
            return Err(CommandError::VelocityOutOfRange { axis: None });
        }
        self.base_constraints.limits.speed_mm_s = mm_s;
        self.base_constraints.limits.turn_speed_deg_s =
            self.full_limits.turn_speed_deg_s * (mm_s / self.full_limits.speed_mm_s);
        Ok(())
    }

    /// Velocity of each axis of the work frame, mm/s and deg/s; frozen axes have none but 0.
    pub fn set_axis_velocity(&mut self, values: &AxisValues) -> Result<(), CommandError> {
        let good = |axis: Axis, value: f64| match axis.component() {
            Some(_) => {
                (MIN_SPEED_MM_S..=max_axis_velocity(&self.full_limits, axis)).contains(&value)
            }
            None => value == 0.0,
        };
        let mut named = Axis::ALL.into_iter().zip(values);
        let outside = named.find(|(axis, value)| value.is_some_and(|value| !good(*axis, value)));
        if let Some((axis, _)) = outside {
            return Err(CommandError::VelocityOutOfRange { axis: Some(axis) });
        }
        for (velocity, value) in self.velocities.iter_mut().zip(values) {
            *velocity = value.or(*velocity);
        }
        Ok(())
    }

    /// The velocity of an axis, mm/s or deg/s: as far as the limits of motion, which may have been lowered since, allow
    /// it.
    pub(super) fn axis_velocity(&self, axis: Axis) -> f64 {
        let most = max_axis_velocity(&self.full_limits, axis);
        self.velocities[axis.index()].map_or(most, |velocity| velocity.min(most))
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
