//! What is kept of a pivot from one inspection to the next, and what an inspection is given.

use crate::drivers::bridge::Duty;
use kinematics::Angle;

/// Ticks from one look at a pivot to the next.
pub(crate) const INSPECTION_PERIOD_TICKS: u32 = 4;

/// What is kept of a pivot from look to look.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PivotWatch {
    /// Square of the motor's current, ADC counts, smoothed.
    pub mean_square_current: f32,
    /// Ticks at its largest duty.
    pub saturated_ticks: u32,
    /// Duty when the encoder last showed something new.
    pub duty: i16,
    /// Setpoint at the first look since then.
    pub setpoint: Option<Angle>,
    /// Ticks since then in which it has been far from that.
    pub driven_ticks: u16,
}

/// The pivot whose turn it is, what belongs to it, and the next one.
pub(crate) struct Inspection {
    pub pivot: usize,
    pub setpoint: Angle,
    pub angle: Angle,
    pub next: Angle,
    pub duty: Duty,
}
