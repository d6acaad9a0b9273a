//! What is known of each kind of fault, in words: `FAULTS.md` is made of it.

use super::kind::FaultKind;

/// A kind of fault, for people.
#[derive(Clone, Copy, Debug)]
pub struct FaultDescription {
    /// Which.
    pub kind: FaultKind,
    /// How it is found out, and how soon.
    pub detection: &'static str,
    /// Parameters that set its threshold; empty where there is nothing to set.
    pub thresholds: &'static [u32],
    /// Why the reaction is the one it is.
    pub reason: &'static str,
}

const LOST: &str =
    "the other two pivots and the model of this one carry the motion to rest on its path, gently";
const ENCODER: &[u32] = &[0x5450_0502];

/// All kinds, in the order of their numbers.
pub const FAULT_DESCRIPTIONS: &[FaultDescription] = &[
    FaultDescription {
        kind: FaultKind::EncoderSilent,
        detection: "no frame, or none that is whole, more ticks in a row than are bridged; once referenced, moving or not",
        thresholds: ENCODER,
        reason: LOST,
    },
    FaultDescription {
        kind: FaultKind::EncoderCrc,
        detection: "the frame's check fails, more ticks in a row than are bridged; once referenced",
        thresholds: ENCODER,
        reason: LOST,
    },
    FaultDescription {
        kind: FaultKind::EncoderError,
        detection: "the frame's error bit, more ticks in a row than are bridged; once referenced",
        thresholds: ENCODER,
        reason: LOST,
    },
    FaultDescription {
        kind: FaultKind::EncoderJump,
        detection: "a step that asks for an acceleration no pivot can have, more ticks in a row than are bridged; once referenced",
        thresholds: &[0x5450_0503, 0x5450_0502],
        reason: LOST,
    },
    FaultDescription {
        kind: FaultKind::FollowingError,
        detection: "measured minus setpoint of a pivot over a constant and a part that grows with the setpoint's rate; every tick while driven",
        thresholds: &[0x5450_0500, 0x5450_0504],
        reason: "the servo has lost the pivot: no setpoint will be followed, so none is asked for",
    },
    FaultDescription {
        kind: FaultKind::BridgeFault,
        detection: "a bridge pulls its fault pin in two ticks in a row; every tick while driven, but for the first 2 ms after its sleep pin went high: until a bridge is awake its pin means nothing",
        thresholds: &[],
        reason: "over-current or over-temperature: braking would send the motor's current through the same switches, and the sleep pin is what resets them",
    },
    FaultDescription {
        kind: FaultKind::EmergencyStop,
        detection: "the emergency stop's input; every tick, in every state",
        thresholds: &[],
        reason: "the hardware cuts the pulses, which brakes; braking stops in the shortest way and needs neither encoders nor computation",
    },
    FaultDescription {
        kind: FaultKind::SupplyLow,
        detection: "the supply under its limit in four ticks in a row while driven",
        thresholds: &[0x5450_0501],
        reason: "there may be no power left for a controlled stop; braking takes none, and a bridge that loses its own supply lets go by itself",
    },
    FaultDescription {
        kind: FaultKind::ImpossibleSetpoint,
        detection: "no pivots belong to the setpoint; every tick while driven",
        thresholds: &[],
        reason: "the plan is wrong, and there is no other to stop along",
    },
    FaultDescription {
        kind: FaultKind::EncoderFrozen,
        detection: "the same reading to the last bit: from 0.03 rad/s on, more ticks in a row than are bridged; else for 20 ticks (3 more), if the setpoint has gone further than a threshold meanwhile, or for 20 ticks (3 more) in which the voltage exceeds by more than another what it was when the reading last changed (on the same side of zero or on the other), and then it brakes, since the servo has been misled. Less voltage need not move anything: friction holds what has come to rest. At rest nothing tells a frozen encoder from a quiet one, until something is to move. A pivot that is wedged so hard that not one bit changes is reported as this",
        thresholds: &[0x5450_0502, 0x5450_0506, 0x5450_0507],
        reason: LOST,
    },
    FaultDescription {
        kind: FaultKind::Overspeed,
        detection: "the measured rate of a pivot over a multiple of the largest rate of a pivot; each pivot every fourth tick while driven, but not while a late tick is unforgiven, which makes steps too long. During an excitation with the servo off over a limit of its own, every tick",
        thresholds: &[0x5450_0505, 0x5450_0106, 0x5450_0D02],
        reason: "what lets a pivot run away cannot be trusted to stop it",
    },
    FaultDescription {
        kind: FaultKind::PivotsTooClose,
        detection: "the measured angle between two neighbours under the smallest one less a margin; each pair every fourth tick while driven",
        thresholds: &[0x5450_0203, 0x5450_050E],
        reason: "the carriages are about to touch: the shortest way to rest is the best",
    },
    FaultDescription {
        kind: FaultKind::GuideRange,
        detection: "the setpoint's place on a guide out of the guide's range by more than a margin; each guide every fourth tick while driven",
        thresholds: &[0x5450_0201, 0x5450_0202, 0x5450_050D],
        reason: "the plan is wrong: its path leads on to the guide's end",
    },
    FaultDescription {
        kind: FaultKind::WorkspaceLeft,
        detection: "the setpoint out of the usable disk by more than a margin, and not on its way back into it from where the servo was switched on; every tick while driven",
        thresholds: &[0x5450_050C],
        reason: "the plan is wrong: its path leads on outwards",
    },
    FaultDescription {
        kind: FaultKind::Stalled,
        detection: "a bridge at its largest duty, or a motor at its largest current (0x5450080F), without a pause; each pivot every fourth tick while driven",
        thresholds: &[0x5450_0508],
        reason: "something holds the pivot, or the supply or the motor is too weak for the motion: a stop under control would need the same drive",
    },
    FaultDescription {
        kind: FaultKind::MotorHot,
        detection: "the square of the measured current, smoothed over the winding's time, over that of the current it bears; each motor every fourth tick, unless that takes a command, in every state; cools while latched, and an acknowledgement leaves the heat as it is. Over 8.2 A the current is measured as 8.2 A",
        thresholds: &[0x5450_0509, 0x5450_050A],
        reason: "encoders and drives still work, and a tenth of a second more does not hurt a winding",
    },
    FaultDescription {
        kind: FaultKind::LoopLate,
        detection: "ticks that ended after their deadline or did not come at all, one in 100 ticks forgiven; in every state. What late ticks are worth at the setpoint's rate is allowed to the following error until they are forgiven",
        thresholds: &[0x5450_050B],
        reason: "encoders and drives still work, a late duty is an old one for 25 us",
    },
    FaultDescription {
        kind: FaultKind::NotFinite,
        detection: "a duty that is not a number, where whatever else is none ends up; each drive every tick while driven",
        thresholds: &[],
        reason: "nothing that is computed can be trusted; braking needs no numbers",
    },
    FaultDescription {
        kind: FaultKind::SettingsDamaged,
        detection: "an item kept in flash fails its checks, or no store can be made of the flash; at the start, before anything drives",
        thresholds: &[],
        reason: "nothing has moved yet; the controller's own parameters are in force, which may not be those of this stage",
    },
    FaultDescription {
        kind: FaultKind::SettingsNewer,
        detection: "the store's version is newer than this firmware; at the start, before anything drives",
        thresholds: &[],
        reason: "nothing has moved yet; what is kept would be misread, and stays as it is",
    },
    FaultDescription {
        kind: FaultKind::Oscillation,
        detection: "the voltage that the feedback asks for goes to and fro by more than a swing, or by what 25 encoder counts of change in a tick make of the velocity gain, over and over: at 31 Hz or more while the setpoint is slower than a tenth of a pivot's limits of rate and acceleration, at 100 Hz or more while it moves; each pivot every fourth tick while driven",
        thresholds: &[0x5450_0511],
        reason: "the loop that would lead a stop along the path is the one that oscillates",
    },
    FaultDescription {
        kind: FaultKind::CrystalFailed,
        detection: "the crystal is not ready 0.3 s after it was switched on; at the start, before anything drives. One that stops later cuts the outputs by itself and ends in a restart",
        thresholds: &[],
        reason: "nothing has moved yet; the internal oscillator is 1 % off, and were it to stop nothing would notice: `FLC` does not take the fault away",
    },
    FaultDescription {
        kind: FaultKind::ImageDamaged,
        detection: "the CRC-32 of the image in flash is not the one that `cargo seal` gave it: at the start, before anything drives, and over and over while the chip runs, all of it in 1.1 s where the command side has nothing else to do; or the control loop's code in RAM is not what it was copied from, all of it in 0.15 s. An image that was not sealed has no CRC, which `EVT?` tells",
        thresholds: &[],
        reason: "what a damaged program does nobody knows: nothing is driven by what it computes, and `FLC` does not take the fault away",
    },
    FaultDescription {
        kind: FaultKind::SupplyHigh,
        detection: "the supply over 58 V in four ticks in a row while driven; the brake resistor has been on from 54 V",
        thresholds: &[],
        reason: "what comes back from a motor is what raises it: shorted, the windings keep it to themselves. The bridges bear 60 V, 70 V at the very most",
    },
    FaultDescription {
        kind: FaultKind::BrakeResistorHot,
        detection: "what it takes at the measured supply while it is on (8.2 ohm: 356 W at 54 V) less the 50 W that it can give away, summed up to 500 J; every tick, in every state. It is then switched off until half of that is gone, some 5 s",
        thresholds: &[],
        reason: "a supply of more than 54 V, or a motion that brakes without end: shorted windings give nothing back",
    },
    FaultDescription {
        kind: FaultKind::CurrentUnexplained,
        detection: "a motor's measured current apart from what its voltage should drive, by the servo's model (voltage less back-EMF over the winding's resistance), by more than a threshold and 60 % of that, for 3 ms while driven, its voltage and current not at their limits; or gone by half the threshold, by the model, while its reading has stayed the same to the bit; and by more than the threshold from none for 0.1 s with the servo off, on a commissioned machine. Each motor every fourth tick. At every servo on, before anything is driven, 4 V to and fro for 0.4 ms have to drive two fifths of what they should in each motor, both ways; half the threshold may be missing in any case",
        thresholds: &[0x5450_0513],
        reason: "a lead, a bridge, a winding or the sensor is not as it should be: what is asked of that motor it does not do, and braking asks nothing",
    },
    FaultDescription {
        kind: FaultKind::ExcitationWay,
        detection: "a pivot further than a limit from where it was when an excitation began, or from where its servo has it; each pivot every tick of an excitation with the servo off",
        thresholds: &[0x5450_0D01],
        reason: "the machine is not known yet: what moves further than it should is not understood, and the shortest way to rest is the best",
    },
    FaultDescription {
        kind: FaultKind::SupplyRises,
        detection: "the supply, for 0.3 ms, 0.75 V higher than 1 ms after the brake resistor was switched on (at 54 V), which it still is; every tick, in every state. It takes more than three motors give, so that the supply falls where it works",
        thresholds: &[],
        reason: "resistor or switch is open, or something drives the stage that gives back more than it takes: shorted windings give nothing back: after a stop of its own the bus stays under 58 V. Told again until it has fallen",
    },
    FaultDescription {
        kind: FaultKind::BrakeResistorDead,
        detection: "while the bridges wake up, at every servo on and excitation, and every 2 s while the stage rests under its servo, the brake resistor is switched on twice for 0.4 ms: three times in a row the supply does not drop by 64 mV; where it works, by 0.1 V at least. Not where a supply over 54 V has it on",
        thresholds: &[],
        reason: "open, on for good, or not there, or the supply's converter is stuck: nothing drives what nothing could brake, and nothing moves",
    },
];
