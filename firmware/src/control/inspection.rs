//! Inspection of one pivot a tick: in which tick which, what an inspection is given, and what is kept until the next.

use crate::control::oscillation::OscillationWatch;
use crate::drivers::bridge::Duty;
use kinematics::Angle;

/// Ticks from one inspection of a pivot to the next.
pub(super) const INSPECTION_PERIOD_TICKS: u32 = 4;
/// Ticks from one look at a pivot's guide to the next, and from one look at its gear to the next: the two take turns.
pub(super) const LOOK_TICKS: u32 = 2 * INSPECTION_PERIOD_TICKS;
/// The slot in which no pivot is inspected: the currents are, and a snapshot is due.
pub(super) const SNAPSHOT_SLOT: usize = 3;
const _: () = assert!(INSPECTION_PERIOD_TICKS as usize == SNAPSHOT_SLOT + 1);

/// What is kept of a pivot from one inspection to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PivotWatch {
    /// Square of the motor's current, ADC counts, smoothed.
    pub mean_square_current: f32,
    /// Ticks at its largest duty.
    pub saturated_ticks: u32,
    /// Ticks in which the motor's current was not what its voltage drives.
    pub unexplained_ticks: u32,
    /// The current's last reading, ADC counts, and what the model of the current (knees) was when it was read for the first time.
    pub current_counts: i16,
    pub model_then: f32,
    /// The feedback's voltage.
    pub oscillation: OscillationWatch,
    /// Duty when the encoder last showed something new.
    pub duty: i16,
    /// Setpoint at the first inspection since then.
    pub setpoint: Option<Angle>,
    /// Ticks since then in which it has been far from that.
    pub driven_ticks: u16,
}

/// The pivot that is inspected in this tick, what belongs to it, and the next one.
pub(super) struct Inspection {
    pub pivot: usize,
    /// The setpoint hardly moves.
    pub slowly: bool,
    pub setpoint: Angle,
    pub angle: Angle,
    pub next: Angle,
    pub duty: Duty,
}
