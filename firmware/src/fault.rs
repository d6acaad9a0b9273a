//! What can go wrong in the loop, and what is kept of it.

use core::fmt;

/// Kinds of fault. Each takes the motors to the safe state and stays latched until acknowledged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// No answer from an encoder, more frames in a row than are bridged.
    EncoderSilent,
    /// Frames of an encoder that fail the CRC, more in a row than are bridged.
    EncoderCrc,
    /// An encoder reports an error of its own.
    EncoderError,
    /// Frames of an encoder with a good CRC and an impossible step, more in a row than are bridged.
    EncoderJump,
    /// A pivot is further from its setpoint than allowed; value and limit in rad.
    FollowingError,
    /// A bridge pulls its fault pin.
    BridgeFault,
    /// The emergency stop is pressed.
    EmergencyStop,
    /// The supply is under its limit; value and limit in V.
    SupplyLow,
    /// A setpoint left what the mechanism can reach, or is not finite.
    ImpossibleSetpoint,
    /// Kept settings are damaged: the controller has started with its own.
    SettingsDamaged,
    /// Kept settings are of a newer firmware: the controller has started with its own.
    SettingsNewer,
}

/// A latched fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// What.
    pub kind: FaultKind,
    /// The pivot it concerns, 0 to 2, where it concerns one.
    pub pivot: Option<u8>,
    /// The tick it was detected at.
    pub tick: u64,
    /// Measured value, in the unit its kind says; 0 where there is none.
    pub value: f32,
    /// The limit that `value` passed; 0 where there is none.
    pub limit: f32,
}

impl FaultKind {
    /// The kind in words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::EncoderSilent => "encoder does not answer",
            Self::EncoderCrc => "encoder frames fail the CRC",
            Self::EncoderError => "encoder reports an error",
            Self::EncoderJump => "encoder jumps impossibly",
            Self::FollowingError => "following error too large",
            Self::BridgeFault => "bridge reports a fault",
            Self::EmergencyStop => "emergency stop pressed",
            Self::SupplyLow => "supply voltage too low",
            Self::ImpossibleSetpoint => "setpoint out of the mechanism's reach",
            Self::SettingsDamaged => {
                "kept settings are damaged, the controller's own are in force (WPA 100 keeps those)"
            }
            Self::SettingsNewer => {
                "kept settings are of a newer firmware, the controller's own are in force"
            }
        }
    }

    /// Unit of the value and the limit; empty where there are none.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::FollowingError => "rad",
            Self::SupplyLow => "V",
            _ => "",
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.text())?;
        if let Some(pivot) = self.pivot {
            write!(f, ", pivot {}", pivot + 1)?;
        }
        if !self.kind.unit().is_empty() {
            let unit = self.kind.unit();
            write!(
                f,
                ": {:e} {unit}, limit {:e} {unit}",
                self.value, self.limit
            )?;
        }
        write!(f, ", at tick {}", self.tick)
    }
}
