//! What the tick reports to the command side.

use super::excitation::ExcitationReport;
use super::loop_counters::LoopCounters;
use super::servo::Learnt;
use crate::drivers::bridge::Duty;
use crate::fault::{Fault, FaultKind};
use crate::mode::Mode;
use crate::motion::{Position, RotationCentre};
use kinematics::Angle;

/// Slots of the snapshot queue: one snapshot waiting.
pub const SNAPSHOT_SLOTS: usize = 2;

/// What is known of one pivot's servo at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoReport {
    /// Which pivot, 0 to 2.
    pub pivot: usize,
    /// What it has learnt.
    pub learnt: Learnt,
    /// What its feedback has collected, V.
    pub integral_v: f32,
    /// Its motor's current by the model, over the dead time's knee.
    pub current_knees: f32,
}

/// What is known at a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// The tick, counted from start.
    pub tick: u64,
    /// State of the supervisor.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<Fault>,
    /// The fault that has ended its controlled stop, if one has.
    pub stop_ended_by: Option<Fault>,
    /// Whether theta and the turns are known.
    pub referenced: bool,
    /// Whether all three encoders answer well, and, for those that do not, why (index: pivot).
    pub encoder_faults: [Option<FaultKind>; 3],
    /// Whether an encoder warns.
    pub encoder_warnings: [bool; 3],
    /// Bad frames of each encoder that have been bridged so far, wrapping.
    pub bridged_frames: [u16; 3],
    /// Sums of the steps of each encoder that no pivot makes, 2^-32 turns, wrapping.
    pub slipped: [i32; 3],
    /// Measured pivot angles; valid once referenced.
    pub pivots: [Angle; 3],
    /// Measured minus setpoint of each pivot, 2^-32 turns; 0 while the servo is off.
    pub pivot_errors: [i32; 3],
    /// What the motors' windings have borne: square of the current, ADC counts, smoothed over their heating time.
    pub motor_heat: [f32; 3],
    /// By how much the brake resistor has drawn the supply down when it was last tested, V.
    pub resistor_drop_v: Option<f32>,
    /// Duties.
    pub duty: [Duty; 3],
    /// Setpoint of the point that is moved.
    pub setpoint: Position,
    /// That point.
    pub centre: RotationCentre,
    /// Identity of the plan under way, or of the last one.
    pub plan: u32,
    /// Ticks of it that are done.
    pub plan_tick: u64,
    /// Settled: at rest, and every pivot within the window for the dwell time.
    pub settled: bool,
    /// Commands taken so far, refused ones included.
    pub commands: u32,
    /// Plans refused by the tick so far.
    pub refused: u32,
    /// Largest following error of a pivot since the last start of a motion, rad.
    pub peak_following_error_rad: f32,
    /// The excitation under way, or the last one.
    pub excitation: ExcitationReport,
    /// What the loop has counted since the snapshot before.
    pub loop_counters: LoopCounters,
    /// One servo, another one in each snapshot.
    pub servo: ServoReport,
}
