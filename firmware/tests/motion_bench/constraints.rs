//! Random constraints to plan within, and what can be commanded there.

use super::{CONSTRAINTS, LIMITS, UNIT, at_rest};
use firmware::motion::{AxisState, Constraints, Position, RotationCentre};
use proptest::prelude::*;
use std::f64::consts::PI;

/// mm/s and deg/s of x, y and theta.
pub type Velocity = [f64; 3];

/// mm/s and deg/s within the limits; each axis may have none.
pub fn velocities() -> impl Strategy<Value = Velocity> {
    let still = || proptest::bool::weighted(0.3);
    (
        0.0..=1.0_f64,
        -PI..PI,
        -1.0..=1.0_f64,
        still(),
        still(),
        still(),
    )
        .prop_map(|(speed, direction, turning, a, b, c)| {
            let speed = LIMITS.speed_mm_s * speed;
            let part = |still: bool, value: f64| if still { 0.0 } else { value };
            [
                part(a, speed * direction.cos()),
                part(b, speed * direction.sin()),
                part(c, turning * LIMITS.turn_speed_deg_s),
            ]
        })
}

/// Constraints with and without a centre of rotation beside the platform's, with and without bounds, with strong and
/// weak drives.
pub fn any_constraints() -> impl Strategy<Value = Constraints> {
    (
        0.0..0.8_f64,
        -PI..PI,
        any::<bool>(),
        0.5..0.9_f64,
        any::<bool>(),
        0.0..=1.0_f64,
    )
        .prop_map(|(r, d, beside, bound, bounded, strength)| {
            let mut constraints = CONSTRAINTS;
            constraints.limits.pivot_acceleration_rad_s2 *= 0.2 + 0.8 * strength;
            constraints.limits.pivot_rate_rad_s *= 0.4 + 0.6 * strength;
            if beside {
                let centre = RotationCentre::new([r * d.cos(), r * d.sin()]).expect("near");
                constraints.rotation_centre = centre.point();
            }
            if bounded {
                let units = (bound * UNIT) as i64;
                constraints.bounds = [[-units, units], [-units / 2, units], [-units, 3 * units]];
            }
            constraints
        })
}

/// Where the moved point is when the platform is at `platform`, as far as the bounds allow it.
pub fn rest(platform: Position, constraints: &Constraints) -> Option<[AxisState; 3]> {
    let centre = RotationCentre::new(constraints.rotation_centre).expect("near");
    let point = centre.from_platform(&platform);
    let inside = (point.iter().zip(&constraints.bounds)).all(|(at, b)| (b[0]..=b[1]).contains(at));
    inside.then(|| at_rest(point))
}
