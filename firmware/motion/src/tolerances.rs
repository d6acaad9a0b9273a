//! What is granted over a limit, what is kept back from one, and what rounding is worth: every tolerance of planning, with
//! its reason.
//!
//! | where | speed, acceleration, jerk | pivots | workspace |
//! |---|---|---|---|
//! | a plan in the check | [`PLAN_SLACK`] | [`PLAN_SLACK`] | [`WORKSPACE_RADII`] |
//! | a state that is left | [`STATE_SLACK`] | | |
//! | delays that are tried before it | [`OVERLAP`] | | |
//! | a streamed target | [`STREAM_SLACK`], [`JERK_TOLERANCE`] | [`STREAM_SLACK`] | [`WORKSPACE_RADII`] |
//! | a line from rest | [`ROUNDING_MARGIN`] kept back | [`PIVOT_MARGIN`] kept back | [`LINE_SQUARED_RADII`] |
//! | a stop | | [`PIVOT_PART_FOR_BRAKING`] | [`WORKSPACE_RADII`] |
//! | a jog | | | [`JOG_RADII`], [`JOG_WAY`] |
//! | a target | | | [`TARGET_RADII`], [`TARGET_RADII_OFF_CENTRE`] |

/// A plan in the check: the roundings of single precision from one piece to the next.
pub const PLAN_SLACK: f32 = 1.0 + 1e-4;

/// A state out of which a new motion begins: as much again, since it may come of a plan that had all of the first.
pub const STATE_SLACK: f32 = 1.0 + 2e-4;

/// 2^-32 track radii or turns by which the pieces of a new target's motion may miss it, for its nudge to make up: what floats leave
/// of a way of four, 0.1 um on the reference stage.
pub const TARGET_UNITS: u64 = 1 << 12;

/// Slopes of a line's squared speed that differ by less than this part of the steepest are the same but for roundings.
pub const SAME_SLOPE: f32 = 1e-5;

/// Delays of an overlap, before the check: half of what that grants.
pub const OVERLAP: f32 = 1.0 + 5e-5;

/// By how much slower a line is made that asks the pivots for too much: over what was seen of it, in samples.
pub const SLOWER_FOR_PIVOTS: f32 = 1.01;

/// Streamed targets: the roundings of single precision, and of what a sender has computed to the limit itself.
pub const STREAM_SLACK: f32 = 1.0 + 1e-3;

/// By how much the jerk that targets ask for may be over its limit: samples that follow a smooth path to a few units have
/// that much at their knots.
pub const JERK_TOLERANCE: f32 = 10.0;

/// Acceleration and jerk of a velocity profile, when its times have been rounded to whole ticks: the roundings of a few
/// operations in single precision.
pub const ROUNDED_TIMES: f32 = 1.0 + 5e-7;

/// Ticks by which a time may be over a whole number of them and is not rounded up: its roundings in single precision.
pub const WHOLE_TICKS: f32 = 1e-3;

/// The same of a duration of any length, as a part of it.
pub const WHOLE_DURATION: f32 = 1.0 - 8e-7;

/// By how much more a line is slowed down than what was found too fast asks for: its segments are whole ticks again.
pub const ROUNDING_MARGIN: f32 = 1.001_5;

/// What the pivots are not granted of their limits along a line: demands are looked up between places, where they are
/// curved. A part for everything, and one for the square of what an interval turns and moves (rad and track radii).
pub const PIVOT_MARGIN: f32 = 0.002;
/// The second of the two.
pub const PIVOT_MARGIN_PER_SQUARE: f32 = 0.1;

/// The part of the pivots' acceleration that a brake is made for: in the brake's middle it asks for a little more than
/// at its start, where it is looked at first.
pub const PIVOT_PART_FOR_BRAKING: f32 = 0.98;

/// Track radii by which a motion may be outside the disk, or the bounds, by the roundings of single precision over a
/// plan: 0.05 um on the reference stage.
pub const WORKSPACE_RADII: f32 = 5e-7;

/// The square of a distance from the track's centre by which a line about another point may leave the disk: 0.05 um on
/// the reference stage, ten roundings of single precision.
pub const LINE_SQUARED_RADII: f32 = 1e-6;

/// Track radii by which a jog may begin outside of the disk in which it can go on, and end before that disk's edge: 0.2 um
/// on the reference stage, the roundings of a bisection.
pub const JOG_RADII: f32 = 2e-6;

/// What a jog uses of the way to a bound: the roundings of five operations in single precision.
pub const JOG_WAY: f32 = 1.0 - 5.0 * f32::EPSILON;

/// Track radii by which a target may be over the rim itself: its coordinates are rounded to 2^-32.
pub const TARGET_RADII: f64 = 1e-9;
/// The same where the platform centre follows from another point by sines that are good to 2^-29.
pub const TARGET_RADII_OFF_CENTRE: f64 = 1e-8;
