//! Why a move is refused.

use core::fmt;

/// Why a move is refused. Nothing has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The platform centre would end outside the disk that is usable at every orientation.
    OutsideDisk {
        /// Its distance from the track's centre.
        radius_mm: f64,
        /// Radius of the usable disk.
        usable_mm: f64,
    },
    /// It would leave that disk on its way, because the platform turns about another point.
    LeavesDisk {
        /// How far from the track's centre it would get.
        radius_mm: f64,
        /// Radius of the usable disk.
        usable_mm: f64,
        /// Where: the part of the way that is done by then, 0 to 1.
        fraction: f64,
    },
    /// An axis of the target (0 x, 1 y, 2 theta) lies outside the bounds of the point that is moved.
    OutOfBounds {
        /// Which axis.
        axis: usize,
    },
    /// Theta would pass what [`Position`](super::Position) is meant to hold.
    TooManyTurns,
    /// The limits leave no finite duration.
    InvalidLimits,
    /// A velocity is over the limits of speed.
    Velocity,
    /// The pivots can not follow a velocity as far out as the stage is.
    PivotRate {
        /// How far out they can, at any orientation; nowhere when it is zero.
        radius_mm: f64,
    },
    /// A streamed target asks for more acceleration than its limit.
    Acceleration,
    /// A streamed target asks for a jerk far over its limit.
    Jerk,
    /// A streamed target asks the pivots for more than their rate or acceleration.
    Pivots,
    /// A stop after a streamed target would leave the workspace, or ask too much of the pivots.
    NoRoomToStop,
    /// A jog would meet the edge of the workspace, or a bound, at once.
    NoRoom,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideDisk {
                radius_mm,
                usable_mm,
            } => write!(
                f,
                "target {radius_mm:.6} mm from the centre, the usable disk ends at {usable_mm:.6} mm"
            ),
            Self::LeavesDisk {
                radius_mm,
                usable_mm,
                fraction,
            } => write!(
                f,
                "after {:.1} % of the way the platform centre would be {radius_mm:.3} mm from the track's, the usable disk ends at {usable_mm:.3} mm",
                fraction * 100.0
            ),
            Self::OutOfBounds { axis } => {
                let name = ["x", "y", "theta"].get(*axis).unwrap_or(&"an axis");
                write!(f, "target outside the bounds of {name}")
            }
            Self::TooManyTurns => f.write_str("more turns than can be counted"),
            Self::Velocity => f.write_str("the velocity is over the limits of speed"),
            Self::PivotRate { radius_mm } => write!(
                f,
                "the pivots can follow this velocity up to {radius_mm:.3} mm from the centre only"
            ),
            Self::Acceleration => f.write_str("the acceleration asked for is over its limit"),
            Self::Jerk => f.write_str("the jerk asked for is far over its limit"),
            Self::Pivots => {
                f.write_str("asks more of the pivots than their rate or acceleration allows")
            }
            Self::NoRoomToStop => f.write_str("there would be no room to stop after it"),
            Self::NoRoom => f.write_str("no way left in that direction"),
            Self::InvalidLimits => {
                f.write_str("the limits of speed, acceleration and jerk allow no motion")
            }
        }
    }
}

impl core::error::Error for Refusal {}

/// Why a motion can not be left for another. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RetargetError {
    /// The target can not be moved to at all.
    Refused(Refusal),
    /// It can, but not without a stop before.
    NeedsStop,
}
