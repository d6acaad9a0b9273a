//! Something that happened.

use super::board_notice::BoardNotice;
use super::crash::Crash;
use crate::fault::Fault;
use crate::gcs::condition::{DriveQuantity, Knocks};
use core::fmt;

/// What may start a controller. Unasked: the watchdog, the program, the supply, the clock. Asked for: power, the reset pin, `RBT`. The
/// last is none of them.
pub const START_CAUSES: [&str; 8] = [
    "the watchdog: the control loop or the command side stood still",
    "a panic or a processor fault",
    "a dip of the supply",
    "a failure of the crystal",
    "power on",
    "the reset pin",
    "the command RBT",
    "a reset of another kind",
];

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gcs) enum Event {
    /// The controller started; by what, if that is worth telling.
    Start(Option<&'static str>),
    /// How the program had ended before it.
    Crashed(Crash),
    /// What the board found at its start.
    BoardNotice(BoardNotice),
    Fault(Fault),
    Acknowledged,
    Referenced,
    ReferenceLost,
    ServoOn,
    ServoOff,
    /// A parameter was set.
    ParameterSet(u32, f64),
    /// `STP` or `#24`.
    Stop,
    /// `HLT`
    Halt,
    /// The tick has refused commands: how many.
    Refused(u32),
    /// No host was heard for so many milliseconds.
    HostSilent(f64),
    /// The encoder of a pivot, counted from 0, has begun to warn, or has stopped.
    Warning(u8, bool),
    /// So many bad frames of an encoder have been bridged since it was told last; pivot from 0.
    FramesBridged(u8, u16),
    /// The reading of an encoder has stepped by so much, rad, as no pivot does; pivot from 0.
    EncoderStepped(u8, f32),
    /// Something of the drive of a pivot, counted from 0, is no more what the parameters say, or is again; and what it is now.
    Drive(u8, DriveQuantity, bool, f32),
    /// Something knocks at a pivot.
    Knocks(Knocks),
    /// Settings were written to flash.
    Stored,
    /// They could not be: the error's number.
    StoreFailed(u16),
    /// `RPA`
    Recalled,
    /// `SVO 1` came before the reference, which is what switches the servo on.
    ServoBeforeReference,
    /// So many thresholds of supervision are looser than the reference.
    SupervisionLoosened(u16),
    /// `FRF` or `SVO` found a pose that the stage can not take: mm, mm, deg.
    PoseOutside([f32; 3]),
    /// `RCV`: the stage was found there (mm, mm, deg) and is being driven back.
    Recovery([f32; 3]),
    /// It is in reach again, and held.
    Recovered,
    /// It was given up on the way, or refused; the servo is off.
    RecoveryGivenUp,
    /// The machine is so many K warmer than when it was calibrated: more than it holds for, or no more.
    CalibratedTemperature(bool, f32),
    /// A value is stored that this firmware does not allow; it is not in force.
    UnusableParameter(u32, f64),
    /// The drives do not bear the limits of motion that were asked for, or that are kept: the nearest rate and acceleration of a pivot,
    /// and duration of a fault's stop, rad/s, rad/s^2 and s.
    LimitsNotBorne([f32; 3]),
    /// So many parameters are stored that this firmware does not know.
    UnknownParameters(u16),
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(None) => f.write_str("start"),
            Self::Start(Some(cause)) => write!(f, "start by {cause}"),
            Self::BoardNotice(notice) => f.write_str(notice.text()),
            Self::Crashed(crash) => crash.fmt(f),
            Self::Fault(fault) => write!(f, "fault: {fault}"),
            Self::Acknowledged => f.write_str("fault acknowledged"),
            Self::Referenced => f.write_str("referenced"),
            Self::ReferenceLost => f.write_str("reference lost"),
            Self::ServoOn => f.write_str("servo on"),
            Self::ServoOff => f.write_str("servo off"),
            Self::ParameterSet(id, value) => write!(f, "parameter 0x{id:X} set to {value}"),
            Self::Stop => f.write_str("stopped by command"),
            Self::Halt => f.write_str("halted by command"),
            Self::Refused(count) => write!(f, "{count} commands refused by the loop"),
            Self::Warning(pivot, true) => write!(f, "encoder warns, pivot {}", pivot + 1),
            Self::Warning(pivot, false) => write!(f, "encoder warns no more, pivot {}", pivot + 1),
            Self::FramesBridged(pivot, count) => {
                write!(f, "{count} bad encoder frames bridged, pivot {}", pivot + 1)
            }
            Self::EncoderStepped(pivot, step_rad) => {
                let step_urad = step_rad * 1e6;
                write!(
                    f,
                    "encoder stepped by {step_urad:.1} urad, pivot {}: it slipped, or a blow",
                    pivot + 1
                )
            }
            Self::Drive(pivot, quantity, is_off, value) => {
                match (quantity, is_off) {
                    (DriveQuantity::MotorConstant, true) => {
                        let or = if *value < 1.0 {
                            "a weak motor"
                        } else {
                            "a parameter that is wrong"
                        };
                        write!(
                            f,
                            "motor constant {value:.2} of its parameter: {or}, or the supply's sensor"
                        )
                    }
                    (DriveQuantity::MotorConstant, false) => {
                        f.write_str("motor constant as its parameter says again")
                    }
                    (DriveQuantity::CurrentOffset, true) => {
                        write!(
                            f,
                            "current sensor reads some {value:+.1} A besides what flows"
                        )
                    }
                    (DriveQuantity::CurrentOffset, false) => {
                        f.write_str("current sensor reads what flows again")
                    }
                    (DriveQuantity::Friction, true) => {
                        write!(f, "friction {value:.1} N m over its parameters")
                    }
                    (DriveQuantity::Friction, false) => {
                        f.write_str("friction as its parameters say again")
                    }
                }?;
                write!(f, ", pivot {}", pivot + 1)
            }
            Self::Knocks(Knocks {
                pivot,
                count,
                seconds,
                hardest_rad_s2,
            }) => write!(
                f,
                "{count} knocks in {seconds:.2} s, up to {hardest_rad_s2:.0} rad/s^2, pivot {}: a loose coupling, or something that strikes it",
                pivot + 1
            ),
            Self::HostSilent(ms) => write!(f, "stopped: no host heard for {ms} ms"),
            Self::Stored => f.write_str("settings kept"),
            Self::StoreFailed(number) => {
                write!(f, "settings could not be kept, error {number}")
            }
            Self::Recalled => f.write_str("parameters as they are kept"),
            Self::SupervisionLoosened(0) => f.write_str("supervision as in the reference again"),
            Self::SupervisionLoosened(count) => {
                write!(
                    f,
                    "supervision looser than the reference: {count} thresholds"
                )
            }
            Self::PoseOutside([x, y, w]) => {
                write!(
                    f,
                    "not referenced: the encoders show X {x:.1} Y {y:.1} W {w:.1}, out of reach"
                )
            }
            Self::UnusableParameter(id, value) => {
                write!(
                    f,
                    "kept parameter 0x{id:X} = {value} is out of its range: not in force"
                )
            }
            Self::Recovery([x, y, w]) => {
                write!(f, "recovery from X {x:.1} Y {y:.1} W {w:.1}")
            }
            Self::Recovered => f.write_str("recovered: in reach, held"),
            Self::CalibratedTemperature(true, over_k) => {
                write!(f, "{over_k:.1} K over the temperature of the calibration")
            }
            Self::CalibratedTemperature(false, _) => {
                f.write_str("at the temperature of the calibration again, or without one")
            }
            Self::RecoveryGivenUp => f.write_str("recovery has ended on its way, servo off"),
            Self::ServoBeforeReference => {
                f.write_str("servo asked for before the reference: it stays off until FRF")
            }
            Self::LimitsNotBorne([_, acceleration, _]) if *acceleration <= 0.0 => {
                f.write_str("motors and supply do not move this load")
            }
            Self::LimitsNotBorne([rate, acceleration, stop_s]) => {
                write!(
                    f,
                    "limits over what motors and supply bear with this load; they bear 0x54500106 {rate}, 0x54500107 {acceleration}, 0x5450050F {stop_s}"
                )
            }
            Self::UnknownParameters(count) => {
                write!(f, "{count} kept parameters are unknown here and ignored")
            }
        }
    }
}
