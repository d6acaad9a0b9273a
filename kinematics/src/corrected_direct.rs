//! Direct position of a built machine: the pose that its encoders' readings mean.
//!
//! The ideal solution, and from there Newton's method on [`corrected_inverse`]: what the encoders would read there
//! against what they do. The same function both ways makes the setpoint of a measured pose the reading.

use crate::corrected_inverse::{CorrectedInverse, corrected_inverse};
use crate::corrected_rates::corrected_direct_rates;
use crate::corrected_scalar::CorrectedScalar;
use crate::corrections::Corrections;
use crate::curves::Curves;
use crate::direct::{DirectError, direct};
use crate::line::Line;
use crate::pose::Pose;

/// The pose in which the encoders read `encoders`, of which the first tells the turn, after `steps` of Newton's method.
/// On a machine of the usual sizes two leave less than 1e-8 track radii and rad, three less than 1e-11. With zero
/// corrections it has the bits of [`direct`].
///
/// # Errors
/// [`DirectError`] for readings that are not finite or that no platform inside the track can make.
pub fn corrected_direct<T: CorrectedScalar, C: Curves<T>>(
    encoders: &[T::Angle; 3],
    corrections: &Corrections<T, C>,
    steps: u32,
) -> Result<Pose<T>, DirectError> {
    let [zero_1, zero_2, zero_3] = corrections.lines.each_ref().map(|line| line.encoder_zero);
    let [encoder_1, encoder_2, encoder_3] = *encoders;
    let mut pose = direct(&[encoder_1 - zero_1, encoder_2 - zero_2, encoder_3 - zero_3])?;
    // A step would change the last bits of a pose that is right.
    if corrections.are_zero() {
        return Ok(pose);
    }
    for _ in 0..steps {
        pose = refine(&pose, encoders, corrections)?;
    }
    Ok(pose)
}

/// One step of Newton's method: `pose` nearer to where the encoders read `encoders`.
///
/// # Errors
/// [`DirectError`] for a pose that is not finite or not inside the track.
pub fn refine<T: CorrectedScalar, C: Curves<T>>(
    pose: &Pose<T>,
    encoders: &[T::Angle; 3],
    corrections: &Corrections<T, C>,
) -> Result<Pose<T>, DirectError> {
    let at = corrected_inverse(pose, corrections)?;
    Ok(newton_step(
        pose,
        &at,
        &corrections.lines,
        &missing_rad(&at, encoders),
    ))
}

/// What encoders read more than in a pose. Readings of single-turn encoders may be whole turns apart.
#[inline(always)]
pub fn missing_rad<T: CorrectedScalar>(
    at: &CorrectedInverse<T>,
    encoders: &[T::Angle; 3],
) -> [T::Correction; 3] {
    [0, 1, 2].map(|i| {
        let there = at.encoders[i];
        T::angle_to_correction(T::near(encoders[i], there) - there)
    })
}

/// The pose in which the encoders read so much more than in this one, to first order.
#[inline(always)]
pub fn newton_step<T: CorrectedScalar>(
    pose: &Pose<T>,
    at: &CorrectedInverse<T>,
    lines: &[Line<T>; 3],
    missing_rad: &[T::Correction; 3],
) -> Pose<T> {
    let step = corrected_direct_rates(at, lines, missing_rad);
    Pose {
        x: pose.x + T::from_correction(step.x),
        y: pose.y + T::from_correction(step.y),
        theta: pose.theta + T::angle_from_correction(step.theta),
    }
}
