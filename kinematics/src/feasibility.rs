//! Whether the stage can take a pose, and how far the pose is from each limit.

use core::fmt;

use crate::geometry::Geometry;
use crate::inverse::{InverseError, meet_track};
use crate::pose::Pose;
use crate::scalar::Real;

/// How far a pose is from each limit; negative beyond it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Margins<T> {
    /// To the rim of the disk in which every orientation is reached, track radii.
    pub disk: T,
    /// Of the pivot nearest to its guide's start, track radii.
    pub guide_start: T,
    /// Of the pivot nearest to its guide's end, track radii.
    pub guide_end: T,
    /// Of the two pivots nearest to each other, to the smallest separation, rad.
    pub separation_rad: T,
}

/// Why the stage cannot take a pose. Guides and pivots are numbered 1 to 3.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Infeasible {
    /// A coordinate is NaN or infinite.
    NotFinite,
    /// The centre lies on or outside the track: no pivots at all.
    OutsideTrack,
    /// The pivot is too far in on its guide.
    GuideStart {
        /// Which guide.
        guide: usize,
    },
    /// The pivot is too far out on its guide.
    GuideEnd {
        /// Which guide.
        guide: usize,
    },
    /// Two pivots are closer than their carriages allow.
    PivotsTooClose {
        /// The pivot behind.
        first: usize,
        /// The pivot next to it, counter-clockwise.
        second: usize,
    },
    /// Reached in this orientation, but outside the disk in which every orientation is.
    OutsideDisk,
}

impl fmt::Display for Infeasible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => InverseError::NotFinite.fmt(f),
            Self::OutsideTrack => InverseError::OutsideTrack.fmt(f),
            Self::GuideStart { guide } => write!(f, "guide {guide} is at its start"),
            Self::GuideEnd { guide } => write!(f, "guide {guide} is at its end"),
            Self::PivotsTooClose { first, second } => {
                write!(f, "pivots {first} and {second} are too close")
            }
            Self::OutsideDisk => f.write_str("the centre lies outside the usable disk"),
        }
    }
}

impl core::error::Error for Infeasible {}

impl From<InverseError> for Infeasible {
    fn from(error: InverseError) -> Self {
        match error {
            InverseError::NotFinite => Self::NotFinite,
            InverseError::OutsideTrack => Self::OutsideTrack,
        }
    }
}

/// Roundings a limit may be passed by: a pose typed in exactly on the rim is not to be refused at some orientations.
const TOLERANCE_EPSILONS: f64 = 16.0;

/// The margins of a feasible pose.
///
/// # Errors
/// [`Infeasible`] says which limit the pose breaks, the mechanical ones before the disk.
pub fn feasibility<T: Real>(geometry: &Geometry, pose: &Pose<T>) -> Result<Margins<T>, Infeasible> {
    let room = Room::new(geometry, pose)?;
    room.check()?;
    Ok(room.margins())
}

/// The margins of any pose inside the track, feasible or not.
///
/// # Errors
/// [`InverseError`] for a pose that is not finite or whose centre is not inside the track.
pub fn margins<T: Real>(geometry: &Geometry, pose: &Pose<T>) -> Result<Margins<T>, InverseError> {
    Ok(Room::new(geometry, pose)?.margins())
}

/// The room to every single limit.
struct Room<T> {
    disk: T,
    starts: [T; 3],
    ends: [T; 3],
    /// From pivot 1 to 2, 2 to 3 and 3 to 1.
    separations: [T; 3],
}

impl<T: Real> Room<T> {
    fn new(geometry: &Geometry, pose: &Pose<T>) -> Result<Self, InverseError> {
        // From the swings, not the pivots: whole turns of theta would cost digits.
        let [at_1, at_2, at_3] = meet_track(pose)?;
        let guides = [at_1.guide, at_2.guide, at_3.guide];
        let widenings = [
            at_2.swing - at_1.swing,
            at_3.swing - at_2.swing,
            at_1.swing - at_3.swing,
        ];
        let start = T::from_f64(geometry.guide_start);
        let end = T::from_f64(geometry.guide_start + geometry.guide_length);
        let separation = T::from_f64(geometry.separation_rad);
        let radius = (pose.x * pose.x + pose.y * pose.y).sqrt();
        Ok(Self {
            disk: T::from_f64(geometry.usable_radius()) - radius,
            starts: guides.map(|guide| guide.rho() - start),
            ends: guides.map(|guide| end - guide.rho()),
            separations: widenings.map(|widening| T::ANGLE_120 + widening - separation),
        })
    }

    fn check(&self) -> Result<(), Infeasible> {
        if let Some(guide) = first_broken(&self.starts) {
            return Err(Infeasible::GuideStart { guide });
        }
        if let Some(guide) = first_broken(&self.ends) {
            return Err(Infeasible::GuideEnd { guide });
        }
        if let Some(first) = first_broken(&self.separations) {
            let second = first % 3 + 1;
            return Err(Infeasible::PivotsTooClose { first, second });
        }
        if is_broken(self.disk) {
            return Err(Infeasible::OutsideDisk);
        }
        Ok(())
    }

    fn margins(&self) -> Margins<T> {
        Margins {
            disk: self.disk,
            guide_start: smallest(&self.starts),
            guide_end: smallest(&self.ends),
            separation_rad: smallest(&self.separations),
        }
    }
}

fn is_broken<T: Real>(room: T) -> bool {
    room < -(T::from_f64(TOLERANCE_EPSILONS) * T::EPSILON)
}

/// Number, from 1, of the first limit that is broken.
fn first_broken<T: Real>(rooms: &[T; 3]) -> Option<usize> {
    rooms
        .iter()
        .position(|&room| is_broken(room))
        .map(|index| index + 1)
}

fn smallest<T: Real>(&[a, b, c]: &[T; 3]) -> T {
    let smaller = if a < b { a } else { b };
    if smaller < c { smaller } else { c }
}
