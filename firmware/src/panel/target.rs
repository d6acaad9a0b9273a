//! Between mm and deg of the interface and the [`Position`]s of the motion layer.

use super::axis::{Axis, AxisValues};
use super::error::ErrorCode;
use crate::motion::{Position, check_target};
use kinematics::{Angle, Geometry, direct};

/// Coordinates in the order of [`Axis::ALL`], mm and deg.
pub(super) type Coordinates = [f64; 6];

/// The coordinates with those replaced that have a value.
pub(super) fn replaced(coordinates: &Coordinates, values: &AxisValues) -> Coordinates {
    core::array::from_fn(|i| values[i].unwrap_or(coordinates[i]))
}

/// Travel of W: 10,000 turns. The motion layer counts much further; this is what a typing error may cost.
const W_TRAVEL_DEG: f64 = 3_600_000.0;

/// 2^32: units of a [`Position`] in a track radius.
const UNITS: f64 = 4_294_967_296.0;

/// How far an axis travels to either side of 0, mm or deg.
pub(super) fn travel(axis: Axis, geometry: &Geometry) -> f64 {
    match axis {
        Axis::X | Axis::Y => geometry.usable_radius() * geometry.radius_mm,
        Axis::W => W_TRAVEL_DEG,
        Axis::Z | Axis::U | Axis::V => 0.0,
    }
}

/// The position of a target, once every axis is inside its travel and the centre inside the usable disk.
pub(super) fn position(target: &Coordinates, geometry: &Geometry) -> Result<Position, ErrorCode> {
    let outside = |axis: Axis| target[axis.index()].abs() > travel(axis, geometry);
    if Axis::ALL.into_iter().any(outside) {
        return Err(ErrorCode::PositionLimit);
    }
    let [x_mm, y_mm, _, _, _, w_deg] = *target;
    let length = |mm: f64| libm::rint(mm / geometry.radius_mm * UNITS) as i64;
    let theta = Angle::from_degrees(w_deg).ok_or(ErrorCode::PositionLimit)?;
    let position = [length(x_mm), length(y_mm), theta.units()];
    check_target(&position, geometry).map_err(|_| ErrorCode::PositionLimit)?;
    Ok(position)
}

/// The coordinates of a position: those that [`position`] turns into the same one.
pub(super) fn coordinates(position: &Position, geometry: &Geometry) -> Coordinates {
    let mm = |units: i64| units as f64 / UNITS * geometry.radius_mm;
    let deg = Angle::from_units(position[2]).degrees();
    [mm(position[0]), mm(position[1]), 0.0, 0.0, 0.0, deg]
}

/// The pose that the pivots set; `None` when they are no pose of the mechanism.
pub(super) fn measured(pivots: &[Angle; 3], geometry: &Geometry) -> Option<Coordinates> {
    // Whole turns go around the floating point: they would cost it digits.
    let turns = pivots[0].turns();
    let whole = Angle::from_units(i64::from(turns) << 32);
    let pose = direct::<f64>(&pivots.map(|pivot| (pivot - whole).radians())).ok()?;
    let mm = |radii: f64| radii * geometry.radius_mm;
    let deg = pose.theta.to_degrees() + f64::from(turns) * 360.0;
    Some([mm(pose.x), mm(pose.y), 0.0, 0.0, 0.0, deg])
}
