//! Rates and accelerations of the pivots from those of the platform.

use crate::guide::Guide;
use crate::inverse::seen_by_guides;
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
#[inline]
pub fn pivot_motion<T: Real>(
    guides: &[Guide<T>; 3],
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> PivotMotion<T> {
    let (twist, acceleration) = in_platform_axes(guides, twist, acceleration);
    pivot_motion_in_platform_axes(guides, &twist, &acceleration)
}

/// A twist and an acceleration of the base frame, seen along the platform's axes.
#[inline]
pub fn in_platform_axes<T: Real>(
    guides: &[Guide<T>; 3],
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> (Twist<T>, Acceleration<T>) {
    // Guide 2 is the platform's y' axis.
    let (cos, sin) = (guides[1].sin, -guides[1].cos);
    let turned = |x: T, y: T| (x * cos + y * sin, y * cos - x * sin);
    let (x, y) = turned(twist.x, twist.y);
    let (x_2, y_2) = turned(acceleration.x, acceleration.y);
    (
        Twist {
            x,
            y,
            theta: twist.theta,
        },
        Acceleration {
            x: x_2,
            y: y_2,
            theta: acceleration.theta,
        },
    )
}

/// [`pivot_motion`] of a twist and an acceleration along the platform's axes, in which the guides' directions are constants.
#[inline]
pub fn pivot_motion_in_platform_axes<T: Real>(
    guides: &[Guide<T>; 3],
    twist: &Twist<T>,
    acceleration: &Acceleration<T>,
) -> PivotMotion<T> {
    let (speeds, along) = seen_by_guides(twist.x, twist.y);
    let (pushes, _) = seen_by_guides(acceleration.x, acceleration.y);
    let seen = MotionSeen {
        speeds,
        along,
        pushes,
        distances: guides.map(|guide| guide.offset),
        turning: [twist.theta, acceleration.theta],
        over_cosines: guides.map(|guide| T::ONE / guide.cosine),
    };
    pivot_motion_seen(guides, &seen)
}

/// The platform's motion as its guides see it.
pub(crate) struct MotionSeen<T> {
    /// The centre's velocity across each guide, and along.
    pub(crate) speeds: [T; 3],
    pub(crate) along: [T; 3],
    /// The centre's acceleration across each guide.
    pub(crate) pushes: [T; 3],
    /// The centre across each guide's direction, from where the guide's ring turns: d_i.
    pub(crate) distances: [T; 3],
    /// theta' and theta''.
    pub(crate) turning: [T; 2],
    /// 1 / c_i.
    pub(crate) over_cosines: [T; 3],
}

/// [`pivot_motion`] of a motion that its guides see.
#[inline]
pub(crate) fn pivot_motion_seen<T: Real>(
    guides: &[Guide<T>; 3],
    seen: &MotionSeen<T>,
) -> PivotMotion<T> {
    let [theta_1, theta_2] = seen.turning;
    let pivot = |i: usize| {
        let guide = &guides[i];
        let over_cosine = seen.over_cosines[i];
        let swing_rate = (seen.speeds[i] - theta_1 * guide.projection) * over_cosine;
        // Twice the Coriolis part, and the centripetal one: theta' (2 along + theta' d).
        let turning = theta_1 * (seen.along[i] + seen.along[i] + theta_1 * seen.distances[i]);
        let offset_acceleration = seen.pushes[i] - theta_2 * guide.projection - turning;
        let swing_acceleration =
            (offset_acceleration + swing_rate * swing_rate * guide.offset) * over_cosine;
        (theta_1 + swing_rate, theta_2 + swing_acceleration)
    };
    let [motion_1, motion_2, motion_3] = [pivot(0), pivot(1), pivot(2)];
    PivotMotion {
        rates: [motion_1.0, motion_2.0, motion_3.0],
        accelerations: [motion_1.1, motion_2.1, motion_3.1],
    }
}

/// The part of (x, y) across the guide, to its left.
fn across<T: Real>(guide: &Guide<T>, x: T, y: T) -> T {
    y * guide.cos - x * guide.sin
}
