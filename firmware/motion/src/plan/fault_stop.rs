//! The controlled stop of a fault: the plan under way is followed slower and slower.
//!
//! The plan's own time runs at a rate that falls from 1 to 0 as `1 - u^2 (3 - 2 u)`, u the part of the stop that is
//! over. So the stop stays on the plan's path and inside the workspace that the plan was made for, from any state of
//! any plan, without planning anything: velocity is the plan's times the rate, acceleration the plan's times its square
//! and the plan's velocity times the rate's change, all continuous. It adds at most `1.5 / duration` times the velocity
//! to the acceleration.

use super::Position;
use super::axis_state::AxisState;
use super::setpoint::{ACCELERATION_CUT, Setpoint, VELOCITY_CUT};

/// 2^-32 turns or track radii in what a velocity and an acceleration are cut to.
const VELOCITY_UNIT: f32 = 1.0 / (1 << (40 - VELOCITY_CUT)) as f32;
const ACCELERATION_UNIT: f32 = 1.0 / (1 << (40 - ACCELERATION_CUT)) as f32;

/// How a motion is slowed down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultStop {
    /// Part of the stop that is a tick.
    step: f32,
    rate_hz: f32,
}

impl FaultStop {
    /// A stop that takes so long.
    pub fn new(duration_s: f64, rate_hz: f64) -> Self {
        Self {
            step: (1.0 / (duration_s * rate_hz)) as f32,
            rate_hz: rate_hz as f32,
        }
    }
}

/// Where in its stop a motion is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TimeScaling {
    /// Part of the stop that is over.
    progress: f32,
    /// Part of the plan's tick that has begun.
    part: f32,
    rate: f32,
    /// Change of the rate, 1/s.
    rate_change: f32,
}

impl TimeScaling {
    /// A stop begins.
    pub fn begun() -> Self {
        Self {
            rate: 1.0,
            ..Self::default()
        }
    }

    /// One tick on: whether a tick of the plan passes in it; `None` when the stop is over.
    pub fn advance(&mut self, fault_stop: &FaultStop) -> Option<bool> {
        let before = self.rate;
        self.progress += fault_stop.step;
        let u = self.progress;
        if u >= 1.0 {
            return None;
        }
        self.rate = 1.0 - u * u * (3.0 - 2.0 * u);
        self.rate_change = -6.0 * u * (1.0 - u) * fault_stop.step * fault_stop.rate_hz;
        self.part += 0.5 * (before + self.rate);
        let passes = self.part >= 1.0;
        if passes {
            self.part -= 1.0;
        }
        Some(passes)
    }

    /// The setpoint now, of the plan's at its last tick, where the axes are.
    pub fn setpoint(&self, plan: &Setpoint, axes: &[AxisState; 3], rate_hz: f32) -> Setpoint {
        let (rate, rate_change) = (self.rate, self.rate_change);
        // Of the plan within its tick.
        let tick = self.part / rate_hz;
        let (twist, acceleration) = (&plan.twist, &plan.acceleration);
        let a = [acceleration.x, acceleration.y, acceleration.theta];
        let v = [twist.x, twist.y, twist.theta];
        let v = each!(i => v[i] + a[i] * tick);
        let square = rate * rate;
        let slowed = each!(i => a[i] * square + v[i] * rate_change);
        Setpoint::new(self.position(axes), each!(i => v[i] * rate), slowed)
    }

    /// The plan's position within its tick.
    pub fn position(&self, axes: &[AxisState; 3]) -> Position {
        axes.map(|axis| {
            let velocity = (axis.velocity >> VELOCITY_CUT) as i32 as f32 * VELOCITY_UNIT;
            let acceleration =
                (axis.acceleration >> ACCELERATION_CUT) as i32 as f32 * ACCELERATION_UNIT;
            let way = self.part * (velocity + 0.5 * self.part * acceleration);
            axis.rounded().wrapping_add(i64::from(way as i32))
        })
    }
}
