//! Inverse position: the pivots that hold the platform in a pose.

use core::fmt;

use crate::guide::Guide;
use crate::pose::Pose;
use crate::scalar::{Real, Scalar};

/// The pivots of a pose, and the guides on the way to them.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Inverse<T: Scalar> {
    /// phi_1 to phi_3 on the track, multi-turn: phi_i - theta_i lies within +-90 deg.
    pub pivots: [T::Angle; 3],
    /// Guides 1 to 3.
    pub guides: [Guide<T>; 3],
}

/// Why a pose has no pivots.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum InverseError {
    /// A coordinate is NaN or infinite.
    NotFinite,
    /// The centre lies on or outside the track, where a guide may miss it.
    OutsideTrack,
}

impl fmt::Display for InverseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "the pose is not finite",
            Self::OutsideTrack => "the centre lies on or outside the track",
        })
    }
}

impl core::error::Error for InverseError {}

/// The pivots and guides of `pose`, with `phi_i = theta_i + asin(d_i)`.
///
/// The other root, `180 deg + theta_i - asin(d_i)`, has `rho_i < 0` and is never feasible.
///
/// # Errors
/// [`InverseError`] for a pose that is not finite or whose centre is not inside the track.
pub fn inverse<T: Scalar>(pose: &Pose<T>) -> Result<Inverse<T>, InverseError> {
    let [at_1, at_2, at_3] = meet_track(pose)?;
    let [angle_1, angle_2, angle_3] = guide_angles::<T>();
    // The small angles are summed first: theta may be many turns, and a float rounds by its size.
    Ok(Inverse {
        pivots: [
            pose.theta + (at_1.swing + angle_1),
            pose.theta + (at_2.swing + angle_2),
            pose.theta + (at_3.swing + angle_3),
        ],
        guides: [at_1.guide, at_2.guide, at_3.guide],
    })
}

/// Where a guide meets the track.
pub(crate) struct Meeting<T: Scalar> {
    /// phi_i - theta_i: the pivot's angle from the guide's direction.
    pub(crate) swing: T::Angle,
    pub(crate) guide: Guide<T>,
}

/// Where the guides of a pose meet the track.
#[inline]
pub(crate) fn meet_track<T: Scalar>(pose: &Pose<T>) -> Result<[Meeting<T>; 3], InverseError> {
    let seen = see_guides(pose)?;
    // A centre inside the track by less than a rounding can still give an offset of one.
    let swings =
        T::asin_cos(seen.each_ref().map(|guide| guide.offset)).ok_or(InverseError::OutsideTrack)?;
    Ok([0, 1, 2].map(|i| {
        let (seen, (swing, cosine)) = (&seen[i], swings[i]);
        let (cos, sin) = seen.direction;
        let guide = Guide {
            cos,
            sin,
            offset: seen.offset,
            cosine,
            projection: seen.projection,
        };
        Meeting { swing, guide }
    }))
}

/// A drawn guide's line.
pub(crate) struct GuideSeen<T> {
    /// Cosine and sine of its direction.
    pub(crate) direction: (T, T),
    /// d_i.
    pub(crate) offset: T,
    /// q_i.
    pub(crate) projection: T,
}

/// The drawn guides of a pose inside the track, as the track's centre sees them.
#[inline(always)]
pub(crate) fn see_guides<T: Scalar>(pose: &Pose<T>) -> Result<[GuideSeen<T>; 3], InverseError> {
    if !(pose.x.is_finite() && pose.y.is_finite() && T::angle_is_finite(pose.theta)) {
        return Err(InverseError::NotFinite);
    }
    if !inside_track(pose.x, pose.y) {
        return Err(InverseError::OutsideTrack);
    }
    let (sin, cos) = T::sin_cos(pose.theta);
    // The centre in the platform's own axes, in which the guides always point the same way.
    let x = T::sum_of_products((pose.x, cos), (pose.y, sin));
    let y = T::sum_of_products((pose.y, cos), (-pose.x, sin));
    let directions = guide_directions(sin, cos);
    let (offsets, projections) = seen_by_guides(x, y);
    Ok([0, 1, 2].map(|i| GuideSeen {
        direction: directions[i],
        offset: offsets[i],
        projection: projections[i],
    }))
}

/// theta_i - theta: the guides' angles in the platform, -30, 90 and 210 deg.
#[inline]
pub(crate) fn guide_angles<T: Scalar>() -> [T::Angle; 3] {
    let first = T::ANGLE_ZERO - T::ANGLE_30;
    let second = T::ANGLE_120 - T::ANGLE_30;
    [first, second, second + T::ANGLE_120]
}

/// Where the guides of the pose (`x`, `y`, 0) meet the track, without the pivots' angles: those of any pose whose
/// centre is at (`x`, `y`) along the platform's own axes, seen along these. `None` for a centre that is not inside the
/// track. The square root is the caller's: on the chip there is an instruction for it, which this crate does not know.
pub fn guides_along_axes<T: Real>(x: T, y: T, sqrt: impl Fn(T) -> T) -> Option<[Guide<T>; 3]> {
    // NaN is inside of nothing.
    if !inside_track(x, y) {
        return None;
    }
    let (offsets, projections) = seen_by_guides(x, y);
    let directions = guide_directions(T::ZERO, T::ONE);
    Some([0, 1, 2].map(|i| Guide {
        cos: directions[i].0,
        sin: directions[i].1,
        offset: offsets[i],
        cosine: sqrt((T::ONE - offsets[i]) * (T::ONE + offsets[i])),
        projection: projections[i],
    }))
}

/// The parts across (to the left) and along each guide of a vector (`x`, `y`) along the platform's own axes, in which
/// the guides always point the same way: of the centre, d_i and q_i.
#[inline]
pub(crate) fn seen_by_guides<T: Scalar>(x: T, y: T) -> ([T; 3], [T; 3]) {
    let (x_half, y_half) = (x.half(), y.half());
    let (x_wide, y_wide) = (x * T::SIN_60, y * T::SIN_60);
    (
        [x_half + y_wide, -x, x_half - y_wide],
        [x_wide - y_half, y, -(x_wide + y_half)],
    )
}

/// Whether the centre lies strictly inside the track. Each coordinate is compared first, so that the squares stay
/// small.
fn inside_track<T: Scalar>(x: T, y: T) -> bool {
    let within = |coordinate: T| -T::ONE < coordinate && coordinate < T::ONE;
    within(x) && within(y) && T::sum_of_products((x, x), (y, y)) < T::ONE
}

/// (cos, sin) of `theta - 30 deg`, `theta + 90 deg` and `theta + 210 deg`, from the sine and cosine of theta.
#[inline]
fn guide_directions<T: Scalar>(sin: T, cos: T) -> [(T, T); 3] {
    let (sin_half, cos_half) = (sin.half(), cos.half());
    let (sin_wide, cos_wide) = (sin * T::SIN_60, cos * T::SIN_60);
    [
        (cos_wide + sin_half, sin_wide - cos_half),
        (-sin, cos),
        (sin_half - cos_wide, -(sin_wide + cos_half)),
    ]
}
