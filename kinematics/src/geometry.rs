//! The stage's proportions, what they leave of the track's disk, and what the disk costs in pivot speed.

use core::f64::consts::PI;
use core::fmt;

use crate::scalar::Scalar;

/// 120 deg: the pivots' spacing with the platform in the middle.
const EVEN_SPACING_RAD: f64 = 2.0 * PI / 3.0;

/// Proportions of a stage. [`Geometry::new`] checks them.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Geometry {
    /// R: radius of the track, mm.
    pub radius_mm: f64,
    /// epsilon: where a guide's usable part starts, track radii from the platform's centre.
    pub guide_start: f64,
    /// L: length of a guide's usable part, track radii.
    pub guide_length: f64,
    /// delta: smallest angle between two pivots on the track that their carriages allow, rad.
    pub separation_rad: f64,
}

/// Which proportion makes no stage.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum GeometryError {
    /// The track's radius is not a positive finite length.
    Radius(f64),
    /// The guide's start is not inside (0, 1) track radii.
    GuideStart(f64),
    /// The guide ends, at this many track radii, before the track as seen from its centre (1), or not at a finite place.
    GuideEnd(f64),
    /// The separation, rad, is not inside [0, 120 deg).
    Separation(f64),
}

impl fmt::Display for GeometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Radius(mm) => write!(f, "track radius {mm} mm: not a positive length"),
            Self::GuideStart(start) => {
                write!(f, "guide start {start} track radii: not between 0 and 1")
            }
            Self::GuideEnd(end) => write!(f, "guide end {end} track radii: not beyond 1"),
            Self::Separation(rad) => {
                write!(f, "pivot separation {rad} rad: not from 0 to below 120 deg")
            }
        }
    }
}

impl core::error::Error for GeometryError {}

impl Geometry {
    /// The reference stage: 100 mm track, guides from 0.2 to 1.8, pivots 20 deg apart at least; a disk of 80 mm.
    pub const REFERENCE: Self = Self {
        radius_mm: 100.0,
        guide_start: 0.2,
        guide_length: 1.6,
        separation_rad: PI / 9.0,
    };

    /// A geometry whose usable disk is not empty.
    ///
    /// # Errors
    /// [`GeometryError`] names the first proportion that is not finite or leaves no disk.
    pub fn new(
        radius_mm: f64,
        guide_start: f64,
        guide_length: f64,
        separation_rad: f64,
    ) -> Result<Self, GeometryError> {
        if !(radius_mm > 0.0 && radius_mm.is_finite()) {
            return Err(GeometryError::Radius(radius_mm));
        }
        if !(guide_start > 0.0 && guide_start < 1.0) {
            return Err(GeometryError::GuideStart(guide_start));
        }
        let guide_end = guide_start + guide_length;
        if !(guide_end > 1.0 && guide_end.is_finite()) {
            return Err(GeometryError::GuideEnd(guide_end));
        }
        if !(0.0..EVEN_SPACING_RAD).contains(&separation_rad) {
            return Err(GeometryError::Separation(separation_rad));
        }
        Ok(Self {
            radius_mm,
            guide_start,
            guide_length,
            separation_rad,
        })
    }

    /// Radius, in track radii, of the disk in which the platform reaches every orientation: the smallest of what the
    /// guides' starts, their ends and the carriages' width leave.
    pub const fn usable_radius(&self) -> f64 {
        let by_start = 1.0 - self.guide_start;
        let by_end = self.guide_start + self.guide_length - 1.0;
        let by_separation = sine((EVEN_SPACING_RAD - self.separation_rad) / 2.0) / f64::SIN_60;
        by_start.min(by_end).min(by_separation)
    }
}

/// Sine of an angle up to 60 deg, to the last bit or two: libm's can not be had in a constant.
const fn sine(angle_rad: f64) -> f64 {
    const TERMS: u32 = 10;
    let square = angle_rad * angle_rad;
    let (mut sum, mut k) = (1.0, TERMS);
    while k > 0 {
        let n = (2 * k * (2 * k + 1)) as f64;
        sum = 1.0 - sum * square / n;
        k -= 1;
    }
    angle_rad * sum
}

/// Closest angle between two pivots, rad, over all orientations with the centre `radius` track radii from the track's
/// centre: `120 deg - 2 asin(radius sqrt(3)/2)`. Zero from the track outwards.
pub fn closest_separation_rad(radius: f64) -> f64 {
    if radius < 1.0 {
        EVEN_SPACING_RAD - 2.0 * libm::asin(radius.max(0.0) * f64::SIN_60)
    } else {
        0.0
    }
}

/// Worst pivot rate in rad/s, over all directions and orientations, per platform speed of one track radius a second,
/// at `radius` track radii: `1 / sqrt(1 - radius^2)`. Infinite from the track outwards.
pub fn worst_rate_per_speed(radius: f64) -> f64 {
    if radius < 1.0 {
        1.0 / libm::sqrt((1.0 - radius) * (1.0 + radius))
    } else {
        f64::INFINITY
    }
}

/// Worst pivot rate over all orientations per rate of the platform's rotation, at `radius` track radii: `1 + radius`.
pub fn worst_rate_per_rotation(radius: f64) -> f64 {
    1.0 + radius
}
