//! GCS error numbers: those this controller can set.

use crate::commander::CommandError;
use crate::commander::frames::FrameError;
use crate::commander::wave::WaveError;
use crate::fault::FaultKind;
use crate::motion::Refusal;
use crate::settings_store::StoreError;

/// The error of a connection, read and cleared by `ERR?`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u16)]
pub enum ErrorCode {
    /// No error.
    #[default]
    None = 0,
    /// The line does not follow the command's syntax.
    Syntax = 1,
    /// No such command.
    UnknownCommand = 2,
    /// The line is longer than [`LINE_BYTES`](super::LINE_BYTES).
    LineTooLong = 3,
    /// Not referenced, or the servo is off.
    NotReady = 5,
    /// The target is out of the travel.
    PositionLimit = 7,
    /// The velocity is out of its limits.
    VelocityLimit = 8,
    /// The centre of rotation can not be set: a work or tool frame is in force, whose origin is the centre.
    CentreNotSettable = 9,
    /// Stopped by command.
    Stopped = 10,
    /// No such axis.
    InvalidAxis = 15,
    /// A parameter is out of range.
    OutOfRange = 17,
    /// No name for a macro.
    MacroName = 18,
    /// No such macro.
    MacroNotFound = 20,
    /// An axis is named twice.
    AxisTwice = 22,
    /// Too few or too many parameters.
    ParameterCount = 24,
    /// Not a number, or not a finite one.
    InvalidNumber = 25,
    /// A soft limit is out of the travel, crosses the other one, or leaves out where the stage is.
    SoftLimit = 27,
    /// Not for this stage, or not for a frame that is in use.
    NotForStage = 34,
    /// An encoder does not answer, or the pivots are no pose.
    ReferencingFailed = 45,
    /// Not while something moves.
    InMotion = 53,
    /// No such parameter.
    UnknownParameter = 54,
    /// The password of the command level is wrong or missing.
    Password = 56,
    /// No such table of the recorder.
    NoSuchTable = 57,
    /// No such option of the recorder, or not of this source.
    UnknownOption = 58,
    /// The command level of the connection is too low.
    LevelTooLow = 60,
    /// The parameter can only be read.
    ReadOnly = 64,
    /// So many points have not been recorded.
    NotRecorded = 77,
    /// The table records nothing.
    TableOff = 78,
    /// Not with the servo on, or not outside a macro.
    NotAllowed = 89,
    /// There is no memory left for that waveform.
    WaveTooLarge = 67,
    /// Not while a generator runs: `WGO` ends it.
    GeneratorActive = 73,
    /// A generator has no table, or an empty one.
    NoWave = 75,
    /// Not while the axes that it affects move.
    WhileMoving = 93,
    /// Received bytes were lost or damaged on the way: the lines that they belonged to have been thrown away.
    ReceiveOverflow = 304,
    /// Streamed targets did not come in time: the stage has stopped.
    StreamDry = 220,
    /// Streamed targets came faster than their cycle time: this one was not taken.
    StreamFull = 221,
    /// A pivot was too far from its setpoint; the motors are off.
    FollowingError = 504,
    /// No room for another macro or variable.
    NoMemory = 601,
    /// Macros start macros too deeply.
    TooDeeplyNested = 1000,
    /// No macro is being recorded.
    NotRecording = 1002,
    /// No keyword of `MAC`, or one that a macro can not have.
    MacroParameter = 1003,
    /// The command can not be taken now; nothing of it was done.
    Busy = 1005,
    /// No name for a variable.
    InvalidIdentifier = 1006,
    /// No such variable.
    UnknownVariable = 1007,
    /// Not while a macro runs.
    MacroRunning = 1008,
    /// A fault is latched, the motors are off.
    MotionError = 1024,
    /// The flash does not take the settings that are to be stored.
    FlashFailed = 4001,
    /// Another connection owns the stage (`OWN?` tells which): everybody may look and stop, nobody else may command.
    OwnedByAnother = 4002,
    /// The pose that the encoders show is outside the disk, a guide or the separation of pivots: wiring or zeros are wrong, or the
    /// stage was left there.
    ReferenceOutside = 4003,
    /// There is nothing to recover: the pose that the encoders show is in reach, or the servo is on.
    NothingToRecover = 4004,
    /// Nobody has said yet how this machine is set up (`CMS`): nothing drives.
    NotCommissioned = 4005,
    /// A debugger is attached, which can halt the loop while the motors drive: nothing drives unless a parameter allows it.
    Debugged = 4006,
    /// The emergency stop has not been pressed since the start: nothing drives where a parameter wants that.
    StopUntested = 4007,
    /// A calibration has not come whole: numbers are missing, or its checksum is another.
    CalibrationDamaged = 4008,
    /// A calibration has numbers that no machine has, or that the corrections do not hold for.
    CalibrationBeyondLimits = 4009,
    /// A calibration is that of another machine.
    CalibrationOfAnother = 4010,
    /// The pivots' limits, or the duration of a fault's stop, are more than motors and supply bear with this load; `EVT?` has what they
    /// bear.
    LimitsNotBorne = 4011,
}

impl ErrorCode {
    /// What a fault sets on every connection when it comes.
    pub const fn of(kind: FaultKind) -> Self {
        match kind {
            FaultKind::FollowingError => Self::FollowingError,
            _ => Self::MotionError,
        }
    }

    /// Whether it says that a fault is latched.
    pub(super) const fn is_of_fault(self) -> bool {
        matches!(self, Self::FollowingError | Self::MotionError)
    }

    /// The number that `ERR?` answers.
    pub const fn number(self) -> u16 {
        self as u16
    }
}

/// The error numbers for when the stage does not do what was asked.
impl From<CommandError> for ErrorCode {
    fn from(error: CommandError) -> Self {
        match error {
            CommandError::Busy
            | CommandError::ConfigurationRefused
            | CommandError::ExcitationRefused => Self::Busy,
            CommandError::NotReady => Self::NotReady,
            CommandError::NotCommissioned => Self::NotCommissioned,
            CommandError::Debugged => Self::Debugged,
            CommandError::StopUntested => Self::StopUntested,
            CommandError::CalibrationBeyondLimits => Self::CalibrationBeyondLimits,
            CommandError::LimitsNotBorne(_) => Self::LimitsNotBorne,
            CommandError::Faulted => Self::MotionError,
            CommandError::InMotion => Self::InMotion,
            CommandError::Streaming | CommandError::StreamNotAtRest | CommandError::ServoOn => {
                Self::NotAllowed
            }
            CommandError::GeneratorsRunning => Self::GeneratorActive,
            CommandError::ReferencingFailed => Self::ReferencingFailed,
            CommandError::ReferenceOutside(_) => Self::ReferenceOutside,
            CommandError::NothingToRecover => Self::NothingToRecover,
            CommandError::FrozenAxis(_)
            | CommandError::OutsideTravel
            | CommandError::OutsideSoftLimits
            | CommandError::NoMotion => Self::PositionLimit,
            CommandError::VelocityOutOfRange { .. } => Self::VelocityLimit,
            CommandError::PeriodOutOfRange => Self::OutOfRange,
            CommandError::SoftLimitsInvalid => Self::SoftLimit,
            CommandError::RadiusWithToolFrame => Self::NotForStage,
            CommandError::StreamDry => Self::StreamDry,
            CommandError::StreamFull => Self::StreamFull,
            CommandError::Refused(refusal) => Self::of_refusal(&refusal),
            CommandError::Frame(error) => Self::of_frames(error),
            CommandError::Wave(error) => Self::of_waves(error),
        }
    }
}

impl From<StoreError> for ErrorCode {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::TooLong => Self::NoMemory,
            StoreError::Flash => Self::FlashFailed,
        }
    }
}

impl ErrorCode {
    const fn of_refusal(refusal: &Refusal) -> Self {
        match refusal {
            Refusal::Velocity
            | Refusal::PivotRate { .. }
            | Refusal::InvalidLimits
            | Refusal::Acceleration
            | Refusal::Jerk
            | Refusal::Pivots => Self::VelocityLimit,
            _ => Self::PositionLimit,
        }
    }

    const fn of_frames(error: FrameError) -> Self {
        match error {
            FrameError::InUse(_)
            | FrameError::HasChildren(_)
            | FrameError::KindsDoNotMix
            | FrameError::NotPlanar => Self::NotForStage,
            FrameError::Unknown(_)
            | FrameError::Full
            | FrameError::Circular
            | FrameError::CentreNotPlanar
            | FrameError::TooFar => Self::OutOfRange,
            FrameError::CentreGivenByTool => Self::CentreNotSettable,
            FrameError::OutsideSoftLimits => Self::SoftLimit,
            FrameError::InMotion => Self::WhileMoving,
        }
    }

    const fn of_waves(error: WaveError) -> Self {
        match error {
            WaveError::NoCurve | WaveError::TableTooLong => Self::OutOfRange,
            WaveError::NoMemory => Self::WaveTooLarge,
            WaveError::FrozenAxis(_) => Self::NotForStage,
            WaveError::NoTable(_) => Self::NoWave,
        }
    }
}
