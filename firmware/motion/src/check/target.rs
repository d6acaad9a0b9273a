//! Whether a target can be moved to, from anywhere.

use crate::constraints::Constraints;
use crate::plan::Position;
use crate::plan::units::{PER_POSITION_UNIT, xy_radii};
use crate::refusal::Refusal;
use crate::tolerances::{TARGET_RADII, TARGET_RADII_OFF_CENTRE};
use kinematics::{Angle, Scalar};
use number::Fixed;
use number::float::i64_to_f32_fast;

/// Most turns that a target may have, a thousand million, in units of a position.
pub const MAX_TURNS: i64 = 1_000_000_000 << 32;

/// Whether `target` lies inside the workspace.
pub fn check_target(target: &Position, constraints: &Constraints) -> Result<(), Refusal> {
    if target[2].unsigned_abs() > MAX_TURNS.unsigned_abs() {
        return Err(Refusal::TooManyTurns);
    }
    if !is_well_inside(target, constraints) {
        check_disk(target, constraints)?;
    }
    let inside =
        |i: usize| (constraints.bounds[i][0]..=constraints.bounds[i][1]).contains(&target[i]);
    if let Some(axis) = (0..3).find(|&i| !inside(i)) {
        return Err(Refusal::OutOfBounds { axis });
    }
    Ok(())
}

/// Whether `target` is so far inside the disk that floats tell: as a rule, and at a tenth of what doubles cost.
fn is_well_inside(target: &Position, constraints: &Constraints) -> bool {
    let [x, y] = both!(i => i64_to_f32_fast(target[i]) * PER_POSITION_UNIT);
    let usable = constraints.usable_radius as f32;
    constraints.rotation_centre.map(f64::to_bits) == [0; 2]
        && x * x + y * y < usable * usable * NEARLY
}

/// The square of a radius that is inside in spite of roundings, as a part of that of the disk's.
const NEARLY: f32 = 0.999_99;

#[inline(never)]
fn check_disk(target: &Position, constraints: &Constraints) -> Result<(), Refusal> {
    let [mut x, mut y] = xy_radii(target);
    let mut rim = TARGET_RADII;
    if constraints.rotation_centre != [0.0; 2] {
        let (sin, cos) = Fixed::sin_cos(Angle::from_units(target[2]));
        let (sin, cos) = (sin.to_f64(), cos.to_f64());
        let [p, q] = constraints.rotation_centre;
        x -= cos * p - sin * q;
        y -= sin * p + cos * q;
        rim = TARGET_RADII_OFF_CENTRE;
    }
    let most = constraints.usable_radius + rim;
    let square = x * x + y * y;
    if square > most * most {
        return Err(Refusal::OutsideDisk {
            radius_mm: libm::sqrt(square) * constraints.geometry.radius_mm,
            usable_mm: constraints.usable_radius * constraints.geometry.radius_mm,
        });
    }
    Ok(())
}
