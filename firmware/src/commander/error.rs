//! Why a request was refused, or came to nothing later.

use super::axis::Axis;
use super::frames::FrameError;
use super::wave::WaveError;
use crate::control::servo::BorneLimits;
use crate::motion::Refusal;
use core::fmt;

/// Why a request was refused, and then nothing of it was done; or what became of one that had been accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CommandError {
    /// A command is on its way to the tick, or the queue to it is full: the same request may do later.
    Busy,
    /// The stage is not referenced, or its servo is off.
    NotReady,
    /// Not with the servo on.
    ServoOn,
    /// The tick has refused an excitation: an encoder does not answer.
    ExcitationRefused,
    /// Nobody has said yet how this machine is set up, so nothing may drive.
    NotCommissioned,
    /// A debugger is attached, which can halt the loop while the motors drive.
    Debugged,
    /// The emergency stop has not been pressed since the start, and a parameter wants that.
    StopUntested,
    /// A fault is latched, which has to be acknowledged first.
    Faulted,
    /// The stage moves, or is about to.
    InMotion,
    /// Targets are being streamed.
    Streaming,
    /// Wave generators run.
    GeneratorsRunning,
    /// A stream begins at rest only.
    StreamNotAtRest,
    /// An encoder does not answer, or the pivots are no pose.
    ReferencingFailed,
    /// The measured pose (mm, mm, deg) is none that the stage can take.
    ReferenceOutside([f64; 3]),
    /// There is nothing to recover: the measured pose is one that the stage can take, or the servo is on.
    NothingToRecover,
    /// The axis can not move: its coordinate is 0 and stays 0.
    FrozenAxis(Axis),
    /// No position: not finite, or an angle beyond the travel.
    OutsideTravel,
    /// A soft limit lies before the target.
    OutsideSoftLimits,
    /// A velocity is over its limit, or too slow for a move to have a duration that can be counted.
    VelocityOutOfRange {
        /// Of which axis; `None`: of the whole.
        axis: Option<Axis>,
    },
    /// A time between streamed targets, or ticks of a wave table's point, for which there are no plans.
    PeriodOutOfRange,
    /// Soft limits beyond the travel, that cross, or that leave out where the stage is.
    SoftLimitsInvalid,
    /// No motion can be made in that direction from where the stage is.
    NoMotion,
    /// The planner refuses.
    Refused(Refusal),
    /// Another track radius while a point beside the platform's centre is moved: the tick knows that point in track
    /// radii.
    RadiusWithToolFrame,
    /// Streamed targets did not come in time: the stage has stopped.
    StreamDry,
    /// Streamed targets come faster than their cycle time: this one was not taken.
    StreamFull,
    /// Parameters that had been accepted were refused by the tick.
    ConfigurationRefused,
    /// The pivots' limits, or the duration of a fault's stop, ask more of the drives than they bear with what they move: the nearest that
    /// they bear.
    LimitsNotBorne(BorneLimits),
    /// The corrected kinematics do not hold for this calibration.
    CalibrationBeyondLimits,
    /// About frames and the centre of rotation.
    Frame(FrameError),
    /// About waveforms.
    Wave(WaveError),
}

impl From<Refusal> for CommandError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl From<FrameError> for CommandError {
    fn from(error: FrameError) -> Self {
        Self::Frame(error)
    }
}

impl From<WaveError> for CommandError {
    fn from(error: WaveError) -> Self {
        Self::Wave(error)
    }
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FrozenAxis(axis) => write!(f, "axis {} can not move", axis.letter()),
            Self::VelocityOutOfRange { axis: Some(axis) } => {
                write!(f, "the velocity of axis {} is out of range", axis.letter())
            }
            Self::Refused(refusal) => f.write_str(refusal_words(refusal)),
            Self::Frame(error) => error.fmt(f),
            Self::Wave(error) => error.fmt(f),
            Self::Busy => f.write_str("a command is on its way"),
            Self::NotReady => f.write_str("not referenced, or the servo is off"),
            Self::ServoOn => f.write_str("not with the servo on"),
            Self::ExcitationRefused => f.write_str("the control loop refuses the excitation"),
            Self::NotCommissioned => f.write_str("not commissioned"),
            Self::Debugged => f.write_str("a debugger is attached"),
            Self::StopUntested => f.write_str("the emergency stop has not been tested"),
            Self::Faulted => f.write_str("a fault is latched"),
            Self::InMotion => f.write_str("in motion"),
            Self::Streaming => f.write_str("targets are being streamed"),
            Self::GeneratorsRunning => f.write_str("wave generators run"),
            Self::StreamNotAtRest => f.write_str("a stream begins at rest"),
            Self::ReferencingFailed => f.write_str("referencing has failed"),
            Self::ReferenceOutside([x, y, w]) => {
                write!(
                    f,
                    "the encoders show X {x:.1} Y {y:.1} W {w:.1}, out of reach"
                )
            }
            Self::NothingToRecover => f.write_str("in reach, or held: nothing to recover"),
            Self::OutsideTravel => f.write_str("outside the travel"),
            Self::OutsideSoftLimits => f.write_str("outside the soft limits"),
            Self::VelocityOutOfRange { axis: None } => f.write_str("the velocity is out of range"),
            Self::PeriodOutOfRange => f.write_str("the period is out of range"),
            Self::SoftLimitsInvalid => f.write_str("no soft limits for this place and travel"),
            Self::NoMotion => f.write_str("no motion can be made in that direction"),
            Self::RadiusWithToolFrame => f.write_str("a tool frame is in force"),
            Self::StreamDry => f.write_str("streamed targets did not come in time"),
            Self::StreamFull => f.write_str("streamed targets come too fast"),
            Self::CalibrationBeyondLimits => {
                f.write_str("a number of the calibration is beyond its limit")
            }
            Self::LimitsNotBorne(_) => f.write_str("limits of motion that the drives do not bear"),
            Self::ConfigurationRefused => f.write_str("the control loop refuses the parameters"),
        }
    }
}

impl core::error::Error for CommandError {}

const fn refusal_words(refusal: &Refusal) -> &'static str {
    match refusal {
        Refusal::OutsideDisk => "the target is outside the usable disk",
        Refusal::LeavesDisk => "the platform centre would leave the usable disk on its way",
        Refusal::OutOfBounds { .. } => "the target is outside the bounds of an axis",
        Refusal::TooManyTurns => "more turns than can be counted",
        Refusal::InvalidLimits => "the limits of speed, acceleration and jerk allow no motion",
        Refusal::Velocity => "the velocity is over the limits of speed",
        Refusal::PivotRate { .. } => "the pivots can not follow this velocity so far out",
        Refusal::Acceleration => "the acceleration asked for is over its limit",
        Refusal::Jerk => "the jerk asked for is far over its limit",
        Refusal::Pivots => "asks more of the pivots than their rate or acceleration allows",
        Refusal::NoRoomToStop => "there would be no room to stop after it",
        Refusal::NoRoom => "no way left in that direction",
    }
}
