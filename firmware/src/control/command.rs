//! What the command side asks of the tick.

use super::calibrated::CalibrationInForce;
use super::config::Config;
use super::excitation::Excitation;
use super::subdivision::SubdivisionTable;
use crate::motion::{PlanHandle, RotationCentre};

/// What the command side asks of the tick.
#[derive(Clone, Debug, PartialEq)]
// There is no heap to box the larger ones in.
#[allow(clippy::large_enum_variant)]
pub enum Command {
    /// Take theta and the pivots' turns from the absolute encoders and hold the pose found there.
    Reference,
    /// Hold the measured pose, or switch the drives off (the stage coasts).
    Servo(bool),
    /// Execute a plan. Refused by the tick (and counted) when its start is no longer where the motion is.
    Move(PlanHandle),
    /// Move another point of the platform from now on, and turn about it. Refused unless the stage is at rest, held or
    /// not; the platform does not move.
    Centre(RotationCentre),
    /// Compute with these constants from now on. Refused in motion, and with the servo on where it changes what the
    /// encoders' readings mean; such a change takes the reference.
    Configure(Config),
    /// The machine is as this calibration has it from now on. Refused but with the servo off.
    Calibrate(CalibrationInForce),
    /// Take this from the encoders' readings from now on. Refused but with the servo off. Not among the constants: with the tables
    /// those would be longer than a plan.
    Subdivide([SubdivisionTable; 3]),
    /// Put a known voltage on a motor: alone with the servo off, else besides what the servo asks for.
    Excite(Excitation),
    /// End that.
    EndExcitation,
    /// Acknowledge the latched fault.
    Acknowledge,
}

// Constants are copied in the tick that takes them: none is larger than the controller's own, so none makes a longer tick.
const _: () = assert!(size_of::<CalibrationInForce>() <= size_of::<Config>());
const _: () = assert!(size_of::<[SubdivisionTable; 3]>() <= size_of::<Config>());
const _: () = assert!(size_of::<Excitation>() <= size_of::<Config>());
