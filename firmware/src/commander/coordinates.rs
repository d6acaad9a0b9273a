//! Between mm and deg of the interface and the [`Position`]s of the motion layer, through the frames in force.

use super::axis::{Axis, Coordinates, Travel};
use super::error::CommandError;
use super::frames::{ActiveFrames, Transform};
use crate::calibration::MachineCalibration;
use crate::control::held_position::STEPS_PER_UNIT;
use crate::motion::{Constraints, Position, check_target};
use kinematics::{Angle, Geometry, Pose, corrected_direct, direct};

/// Travel of W: 10,000 turns. The motion layer counts much further; this is what a typing error may cost.
const W_TRAVEL_DEG: f64 = 3_600_000.0;

/// 2^32: units of a [`Position`] in a track radius.
pub(crate) const UNITS_PER_RADIUS: f64 = 4_294_967_296.0;
pub(super) const DEGREES_A_TURN: f64 = 360.0;

/// How far the commanded point gets from the track's centre, at whatever orientation, mm.
pub(crate) fn max_distance_mm(active_frames: &ActiveFrames, geometry: &Geometry) -> f64 {
    geometry.usable_radius() * geometry.radius_mm + active_frames.arm_mm()
}

/// What the axes reach, each at some place of the others, as
/// [`ActiveFrames::travel_coordinates`] counts it.
pub(crate) fn travel(active_frames: &ActiveFrames, geometry: &Geometry) -> Travel {
    let [x, y] = active_frames.zero;
    travel_around([-x, -y, 0.0], active_frames, geometry)
}

/// The same as targets.
pub(crate) fn target_travel(active_frames: &ActiveFrames, geometry: &Geometry) -> Travel {
    let at = active_frames.target_of(&Transform::IDENTITY);
    travel_around(
        [
            at[Axis::X.index()],
            at[Axis::Y.index()],
            at[Axis::W.index()],
        ],
        active_frames,
        geometry,
    )
}

fn travel_around(middle: [f64; 3], active_frames: &ActiveFrames, geometry: &Geometry) -> Travel {
    let far = max_distance_mm(active_frames, geometry);
    Axis::ALL.map(|axis| match axis.component() {
        // Adding 0 turns -0 into 0.
        Some(i) => {
            let reach = if axis == Axis::W { W_TRAVEL_DEG } else { far };
            [middle[i] - reach + 0.0, middle[i] + reach + 0.0]
        }
        None => [0.0; 2],
    })
}

/// The position of a target, if the motion layer can go there: frozen axes at 0, the platform centre inside the usable
/// disk, theta inside the travel of W (but for a target that keeps the theta of `last`, which a jog may have taken
/// further).
pub(crate) fn position(
    target: &Coordinates,
    last: &Coordinates,
    active_frames: &ActiveFrames,
    constraints: &Constraints,
) -> Result<Position, CommandError> {
    let frozen = |axis: Axis| axis.component().is_none() && target[axis.index()] != 0.0;
    let point = active_frames.point_of(target);
    let turned = target[Axis::W.index()] != last[Axis::W.index()];
    let far = turned && point.w_deg.abs() > W_TRAVEL_DEG;
    // Sums of huge numbers may be none.
    let numbers = point.x_mm.is_finite() && point.y_mm.is_finite();
    if let Some(axis) = Axis::ALL.into_iter().find(|&axis| frozen(axis)) {
        return Err(CommandError::FrozenAxis(axis));
    }
    if far || !numbers {
        return Err(CommandError::OutsideTravel);
    }
    let length =
        |mm: f64| libm::rint(mm / constraints.geometry.radius_mm * UNITS_PER_RADIUS) as i64;
    let theta = Angle::from_degrees(point.w_deg).ok_or(CommandError::OutsideTravel)?;
    let position = [length(point.x_mm), length(point.y_mm), theta.units()];
    check_target(&position, constraints)?;
    Ok(position)
}

/// The target at a position: one that [`position`] turns into the same.
pub(crate) fn coordinates(
    position: &Position,
    active_frames: &ActiveFrames,
    geometry: &Geometry,
) -> Coordinates {
    let [x, y, theta] = *position;
    active_frames.target_of(&Transform {
        x_mm: told(x, geometry.radius_mm),
        y_mm: told(y, geometry.radius_mm),
        w_deg: told(theta, DEGREES_A_TURN),
    })
}

/// Units in mm or deg, so many of which are a track radius or a turn: a number of six decimals where one means the same
/// units, as of a position that the servo has taken over.
fn told(units: i64, whole: f64) -> f64 {
    // Not one at the edge of what means the same: frames may cost it its last digit.
    const SURE: f64 = 0.499;
    let exact = units as f64 / UNITS_PER_RADIUS * whole;
    let short = libm::rint(exact * STEPS_PER_UNIT) / STEPS_PER_UNIT;
    let off = short / whole * UNITS_PER_RADIUS - units as f64;
    if off.abs() < SURE { short } else { exact }
}

/// The target at the pose that the pivots set; `None` when they are no pose of the mechanism.
pub(crate) fn measured(
    pivots: &[Angle; 3],
    active_frames: &ActiveFrames,
    geometry: &Geometry,
    built: Option<&MachineCalibration>,
) -> Option<Coordinates> {
    // Whole turns go around the floating point: they would cost it digits.
    let turns = pivots[0].turns();
    let whole = Angle::from_units(i64::from(turns) << 32);
    let pose = shown_pose(&pivots.map(|pivot| (pivot - whole).radians()), built)?;
    let mm = |radii: f64| radii * geometry.radius_mm;
    Some(active_frames.target_at(&Transform {
        x_mm: mm(pose.x),
        y_mm: mm(pose.y),
        w_deg: pose.theta.to_degrees() + f64::from(turns) * 360.0,
    }))
}

/// Of Newton's method, in double precision: 1e-11 rad are left.
const NEWTON_STEPS: u32 = 3;

/// The pose that encoders show, on a machine as drawn or on this one.
pub(super) fn shown_pose(
    encoders_rad: &[f64; 3],
    built: Option<&MachineCalibration>,
) -> Option<Pose<f64>> {
    match built {
        None => direct(encoders_rad).ok(),
        Some(built) => built_pose(encoders_rad, built),
    }
}

// In a frame of its own: the exact numbers of a machine are long, and callers plan.
#[inline(never)]
fn built_pose(encoders_rad: &[f64; 3], built: &MachineCalibration) -> Option<Pose<f64>> {
    corrected_direct(encoders_rad, &built.built()?, NEWTON_STEPS).ok()
}
