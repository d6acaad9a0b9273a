//! Rates and accelerations of a built machine's encoders from those of the platform, and back.
//!
//! Runout and straightness enter by the pivot's travel along its ring, not by the guide's tilt: that is some 1e-4.

use crate::corrected_inverse::CorrectedInverse;
use crate::corrected_scalar::CorrectedScalar;
use crate::inverse::seen_by_guides;
use crate::line::Line;
use crate::pose::{Acceleration, Twist};
use crate::rates::{MotionSeen, PivotMotion, pivot_motion_seen};
use crate::scalar::{Real, Scalar};

/// Rates (rad/s) and accelerations (rad/s^2) of the encoders in a pose, from a twist and an acceleration along the
/// platform's axes. With zero corrections it has the values of
/// [`pivot_motion_in_platform_axes`](crate::pivot_motion_in_platform_axes).
#[inline]
pub fn corrected_pivot_motion<T: CorrectedScalar>(
    at: &CorrectedInverse<T>,
    lines: &[Line<T>; 3],
    twist: &Twist<T::Correction>,
    acceleration: &Acceleration<T::Correction>,
) -> PivotMotion<T::Correction> {
    let [speeds, pushes] = [(twist.x, twist.y), (acceleration.x, acceleration.y)].map(|(x, y)| {
        let (across, along) = seen_by_guides(x, y);
        [0, 1, 2].map(|i| lines[i].guide_for_rates.turned([across[i], along[i]]))
    });
    let seen = MotionSeen {
        speeds: speeds.map(|[across, _]| across),
        along: speeds.map(|[_, along]| along),
        pushes: pushes.map(|[across, _]| across),
        // The platform turns about its own centre: a guide's offset has no centripetal part.
        distances: [0, 1, 2].map(|i| at.guides[i].offset - lines[i].guide_for_rates.offset),
        turning: [twist.theta, acceleration.theta],
        over_cosines: at.over_travel,
    };
    let motion = pivot_motion_seen(&at.guides, &seen);
    let stretched =
        |of: [T::Correction; 3]| [0, 1, 2].map(|i| of[i] + of[i] * at.encoder_slopes[i]);
    PivotMotion {
        rates: stretched(motion.rates),
        accelerations: stretched(motion.accelerations),
    }
}

/// The platform's velocity in the base frame from the encoders' `rates` in rad/s, in a pose. Guides may point anywhere:
/// Cramer's rule on `-sin t_i x' + cos t_i y' + rho_i theta' = R c_i psi_i'`, where
/// [`direct_rates`](crate::direct_rates) needs them 120 deg apart.
#[inline]
pub fn corrected_direct_rates<T: CorrectedScalar>(
    at: &CorrectedInverse<T>,
    lines: &[Line<T>; 3],
    rates: &[T::Correction; 3],
) -> Twist<T::Correction> {
    let [row_1, row_2, row_3] = [0, 1, 2].map(|i| {
        let guide = &at.guides[i];
        let [cos, sin] = lines[i].guide_for_rates.turned([guide.cos, guide.sin]);
        [-sin, cos, guide.rho()]
    });
    let columns = [
        cross(row_2, row_3),
        cross(row_3, row_1),
        cross(row_1, row_2),
    ];
    let determinant = dot(row_1, columns[0]);
    let speeds = [0, 1, 2].map(|i| {
        let per_speed = at.over_travel[i] * (T::Correction::ONE + at.encoder_slopes[i]);
        rates[i] / (per_speed * determinant)
    });
    let [x, y, theta] = [0, 1, 2].map(|k| dot(speeds, columns.map(|column| column[k])));
    Twist { x, y, theta }
}

fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
