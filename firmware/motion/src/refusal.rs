//! Why a move is refused.

/// Why a move is refused. Nothing has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The platform centre would end outside the disk that is usable at every orientation.
    OutsideDisk,
    /// It would leave that disk on its way, because the platform turns about another point.
    LeavesDisk,
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

/// Why a motion can not be left for another. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RetargetError {
    /// The target can not be moved to at all.
    Refused(Refusal),
    /// It can, but not without a stop before.
    NeedsStop,
}
