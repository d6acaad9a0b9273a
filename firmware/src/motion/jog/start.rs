//! What a jog is planned from: the velocity that is wanted, limits in single precision, and the state that is left.

use super::super::refusal::Refusal;
use super::travel::Steady;
use crate::motion::brake::velocity_change::{Force, release_seconds};
use crate::motion::check::pivot_bounds::{Pace, Swing, per_second};
use crate::motion::constraints::Constraints;
use crate::motion::plan::axis_state::{AxisState, SUB_BITS};
use crate::motion::plan::units::{AXIS_UNITS, PER_POSITION_UNIT};
use crate::motion::retarget::RetargetError;
use crate::number::Fixed;
use crate::number::float::{FloatMinMax, hypot, i64_to_f32_fast};
use kinematics::{Angle, Scalar};

/// 0.2 um on the reference stage.
const RIM: f32 = 2e-6;
/// A thousand million turns.
const MOST_TURNS: i64 = 1_000_000_000 << 32;
/// Least part of the ordinary acceleration with which a jog is begun.
const LEAST_FORCE: f32 = 0.05;

/// Everything that does not depend on the state.
pub(super) struct Setting<'a> {
    pub ground: &'a Constraints,
    pub hz: f32,
    swing: Swing,
    usable: f32,
    /// Wanted, 2^-72 units a tick.
    pub velocity: [i64; 3],
    force: Force,
}

/// Whether the size of a number is within a positive one; NaN is not. Compared as whole numbers: see [`Limits`](crate::motion::Limits).
fn is_within(value: f64, most: f64) -> bool {
    value.abs().to_bits() <= most.to_bits()
}

/// A state in track radii, rad and seconds: of the moved point, and where the platform's centre is.
pub(super) struct State {
    pub platform: [f32; 2],
    pub velocity: [f32; 3],
    pub acceleration: [f32; 3],
}

impl<'a> Setting<'a> {
    pub fn new(velocity: &[f64; 3], ground: &'a Constraints) -> Result<Self, Refusal> {
        let limits = &ground.limits;
        if !limits.all_positive() {
            return Err(Refusal::InvalidLimits);
        }
        let [x, y, turning] = *velocity;
        let speed = limits.speed_mm_s;
        if !(is_within(x * x + y * y, speed * speed) && is_within(turning, limits.turn_speed_deg_s))
        {
            return Err(Refusal::Velocity);
        }
        let mm = ground.geometry.radius_mm;
        let units = f64::from(AXIS_UNITS) / limits.rate_hz;
        let (per_mm, per_deg) = (units / mm, units * (1.0 / 360.0));
        let over_mm = 1.0 / mm as f32;
        let pace = |mm_s: f64, deg_s: f64| Pace {
            way: mm_s as f32 * over_mm,
            turn: (deg_s as f32).to_radians(),
        };
        Ok(Self {
            ground,
            hz: limits.rate_hz as f32,
            swing: Swing::new(ground),
            usable: ground.usable_radius as f32,
            velocity: [x * per_mm, y * per_mm, turning * per_deg].map(|rate| rate as i64),
            force: Force {
                acceleration: pace(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2),
                jerk: pace(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
            },
        })
    }

    /// How far out the jog to `target` may go, and how hard it may be begun and ended there.
    pub fn force(&self, now: &State, target: &[f32; 3]) -> Result<(f32, Force), RetargetError> {
        let swing = &self.swing;
        let pace = Pace::of(target);
        let most = swing
            .radius(pace, self.usable)
            .ok_or(RetargetError::Refused(Refusal::PivotRate {
                radius_mm: 0.0,
            }))?;
        let out = hypot(now.platform[0], now.platform[1]);
        if out > most + RIM {
            let radius_mm = f64::from(most) * self.ground.geometry.radius_mm;
            return Err(RetargetError::Refused(Refusal::PivotRate { radius_mm }));
        }
        let travels = |pace: Pace| pace.way > 0.0 || pace.turn * swing.arm() > 0.0;
        let (speed, force) = (Pace::of(&now.velocity), Pace::of(&now.acceleration));
        let radius = if travels(pace) || travels(speed) || travels(force) {
            most
        } else {
            out
        };
        // An acceleration under way adds to the velocity while it is released: straight from the one to this.
        let half = release_seconds(force, self.force.jerk) / 2.0;
        let released = [0, 1, 2].map(|i| now.velocity[i] + now.acceleration[i] * half);
        let gained = speed.max(Pace::of(&released));
        let room = swing.room(radius, pace.max(gained));
        let part = room / swing.need(radius, self.force.acceleration);
        if part < LEAST_FORCE {
            return Err(RetargetError::NeedsStop);
        }
        let part = part.fmin(1.0);
        let acceleration = Pace {
            way: self.force.acceleration.way * part,
            turn: self.force.acceleration.turn * part,
        };
        Ok((
            radius,
            Force {
                acceleration,
                ..self.force
            },
        ))
    }

    /// Seconds of steady motion until theta meets its bounds.
    pub fn turn_seconds(&self, theta: &AxisState, wanted: i64) -> f32 {
        let [low, high] = self.ground.bounds[2];
        let now = theta.rounded();
        let (way, velocity) = match wanted {
            0 => return f32::INFINITY,
            1.. => (high.min(MOST_TURNS).saturating_sub(now), wanted),
            _ => (now.saturating_sub(low.max(-MOST_TURNS)), -wanted),
        };
        let units = (1_i64 << SUB_BITS) as f32;
        i64_to_f32_fast(way.max(0)) * (1.0 - 5.0 * f32::EPSILON)
            / (i64_to_f32_fast(velocity) / units * self.hz)
    }

    /// The steady motion at `velocity` from a position.
    pub fn steady(&self, axes: &[AxisState; 3], velocity: &[f32; 3]) -> Steady {
        let [x, y, turning] = *velocity;
        Steady {
            point: [0, 1].map(|i| i64_to_f32_fast(axes[i].rounded()) * PER_POSITION_UNIT),
            theta: axes[2].rounded(),
            velocity: [x, y],
            turning,
            centre: self.centre(),
        }
    }

    fn centre(&self) -> [f32; 2] {
        self.ground.rotation_centre.map(|radii| radii as f32)
    }
}

impl State {
    pub fn new(axes: &[AxisState; 3], setting: &Setting) -> Self {
        let acceleration = per_second(&axes.map(|axis| axis.acceleration), setting.hz);
        let point = [0, 1].map(|i| i64_to_f32_fast(axes[i].rounded()) * PER_POSITION_UNIT);
        let (sin, cos) = Fixed::sin_cos(Angle::from_units(axes[2].rounded()));
        let (sin, cos) = (sin.to_f32(), cos.to_f32());
        let [a, b] = setting.centre();
        Self {
            platform: [
                point[0] - (a * cos - b * sin),
                point[1] - (a * sin + b * cos),
            ],
            velocity: per_second(&axes.map(|axis| axis.velocity), setting.hz),
            acceleration: acceleration.map(|rate| rate * setting.hz),
        }
    }
}
