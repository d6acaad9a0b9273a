//! How far the pivots of a built machine stand from where the planners take them to be: these plan for the drawing.

use super::{Calibration, IDEAL};
use crate::number::Fixed;
use core::fmt;
use kinematics::{Angle, CorrectedInverse, Geometry, Pose, Scalar, corrected_inverse};

/// Directions of the centre on the disk's rim, and orientations at each: the guides' ends and the closest pivots are
/// reached there.
const DIRECTIONS: u32 = 32;
const ORIENTATIONS: u32 = 32;
/// What may lie between two of them: a share of what is found, and besides it 2e-5 track radii and 5e-5 rad.
const SHARE_BETWEEN: f32 = 0.1;
const GUIDE_BETWEEN: f32 = 2e-5;
const SEPARATION_BETWEEN: u32 = 34_000;
/// More than 2 mm on a track of 100 mm, and the guides' ends and the carriages may not be where the supervisor takes
/// them to be.
const GUIDE_MOST: f32 = 0.02;
/// The same of the angle between two pivots, 2^-32 turns: 20 mrad.
const SEPARATION_MOST: u32 = 13_671_000;

/// How far pivots may be from where the drawing has them, over the whole disk at every orientation. The supervisor's
/// own margins are widened by it: where the planners may go, nothing is a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CalibrationMargins {
    /// Place on the guide, track radii.
    pub guide: f32,
    /// Angle between two pivots as the encoders show it, 2^-32 turns.
    pub separation: u32,
}

/// The pivots are further off than can be put right. Most often an encoder's zero is not the parameter's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarginsTooLarge;

impl fmt::Display for MarginsTooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("pivots stand more than 2 % of the track radius or 20 mrad from where the drawing has them")
    }
}

impl core::error::Error for MarginsTooLarge {}

impl CalibrationMargins {
    /// As drawn.
    pub const NONE: Self = Self {
        guide: 0.0,
        separation: 0,
    };

    /// Those of a calibration, by trying: some thousand inverse solutions, 50 ms on the chip.
    ///
    /// # Errors
    /// [`MarginsTooLarge`].
    pub fn new(calibration: &Calibration, geometry: &Geometry) -> Result<Self, MarginsTooLarge> {
        let rim = Fixed::from_f64(geometry.usable_radius());
        let mut found = Self::NONE;
        for direction in 0..DIRECTIONS {
            let (sin, cos) = Fixed::sin_cos(angle(direction, DIRECTIONS));
            for orientation in 0..ORIENTATIONS {
                let pose = Pose {
                    x: rim * cos,
                    y: rim * sin,
                    theta: angle(orientation, ORIENTATIONS),
                };
                found = found.max(Self::at(&pose, calibration).ok_or(MarginsTooLarge)?);
            }
        }
        if found == Self::NONE {
            return Ok(found);
        }
        let separation = (found.separation as f32 * (1.0 + SHARE_BETWEEN)) as u32;
        let wide = Self {
            guide: found.guide * (1.0 + SHARE_BETWEEN) + GUIDE_BETWEEN,
            separation: separation.saturating_add(SEPARATION_BETWEEN),
        };
        // What is no number is none.
        (wide.guide <= GUIDE_MOST && wide.separation <= SEPARATION_MOST)
            .then_some(wide)
            .ok_or(MarginsTooLarge)
    }

    /// In one pose.
    fn at(pose: &Pose<Fixed>, calibration: &Calibration) -> Option<Self> {
        let drawn = solved(pose, &IDEAL)?;
        let built = solved(pose, calibration)?;
        let mut worst = Self::NONE;
        for i in 0..3 {
            let next = (i + 1) % 3;
            let place = drawn.guides[i].rho();
            let apart = |angles: &[Angle; 3]| angles[next] - angles[i];
            let closer = apart(&drawn.encoders) - apart(&built.encoders);
            worst = worst.max(Self {
                guide: (built.guides[i].rho() - place).abs(),
                separation: u32::try_from(closer.near(Angle::ZERO).units().max(0)).ok()?,
            });
        }
        Some(worst)
    }

    fn max(self, other: Self) -> Self {
        Self {
            guide: if other.guide > self.guide {
                other.guide
            } else {
                self.guide
            },
            separation: self.separation.max(other.separation),
        }
    }
}

/// Once in the image: it is long. The drawn machine is solved by it too, so that the tick's own inverse is the tick's alone.
#[inline(never)]
fn solved(pose: &Pose<Fixed>, calibration: &Calibration) -> Option<CorrectedInverse<Fixed>> {
    corrected_inverse(pose, calibration).ok()
}

/// One of `count` even steps of a turn.
fn angle(step: u32, count: u32) -> Angle {
    Angle::from_units((1 << 32) / i64::from(count) * i64::from(step))
}
