//! What is asked of a profile and answered.

/// What an axis is to do, in the units of its limits. In doubles where the last digits of a distance count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Task<T = f64> {
    /// Way to the target, where it is to be at rest.
    pub distance: T,
    /// Velocity now.
    pub velocity: T,
    /// Acceleration now.
    pub acceleration: T,
}

/// Why there is no profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unusable {
    /// A limit is not a finite positive number.
    Limits,
    /// The state or the distance is not finite, or so large that the duration is not.
    Task,
}

/// Segments of a profile, some of no duration.
pub const SEGMENTS: usize = 9;

/// A profile: nine segments of constant jerk, of which the first two only bring a start over a limit below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisProfile<F> {
    /// Durations of the segments.
    pub durations: [F; SEGMENTS],
    /// Their jerks: plus or minus the limit, or zero.
    pub jerks: [F; SEGMENTS],
    /// Whether the brake is only released in part: segment 7 then sets out from another acceleration than zero.
    pub released_in_part: bool,
}
