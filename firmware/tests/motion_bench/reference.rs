//! rsruckig: three axes to rest, each within limits of its own, all of one duration.

use super::{AXIS_UNIT, GEOMETRY};
use firmware::motion::{AxisState, Limits, Position};
use rsruckig::prelude::*;

/// Speed, acceleration and jerk of an axis: 2^-72 units and ticks.
pub type AxisMost = [f64; 3];

/// The limits of x, y and theta, those of x and y as a part of the path's.
pub fn per_axis(limits: &Limits, part: f64) -> [AxisMost; 3] {
    let tick = 1.0 / limits.rate_hz;
    let axis = |unit: f64, [v, a, j]: [f64; 3]| {
        [v * tick, a * tick.powi(2), j * tick.powi(3)].map(|limit| limit * unit * AXIS_UNIT)
    };
    let way = axis(
        part / GEOMETRY.radius_mm,
        [
            limits.speed_mm_s,
            limits.acceleration_mm_s2,
            limits.jerk_mm_s3,
        ],
    );
    let turn = axis(
        1.0 / 360.0,
        [
            limits.turn_speed_deg_s,
            limits.turn_acceleration_deg_s2,
            limits.turn_jerk_deg_s3,
        ],
    );
    [way, way, turn]
}

/// Times in thousands of ticks: rsruckig takes what is closer than 1e-8 for the same.
const LONG: f64 = 1_000.0;

/// What rsruckig finds from a state, with times in [`LONG`] ticks and positions from where the state is.
pub struct Reference {
    trajectory: Trajectory<3>,
    start: [AxisState; 3],
}

impl Reference {
    /// `None` where rsruckig finds nothing.
    pub fn new(axes: &[AxisState; 3], to: &Position, limits: &[AxisMost; 3]) -> Option<Self> {
        let mut input = InputParameter::<3>::new(None);
        for (i, axis) in axes.iter().enumerate() {
            let scaled = |value: f64, power: i32| value / AXIS_UNIT * LONG.powi(power);
            let way = (i128::from(to[i]) << 40) - axis.position;
            input.target_position[i] = scaled(way as f64, 0);
            input.current_velocity[i] = scaled(axis.velocity as f64, 1);
            input.current_acceleration[i] = scaled(axis.acceleration as f64, 2);
            let [v, a, j] = limits[i];
            input.max_velocity[i] = scaled(v, 1);
            input.max_acceleration[i] = scaled(a, 2);
            input.max_jerk[i] = scaled(j, 3);
        }
        let mut trajectory = Trajectory::new(None);
        let mut ruckig = Ruckig::<3, ThrowErrorHandler>::new(None, 0.001);
        ruckig.calculate(&input, &mut trajectory).ok()?;
        Some(Self {
            trajectory,
            start: *axes,
        })
    }

    /// Its duration.
    pub fn ticks(&self) -> f64 {
        self.trajectory.get_duration() * LONG
    }

    /// The axes so many ticks after the start, to the nearest integers.
    pub fn state_after(&self, ticks: f64) -> [AxisState; 3] {
        let none = || DataArrayOrVec::Stack([0.0; 3]);
        let [mut way, mut velocity, mut acceleration] = [none(), none(), none()];
        self.trajectory.at_time(
            ticks / LONG,
            &mut Some(&mut way),
            &mut Some(&mut velocity),
            &mut Some(&mut acceleration),
            &mut None,
            &mut None,
        );
        [0, 1, 2].map(|i| AxisState {
            position: self.start[i].position + (way[i] * AXIS_UNIT) as i128,
            velocity: (velocity[i] * AXIS_UNIT / LONG) as i64,
            acceleration: (acceleration[i] * AXIS_UNIT / LONG.powi(2)) as i64,
        })
    }
}
