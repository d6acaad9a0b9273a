//! The controlled stop of a fault: the plan under way is followed slower and slower.
//!
//! The plan's own time runs at a rate that falls from 1 to 0 as `1 - u^2 (3 - 2 u)`, u the part of the stop that is
//! over. So the stop stays on the plan's path and inside the workspace that the plan was made for, from any state of
//! any plan, without planning anything: velocity is the plan's times the rate, acceleration the plan's times its square
//! and the plan's velocity times the rate's change, all continuous. It adds at most `1.5 / duration` times the velocity
//! to the acceleration.

use super::follower::PlanFollower;
use super::setpoint::{ACCELERATION_CUT, Setpoint, SetpointScale, VELOCITY_CUT};
use super::time_scaling::{FaultStop, TimeScaling};
use kinematics::{Acceleration, Twist};

/// 2^-32 turns or track radii in what a velocity and an acceleration are cut to.
const VELOCITY_UNIT: f32 = 1.0 / (1 << (40 - VELOCITY_CUT)) as f32;
const ACCELERATION_UNIT: f32 = 1.0 / (1 << (40 - ACCELERATION_CUT)) as f32;

impl PlanFollower {
    /// A stop begins at the setpoint of this tick.
    pub fn begin_fault_stop(&mut self) {
        self.time_scaling = TimeScaling {
            rate: 1.0,
            ..TimeScaling::default()
        };
    }

    /// One tick on, in a stop. Bounded as [`advance`](Self::advance) is, which it calls at most once.
    pub fn advance_fault_stop(&mut self, fault_stop: &FaultStop) {
        if !self.moving {
            return;
        }
        let mut time_scaling = self.time_scaling;
        let before = time_scaling.rate;
        time_scaling.progress += fault_stop.step;
        let u = time_scaling.progress;
        if u >= 1.0 {
            let rest = self.fault_stop_position();
            self.rest_at(rest);
            return;
        }
        time_scaling.rate = 1.0 - u * u * (3.0 - 2.0 * u);
        time_scaling.rate_change = -6.0 * u * (1.0 - u) * fault_stop.step * fault_stop.rate_hz;
        time_scaling.part += 0.5 * (before + time_scaling.rate);
        if time_scaling.part >= 1.0 {
            time_scaling.part -= 1.0;
            self.advance();
        }
        self.time_scaling = time_scaling;
    }

    /// The setpoint now, in a stop.
    pub fn fault_stop_setpoint(&self, scale: &SetpointScale) -> Setpoint {
        if !self.moving {
            return self.setpoint(scale);
        }
        let plan = self.setpoint(scale);
        let TimeScaling {
            part,
            rate,
            rate_change,
            ..
        } = self.time_scaling;
        // Of the plan within its tick.
        let tick = part / scale.rate_hz;
        let (twist, acceleration) = (&plan.twist, &plan.acceleration);
        let x = twist.x + acceleration.x * tick;
        let y = twist.y + acceleration.y * tick;
        let theta = twist.theta + acceleration.theta * tick;
        let square = rate * rate;
        Setpoint {
            position: self.fault_stop_position(),
            twist: Twist {
                x: x * rate,
                y: y * rate,
                theta: theta * rate,
            },
            acceleration: Acceleration {
                x: acceleration.x * square + x * rate_change,
                y: acceleration.y * square + y * rate_change,
                theta: acceleration.theta * square + theta * rate_change,
            },
        }
    }

    /// The plan's position within its tick.
    fn fault_stop_position(&self) -> [i64; 3] {
        let part = self.time_scaling.part;
        self.axes.map(|axis| {
            let velocity = (axis.velocity >> VELOCITY_CUT) as i32 as f32 * VELOCITY_UNIT;
            let acceleration =
                (axis.acceleration >> ACCELERATION_CUT) as i32 as f32 * ACCELERATION_UNIT;
            let way = part * (velocity + 0.5 * part * acceleration);
            axis.rounded().wrapping_add(i64::from(way as i32))
        })
    }
}
