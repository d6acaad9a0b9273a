//! Speed, acceleration and jerk of a setpoint: of translation along the path (mm) and of rotation (deg).

use crate::motion_bench::{AXIS_UNIT, GEOMETRY, LIMITS};
use firmware::motion::AxisState;

/// Of translation, mm, and of rotation, deg; per s, s^2 or s^3.
pub type Pair = [f64; 2];

/// Units of that pair.
pub const UNITS: [[&str; 2]; 3] = [
    ["mm/s", "deg/s"],
    ["mm/s^2", "deg/s^2"],
    ["mm/s^3", "deg/s^3"],
];

pub fn speeds(axes: &[AxisState; 3]) -> Pair {
    pair(axes.map(|axis| axis.velocity), 1)
}

pub fn accelerations(axes: &[AxisState; 3]) -> Pair {
    pair(axes.map(|axis| axis.acceleration), 2)
}

/// That led from one tick to the next.
pub fn jerks(before: &[AxisState; 3], now: &[AxisState; 3]) -> Pair {
    let change = [0, 1, 2].map(|i| now[i].acceleration - before[i].acceleration);
    pair(change, 3)
}

/// Velocity of x and of y, either way, mm/s.
pub fn axis_speeds(axes: &[AxisState; 3]) -> [f64; 2] {
    [0, 1].map(|i| mm(axes[i].velocity).abs() * LIMITS.rate_hz)
}

/// Rates of the axes, per tick to this power, as a pair.
fn pair(rates: [i64; 3], power: i32) -> Pair {
    let [x, y, theta] = rates;
    let per_second = LIMITS.rate_hz.powi(power);
    let turn = theta as f64 / AXIS_UNIT * 360.0;
    [mm(x).hypot(mm(y)) * per_second, turn.abs() * per_second]
}

fn mm(units: i64) -> f64 {
    units as f64 / AXIS_UNIT * GEOMETRY.radius_mm
}
