//! What plans keep to: the limits of motion, as velocities, frames and soft limits leave them.

use super::axis::Axis;
use super::coordinates::{DEGREES_A_TURN, UNITS_PER_RADIUS};
use super::state::Commander;
use crate::motion::{Constraints, Limits, Position};

impl Commander {
    /// What plans keep to now.
    pub(super) fn constraints(&self) -> Constraints {
        let radius_mm = self.base_constraints.geometry.radius_mm;
        let mut constraints = self.base_constraints;
        let share = self.calibrating.pivot_share();
        constraints.limits.pivot_rate_rad_s *= share;
        constraints.limits.pivot_acceleration_rad_s2 *= share;
        constraints.rotation_centre = self.radii(self.active_frames.tool.origin());
        let [x, y] = self.active_frames.zero;
        for (bounds, (axis, zero, per_unit)) in (constraints.bounds.iter_mut()).zip([
            (Axis::X, x, radius_mm),
            (Axis::Y, y, radius_mm),
            (Axis::W, 0.0, DEGREES_A_TURN),
        ]) {
            for (bound, set) in bounds.iter_mut().zip(self.soft_limits.active_range(axis)) {
                if let Some(value) = set {
                    *bound = libm::rint((value + zero) / per_unit * UNITS_PER_RADIUS) as i64;
                }
            }
        }
        constraints
    }

    /// mm to track radii.
    pub(super) fn radii(&self, mm: [f64; 2]) -> [f64; 2] {
        mm.map(|mm| mm / self.base_constraints.geometry.radius_mm)
    }

    /// What a line between two positions keeps to: no axis of the work frame is faster than its velocity.
    pub(super) fn line_constraints(&self, from: &Position, to: &Position) -> Constraints {
        let [x, y] = [0, 1].map(|i| to[i].wrapping_sub(from[i]) as f64);
        let length = libm::hypot(x, y);
        let way = self.active_frames.work.inverse().turned([x, y]);
        // An axis that does not move slows nothing down.
        let mut constraints = self.constraints_with_shares(way.map(|way| way.abs() / length));
        if length == 0.0 {
            self.limit_turn(&mut constraints);
        }
        constraints
    }

    /// What a way of any shape to a target keeps to: it may turn into any direction.
    pub(super) fn curve_constraints(&self, to: &Position) -> Constraints {
        let mut constraints = self.constraints_with_shares([1.0; 2]);
        let is_there = |place: &Position| place[..2] == to[..2];
        let only_turns = self
            .active_plan()
            .is_some_and(|(under_way, _)| is_there(&under_way.plan.end));
        if only_turns && is_there(&self.setpoint()) {
            self.limit_turn(&mut constraints);
        }
        constraints
    }

    /// For a way that only turns.
    fn limit_turn(&self, constraints: &mut Constraints) {
        let velocity = self.velocities[Axis::W.index()].unwrap_or(f64::INFINITY);
        constraints.limits.turn_speed_deg_s = self.turn_velocity_deg_s().min(velocity);
    }

    fn constraints_with_shares(&self, shares: [f64; 2]) -> Constraints {
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
