//! One instant of a motion against every limit, in single precision: for motions that others shape, sample by sample.

use super::platform::greatest;
use crate::constraints::{Constraints, MotionLimits, Speeds};
use crate::plan::axis_state::AxisState;
use crate::plan::cubic_segment::CubicSegment;
use crate::refusal::Refusal;
use crate::tolerances::{STREAM_SLACK, WORKSPACE_RADII};
use number::float::FloatMinMax;

/// The limits, per second, and the workspace, track radii.
pub struct InstantCheck<'a> {
    /// What they come from.
    pub constraints: &'a Constraints,
    /// Ticks a second.
    pub hz: f32,
    usable: f32,
    centre: [f32; 2],
    /// Of speed, acceleration and jerk.
    pub limits: MotionLimits,
    pivot_rate: f32,
    pivot_acceleration: f32,
}

/// What there is to know of an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct InstantState {
    /// Velocity of the moved point and of theta.
    pub velocity: Speeds,
    /// Their acceleration.
    pub acceleration: Speeds,
    /// Distance of the platform's centre from the track's.
    pub centre_distance: f32,
    /// Acceleration of the platform's centre.
    pub centre_acceleration: f32,
    /// Largest parts of its limit that a pivot's rate and acceleration reach.
    pub pivots: [f32; 2],
}

impl<'a> InstantCheck<'a> {
    /// Of what plans keep to.
    pub fn new(constraints: &'a Constraints) -> Self {
        let limits = &constraints.limits;
        let hz = limits.rate_hz as f32;
        Self {
            constraints,
            hz,
            usable: constraints.usable_radius as f32,
            centre: constraints.centre(),
            limits: constraints.motion_limits(),
            pivot_rate: limits.pivot_rate_rad_s as f32,
            pivot_acceleration: limits.pivot_acceleration_rad_s2 as f32,
        }
    }

    /// Looks at a state; an error where the platform's centre is not inside the track or the point out of its bounds.
    pub fn evaluate(&self, axes: &[AxisState; 3]) -> Result<InstantState, Refusal> {
        for (axis, (at, [low, high])) in axes.iter().zip(&self.constraints.bounds).enumerate() {
            if !(*low..=*high).contains(&at.rounded()) {
                return Err(Refusal::OutOfBounds { axis });
            }
        }
        let segment = CubicSegment::new(axes, self.hz);
        let platform = segment.platform(&segment.start, self.centre);
        let centre_distance = platform.radius();
        if !(centre_distance <= self.usable + WORKSPACE_RADII) {
            return Err(self.outside(centre_distance));
        }
        let [pivot_rates, pivot_accelerations] = platform.pivots();
        Ok(InstantState {
            velocity: Speeds::of(&segment.start.v),
            acceleration: Speeds::of(&segment.start.a),
            centre_distance,
            centre_acceleration: platform.centre_acceleration(),
            pivots: [
                greatest(&pivot_rates) / self.pivot_rate,
                greatest(&pivot_accelerations) / self.pivot_acceleration,
            ],
        })
    }

    /// Whether speeds are over their limits.
    pub fn is_too_fast(&self, speeds: Speeds) -> bool {
        over(speeds, self.limits.speed)
    }

    /// Whether an instant, and the `seconds` since `before` with one jerk in between, keep to everything.
    pub fn check(
        &self,
        before: &InstantState,
        now: &InstantState,
        seconds: f32,
    ) -> Result<(), Refusal> {
        if self.is_too_fast(now.velocity) {
            return Err(Refusal::Velocity);
        }
        if over(now.acceleration, self.limits.acceleration) {
            return Err(Refusal::Acceleration);
        }
        if now.pivots.iter().any(|&part| part > STREAM_SLACK) {
            return Err(Refusal::Pivots);
        }
        if !self.is_inside(before, now, seconds) {
            return Err(self.outside(before.centre_distance.fmax(now.centre_distance)));
        }
        Ok(())
    }

    /// Whether the platform's centre stays inside between two instants: the way bulges over its chord by `a t^2 / 8` at
    /// most.
    pub fn is_inside(&self, before: &InstantState, now: &InstantState, seconds: f32) -> bool {
        let segment =
            before.centre_acceleration.fmax(now.centre_acceleration) * seconds * seconds / 8.0;
        before.centre_distance.fmax(now.centre_distance) + segment <= self.usable + WORKSPACE_RADII
    }

    fn outside(&self, centre_distance: f32) -> Refusal {
        let mm = self.constraints.geometry.radius_mm;
        Refusal::OutsideDisk {
            radius_mm: f64::from(centre_distance) * mm,
            usable_mm: f64::from(self.usable) * mm,
        }
    }
}

fn over(value: Speeds, limit: Speeds) -> bool {
    value.linear > limit.linear * STREAM_SLACK || value.angular > limit.angular * STREAM_SLACK
}
