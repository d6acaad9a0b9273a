//! Kinds of fault, and what each does to the motors.

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
    /// A setpoint left what the mechanism can reach: no pivots belong to it.
    ImpossibleSetpoint,
    /// An encoder repeats its reading to the last bit while its pivot is driven.
    EncoderFrozen,
    /// A pivot turns faster than it ever should; value and limit in rad/s.
    Overspeed,
    /// Two neighbouring pivots are closer than their carriages allow; value and limit in rad.
    PivotsTooClose,
    /// A pivot's place on its guide is out of the guide's range; value and limit in track radii.
    GuideRange,
    /// The platform's centre is out of the disk that it may be in; value and limit in track radii.
    WorkspaceLeft,
    /// A bridge has been at its end for too long; value and limit in s.
    Stalled,
    /// A motor has carried too much current for too long; value and limit in A.
    MotorHot,
    /// The loop has been late too often; value and limit are numbers of ticks.
    LoopLate,
    /// What the tick computes is no longer a number.
    NotFinite,
    /// Kept settings are damaged: the controller has started with its own.
    SettingsDamaged,
    /// Kept settings are of a newer firmware: the controller has started with its own.
    SettingsNewer,
    /// A servo oscillates; value and limit are swings of its voltage, V.
    Oscillation,
    /// The crystal did not start: the controller runs on a clock that nothing watches.
    CrystalFailed,
    /// The program in flash does not have its checksum, or the control loop in RAM is not what it was copied from.
    ImageDamaged,
    /// The supply is over what the bridges may have; value and limit in V.
    SupplyHigh,
    /// The brake resistor has taken more than it bears; value and limit in J.
    BrakeResistorHot,
    /// A motor's current is not what its voltage should drive; value (measured less expected) and limit in A.
    CurrentUnexplained,
    /// An excitation has taken a pivot further than it may; value and limit in rad.
    ExcitationWay,
    /// The supply rises on though the brake resistor is switched on; value and limit in V.
    SupplyRises,
    /// Switching the brake resistor does not draw the supply down; value and limit are drops, V.
    BrakeResistorDead,
}

/// What a fault does to the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// The motion under way is brought to rest on its own path, then the bridges brake.
    Stop,
    /// The bridges short the motors' windings.
    Brake,
    /// The sleep pins open the bridges.
    Coast,
}

impl FaultKind {
    /// What is done about it; the reasons stand in [`FAULT_DESCRIPTIONS`](super::FAULT_DESCRIPTIONS).
    pub const fn reaction(self) -> Reaction {
        match self {
            Self::EncoderSilent
            | Self::EncoderCrc
            | Self::EncoderError
            | Self::EncoderJump
            | Self::EncoderFrozen
            | Self::MotorHot
            | Self::LoopLate => Reaction::Stop,
            Self::FollowingError
            | Self::EmergencyStop
            | Self::SupplyLow
            | Self::SupplyHigh
            | Self::BrakeResistorHot
            | Self::SupplyRises
            | Self::BrakeResistorDead
            | Self::ImpossibleSetpoint
            | Self::Overspeed
            | Self::PivotsTooClose
            | Self::GuideRange
            | Self::WorkspaceLeft
            | Self::Stalled
            | Self::Oscillation
            | Self::CurrentUnexplained
            | Self::ExcitationWay
            | Self::NotFinite => Reaction::Brake,
            // Nothing has moved yet at the start; what a damaged program computes is nothing to drive by.
            Self::BridgeFault
            | Self::SettingsDamaged
            | Self::SettingsNewer
            | Self::CrystalFailed
            | Self::ImageDamaged => Reaction::Coast,
        }
    }

    /// Whether no acknowledgement takes it away, only a restart that does not find it again.
    pub const fn lasts_until_restart(self) -> bool {
        matches!(self, Self::CrystalFailed | Self::ImageDamaged)
    }

    /// Whether it is one of an encoder, which can not be used any more.
    pub const fn concerns_encoder(self) -> bool {
        matches!(
            self,
            Self::EncoderSilent
                | Self::EncoderCrc
                | Self::EncoderError
                | Self::EncoderJump
                | Self::EncoderFrozen
        )
    }

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
            Self::SupplyHigh => "supply voltage too high",
            Self::BrakeResistorHot => "brake resistor too hot",
            Self::SupplyRises => "supply rises on though the brake resistor is on",
            Self::BrakeResistorDead => "brake resistor does not answer to its switch",
            Self::CurrentUnexplained => "motor current is not what its voltage drives",
            Self::ExcitationWay => "excitation has moved a pivot too far",
            Self::ImpossibleSetpoint => "setpoint out of the mechanism's reach",
            Self::EncoderFrozen => "encoder repeats one reading",
            Self::Overspeed => "pivot too fast",
            Self::PivotsTooClose => "pivot too close to the next one",
            Self::GuideRange => "pivot out of its guide's range",
            Self::WorkspaceLeft => "platform out of its disk",
            Self::Stalled => "drive at its end for too long",
            Self::MotorHot => "motor too hot",
            Self::LoopLate => "control loop late too often",
            Self::Oscillation => "servo oscillates",
            Self::CrystalFailed => "crystal does not start, only a restart takes this away",
            Self::ImageDamaged => {
                "the program is damaged: restart, and flash it again if that stays"
            }
            Self::NotFinite => "a computed value is not a number",
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
            Self::FollowingError | Self::PivotsTooClose | Self::ExcitationWay => "rad",
            Self::SupplyLow
            | Self::SupplyHigh
            | Self::SupplyRises
            | Self::BrakeResistorDead
            | Self::Oscillation => "V",
            Self::BrakeResistorHot => "J",
            Self::Overspeed => "rad/s",
            Self::GuideRange | Self::WorkspaceLeft => "track radii",
            Self::Stalled => "s",
            Self::MotorHot | Self::CurrentUnexplained => "A",
            Self::LoopLate => "ticks",
            _ => "",
        }
    }
}
