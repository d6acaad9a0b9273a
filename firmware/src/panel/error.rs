//! GCS error numbers: those this controller can set.

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
    /// Stopped by command.
    Stopped = 10,
    /// No such axis.
    InvalidAxis = 15,
    /// A parameter is out of range.
    OutOfRange = 17,
    /// An axis is named twice.
    AxisTwice = 22,
    /// Too few or too many parameters.
    ParameterCount = 24,
    /// Not a number, or not a finite one.
    InvalidNumber = 25,
    /// A soft limit is out of the travel, crosses the other one, or leaves out where the stage is.
    SoftLimit = 27,
    /// An encoder does not answer, or the pivots are no pose.
    ReferencingFailed = 45,
    /// Not while something moves.
    InMotion = 53,
    /// No such parameter.
    UnknownParameter = 54,
    /// The parameter can only be read.
    ReadOnly = 64,
    /// A pivot was too far from its setpoint; the motors are off.
    FollowingError = 504,
    /// The command can not be taken now; nothing of it was done.
    Busy = 1005,
    /// A fault is latched, the motors are off.
    MotionError = 1024,
}

impl ErrorCode {
    /// The number that `ERR?` answers.
    pub const fn number(self) -> u16 {
        self as u16
    }
}
