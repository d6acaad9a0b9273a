//! One instant of a motion against every limit, in single precision: for motions that others shape, sample by sample.

use super::platform::{Platform, greatest};
use crate::constraints::Constraints;
use crate::constraints::Speeds;
use crate::plan::axis_state::AxisState;
use crate::plan::axis_state::{PER_AXIS_UNIT, PER_POSITION_UNIT};
use crate::plan::setpoint::{ACCELERATION_CUT, VELOCITY_CUT};
use crate::refusal::Refusal;
use crate::tolerances::{STREAM_SLACK, WORKSPACE_RADII};
use kinematics::Angle;
use number::float::FloatMinMax;
use number::sin_cos_f32;

/// The limits, per second, and the workspace, track radii.
pub struct InstantCheck<'a> {
    /// What they come from.
    pub constraints: &'a Constraints,
    /// Ticks a second.
    pub hz: f32,
    usable: f32,
    centre: [f32; 2],
    speed_limit: Speeds,
    /// Of acceleration.
    pub acceleration_limit: Speeds,
    /// Of jerk.
    pub jerk_limit: Speeds,
    pivot_rate: f32,
    pivot_acceleration: f32,
    /// Units of a velocity and of an acceleration that have been cut, per second.
    velocity: f32,
    acceleration: f32,
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
        let mm = constraints.geometry.radius_mm as f32;
        let hz = limits.rate_hz as f32;
        let speeds = |mm_s: f64, deg_s: f64| Speeds {
            linear: mm_s as f32 / mm,
            angular: deg_s as f32 * (core::f32::consts::PI / 180.0),
        };
        Self {
            constraints,
            hz,
            usable: constraints.usable_radius as f32,
            centre: constraints.rotation_centre.map(|radii| radii as f32),
            speed_limit: speeds(limits.speed_mm_s, limits.turn_speed_deg_s),
            acceleration_limit: speeds(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2),
            jerk_limit: speeds(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
            pivot_rate: limits.pivot_rate_rad_s as f32,
            pivot_acceleration: limits.pivot_acceleration_rad_s2 as f32,
            velocity: PER_AXIS_UNIT * (1_u64 << VELOCITY_CUT) as f32 * hz,
            acceleration: PER_AXIS_UNIT * (1_u64 << ACCELERATION_CUT) as f32 * hz * hz,
        }
    }

    /// Looks at a state; an error where the platform's centre is not inside the track or the point out of its bounds.
    pub fn evaluate(&self, axes: &[AxisState; 3]) -> Result<InstantState, Refusal> {
        let at = each!(i => axes[i].rounded());
        for (axis, (at, [low, high])) in at.iter().zip(&self.constraints.bounds).enumerate() {
            if !(low..=high).contains(&at) {
                return Err(Refusal::OutOfBounds { axis });
            }
        }
        let v = rates(each!(i => axes[i].velocity >> VELOCITY_CUT), self.velocity);
        let a = rates(
            each!(i => axes[i].acceleration >> ACCELERATION_CUT),
            self.acceleration,
        );
        let (sin, cos) = sin_cos_f32(Angle::from_units(at[2]));
        let direction = (sin, cos);
        let point = [radii(at[0]), radii(at[1])];
        let platform = Platform::new(point, direction, v, a, self.centre);
        let centre_distance = platform.radius();
        if !(centre_distance <= self.usable + WORKSPACE_RADII) {
            return Err(self.outside(centre_distance));
        }
        let [pivot_rates, pivot_accelerations] = platform.pivots();
        Ok(InstantState {
            velocity: Speeds::of(&v),
            acceleration: Speeds::of(&a),
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
        over(speeds, self.speed_limit)
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
        if over(now.acceleration, self.acceleration_limit) {
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

/// Rates of x and y in track radii, of theta in rad; cut to 32 bits, which a float loads in one instruction.
fn rates(cut: [i64; 3], unit: f32) -> [f32; 3] {
    let [x, y, theta] = each!(i => cut[i] as i32 as f32 * unit);
    [x, y, theta * core::f32::consts::TAU]
}

/// Track radii of a coordinate within two of them, which any inside the bounds is that can be.
fn radii(units: i64) -> f32 {
    const CUT: u32 = 2;
    let most = i64::from(i32::MAX);
    (units >> CUT).clamp(-most, most) as i32 as f32 * (PER_POSITION_UNIT * (1 << CUT) as f32)
}
