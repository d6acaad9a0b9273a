//! What can be asked of each axis.

/// A value of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Measured position, mm or deg.
    Position,
    /// Commanded position, mm or deg.
    Target,
    /// 1 when settled.
    OnTarget,
    /// 1 when the servo is on.
    Servo,
    /// 1 when referenced.
    Referenced,
    /// Where the travel begins, mm or deg.
    Lowest,
    /// Where it ends, mm or deg.
    Highest,
    /// The lower soft limit, mm or deg.
    SoftLowest,
    /// The upper soft limit, mm or deg.
    SoftHighest,
    /// Velocity of a jog, mm/s or deg/s.
    Jog,
    /// Velocity that moves keep to, mm/s or deg/s.
    Velocity,
    /// 1 when soft limits count.
    SoftActive,
    /// 0: there are no limit switches.
    LimitSwitch,
    /// 0: there are no reference switches; the encoders are absolute.
    ReferenceSwitch,
    /// 0: there is no hand control.
    HandControl,
}
