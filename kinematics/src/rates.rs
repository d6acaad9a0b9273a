//! Rates and accelerations of the pivots from those of the platform.

use crate::guide::Guide;
use crate::pose::{Acceleration, Twist};
use crate::scalar::Real;

/// How the three pivots move.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct PivotMotion<T> {
    /// phi_i', rad/s.
    pub rates: [T; 3],
    /// phi_i'', rad/s^2.
    pub accelerations: [T; 3],
}

/// Pivot rates in rad/s: `phi_i' = (y' cos theta_i - x' sin theta_i + rho_i theta') / c_i`.
pub fn pivot_rates<T: Real>(guides: &[Guide<T>; 3], twist: &Twist<T>) -> [T; 3] {
    guides
        .map(|guide| (across(&guide, twist.x, twist.y) + guide.rho() * twist.theta) / guide.cosine)
}

/// Pivot accelerations in rad/s^2; see [`pivot_motion`].
pub fn pivot_accelerations<T: Real>(
    guides: &[Guide<T>; 3],
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> [T; 3] {
    pivot_motion(guides, twist, acceleration).accelerations
}

/// Pivot rates and accelerations together: they share all but a few products, and one division a guide.
///
/// With `alpha_i = phi_i - theta_i`: `alpha_i' = d_i' / c_i` and `phi_i'' = theta'' + (d_i'' + alpha_i'^2 d_i) / c_i`.
pub fn pivot_motion<T: Real>(
    guides: &[Guide<T>; 3],
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> PivotMotion<T> {
    let [motion_1, motion_2, motion_3] = guides.map(|guide| one_pivot(&guide, twist, acceleration));
    PivotMotion {
        rates: [motion_1.0, motion_2.0, motion_3.0],
        accelerations: [motion_1.1, motion_2.1, motion_3.1],
    }
}

/// Rate and acceleration of one pivot.
fn one_pivot<T: Real>(
    guide: &Guide<T>,
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> (T, T) {
    let over_cosine = T::ONE / guide.cosine;
    let along = twist.x * guide.cos + twist.y * guide.sin;
    let offset_rate = across(guide, twist.x, twist.y) - twist.theta * guide.projection;
    let swing_rate = offset_rate * over_cosine;
    // Twice the Coriolis part, and the centripetal one: theta' (2 along + theta' d).
    let turning = twist.theta * (along + along + twist.theta * guide.offset);
    let offset_acceleration = across(guide, acceleration.x, acceleration.y)
        - acceleration.theta * guide.projection
        - turning;
    let swing_acceleration =
        (offset_acceleration + swing_rate * swing_rate * guide.offset) * over_cosine;
    (
        twist.theta + swing_rate,
        acceleration.theta + swing_acceleration,
    )
}

/// The part of (x, y) across the guide, to its left.
fn across<T: Real>(guide: &Guide<T>, x: T, y: T) -> T {
    y * guide.cos - x * guide.sin
}
