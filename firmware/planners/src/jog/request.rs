//! What a jog is planned from: the velocity that is wanted, limits in single precision, and the state that is left.

use crate::steady_motion::SteadyMotion;
use motion::check::pivot_bounds::PivotBound;
use motion::check::target::MAX_TURNS;
use motion::constraints::{Constraints, MotionLimits, Speeds};
use motion::plan::axis_state::{AXIS_UNITS, PER_POSITION_UNIT};
use motion::plan::axis_state::{AxisState, SUB_BITS};
use motion::plan::cubic_segment::MotionState;
use motion::refusal::{Refusal, RetargetError};
use motion::tolerances::JOG_RADII;
use number::float::{FloatMinMax, hypot, i64_to_f32_fast, truncate_f64};

/// Least part of the ordinary acceleration with which a jog is begun.
const LEAST_FORCE: f32 = 0.05;

/// Everything that does not depend on the state.
pub(super) struct JogRequest<'a> {
    pub constraints: &'a Constraints,
    pub hz: f32,
    pivot_bound: PivotBound,
    usable: f32,
    /// Wanted, 2^-72 units a tick.
    pub velocity: [i64; 3],
    pub limits: MotionLimits,
}

/// Whether the size of a number is within a positive one; NaN is not. Compared as whole numbers: see
/// [`Limits`](motion::Limits).
fn is_within(value: f64, most: f64) -> bool {
    value.abs().to_bits() <= most.to_bits()
}

/// A state in track radii, rad and seconds: of the moved point, and where the platform's centre is.
pub(super) struct InitialState {
    pub platform: [f32; 2],
    pub motion: MotionState,
}

impl<'a> JogRequest<'a> {
    pub fn new(velocity: &[f64; 3], constraints: &'a Constraints) -> Result<Self, Refusal> {
        let limits = &constraints.limits;
        if !limits.all_positive() {
            return Err(Refusal::InvalidLimits);
        }
        let [x, y, turning] = *velocity;
        let speed = limits.speed_mm_s;
        if !(is_within(x * x + y * y, speed * speed) && is_within(turning, limits.turn_speed_deg_s))
        {
            return Err(Refusal::Velocity);
        }
        let mm = constraints.geometry.radius_mm;
        // One division of an f64 costs as much as many products.
        let per_mm = f64::from(AXIS_UNITS) / (limits.rate_hz * mm);
        let per_deg = per_mm * (mm * (1.0 / 360.0));
        Ok(Self {
            constraints,
            hz: limits.rate_hz as f32,
            pivot_bound: PivotBound::new(constraints),
            usable: constraints.usable_radius as f32,
            velocity: [x * per_mm, y * per_mm, turning * per_deg].map(truncate_f64),
            limits: constraints.motion_limits(),
        })
    }

    /// How far out the jog to `target` may go, and how hard it may be begun and ended there.
    pub fn limits_towards(
        &self,
        now: &InitialState,
        target: &[f32; 3],
    ) -> Result<(f32, MotionLimits), RetargetError> {
        let pivot_bound = &self.pivot_bound;
        let speeds = Speeds::of(target);
        let most = pivot_bound
            .max_radius(speeds, self.usable)
            .ok_or(RetargetError::Refused(Refusal::PivotRate {
                radius_mm: 0.0,
            }))?;
        let out = hypot(now.platform[0], now.platform[1]);
        if out > most + JOG_RADII {
            let radius_mm = f64::from(most) * self.constraints.geometry.radius_mm;
            return Err(RetargetError::Refused(Refusal::PivotRate { radius_mm }));
        }
        let travels =
            |speeds: Speeds| speeds.linear > 0.0 || speeds.angular * pivot_bound.arm > 0.0;
        let MotionState { v, a, .. } = &now.motion;
        let (speed, acceleration) = (Speeds::of(v), Speeds::of(a));
        let radius = if travels(speeds) || travels(speed) || travels(acceleration) {
            most
        } else {
            out
        };
        // An acceleration under way adds to the velocity while it is released: straight from the one to this.
        let jerk = self.limits.jerk;
        let release_s =
            (acceleration.linear / jerk.linear).fmax(acceleration.angular / jerk.angular);
        let released = each!(i => v[i] + a[i] * release_s / 2.0);
        let gained = speed.max(Speeds::of(&released));
        let margin = pivot_bound.acceleration_margin(radius, speeds.max(gained));
        let part = margin / pivot_bound.acceleration_demand(radius, self.limits.acceleration);
        if part < LEAST_FORCE {
            return Err(RetargetError::NeedsStop);
        }
        let part = part.fmin(1.0);
        Ok((radius, self.limits.scaled(part, 1.0)))
    }

    /// Seconds of steady motion until theta meets its bounds.
    pub fn time_to_theta_bound(&self, theta: &AxisState, wanted: i64) -> f32 {
        let [low, high] = self.constraints.bounds[2];
        let now = theta.rounded();
        let (way, velocity) = match wanted {
            0 => return f32::INFINITY,
            1.. => (high.min(MAX_TURNS).saturating_sub(now), wanted),
            _ => (now.saturating_sub(low.max(-MAX_TURNS)), -wanted),
        };
        let units = (1_i64 << SUB_BITS) as f32;
        i64_to_f32_fast(way.max(0)) * (1.0 - 5.0 * f32::EPSILON)
            / (i64_to_f32_fast(velocity) / units * self.hz)
    }

    /// The steady motion at `velocity` from a position.
    #[inline(never)]
    pub fn steady(&self, axes: &[AxisState; 3], velocity: &[f32; 3]) -> SteadyMotion {
        let [x, y, turning] = *velocity;
        SteadyMotion {
            point: both!(i => i64_to_f32_fast(axes[i].rounded()) * PER_POSITION_UNIT),
            theta: axes[2].rounded(),
            velocity: [x, y],
            turning,
            centre: self.constraints.centre(),
        }
    }
}

impl InitialState {
    pub fn new(axes: &[AxisState; 3], request: &JogRequest) -> Self {
        Self {
            platform: request.steady(axes, &[0.0; 3]).platform(0.0),
            motion: MotionState::new(axes, request.hz),
        }
    }
}
