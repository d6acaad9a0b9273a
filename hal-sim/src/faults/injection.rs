//! What is broken in a run: how the simulated hardware does it, and what the controller has to say about it.

use firmware::fault::FaultKind;

use super::random::Random;
use crate::devices::EncoderFault;
use crate::host::{Host, Wiring};
use crate::plant::{External, Plant};

/// Something that breaks, for good unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Injection {
    /// An encoder's line stays high or low.
    Silent(EncoderFault),
    /// Every frame of an encoder has flipped bits.
    BadCrc,
    /// An encoder raises its error bit.
    ErrorBit,
    /// An encoder repeats its last position.
    Frozen,
    /// An encoder's position jumps and stays off.
    Jump(EncoderFault),
    /// So many bad frames in a row, then good ones: no fault.
    FewBadFrames(u8),
    /// An encoder raises its warning bit: no fault.
    Warning,
    /// A bridge switches itself off and pulls its fault pin.
    BridgeFault,
    /// A wire to a motor breaks.
    DriveLost,
    /// A direction pin sticks as it stands.
    DirectionStuck,
    /// The supply breaks down to this, V.
    SupplySag(f64),
    /// The emergency stop is pressed.
    EmergencyStop,
    /// Something hard gets in a pivot's way, on both sides.
    Jam,
    /// A ring is hit with this torque, N m, more than its motor has, for some milliseconds.
    Knock(f64),
    /// So many ticks do not come, one in five: no fault.
    FewMissedTicks(u8),
    /// One tick in five does not come.
    LateLoop,
    /// The host falls silent, which has promised a heartbeat: no fault, but the motion is stopped and that is told.
    HostSilent,
}

/// All kinds of injection, in the table's order.
pub const NAMES: [&str; 17] = [
    "encoder silent",
    "encoder CRC",
    "encoder error bit",
    "encoder frozen",
    "encoder jump",
    "few bad frames",
    "encoder warning",
    "bridge fault pin",
    "drive lost",
    "direction stuck",
    "supply sag",
    "emergency stop",
    "pivot jammed",
    "pivot knocked",
    "few ticks missed",
    "loop late",
    "host silent",
];

/// When an injection takes effect, as the controller's thresholds have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// In the tick that first sees it.
    AtOnce,
    /// In the tick that sees one bad frame more than are bridged.
    BadFrames,
    /// In the tick that sees a low supply often enough.
    LowSupply,
    /// In the tick that is told of one late tick more than are forgiven.
    LateTicks,
    /// In the tick in which what the encoders show is too far from the setpoint.
    FollowingError,
    /// In the tick in which the setpoint of the pivot has gone further than a reading may stay the same.
    Frozen,
    /// When nothing has been heard for as long as the host has promised.
    Silence,
    /// Never: the controller goes on.
    Never,
}

/// What the controller has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// When the effect begins.
    pub effect: Effect,
    /// Faults that name it rightly.
    pub kinds: &'static [FaultKind],
    /// Whether the fault names the pivot.
    pub names_pivot: bool,
    /// What `EVT?` tells of it where it is no fault.
    pub event: Option<&'static str>,
    /// Ticks after the effect at which the fault is latched, or the event is, at the latest.
    pub within_ticks: u64,
}

/// How long a pivot is hit: 4 ms.
const KNOCK_TICKS: u64 = 80;
/// One of so many ticks does not come.
pub(super) const MISSED_EVERY: u64 = 5;
/// Longest silence that a host has promised, ms, and in ticks.
pub(super) const HEARTBEAT_MS: u64 = 30;
pub(super) const HEARTBEAT_TICKS: u64 = HEARTBEAT_MS * 20;
/// Ticks until the command side, which has its turn every few, has told of something.
const COMMAND_SIDE_TICKS: u64 = 20;
/// Bits of the frame that a bad one may have flipped: position, flags and CRC behind a preamble of ten clocks.
const COVERED: u32 = 34;
const LOWEST: u32 = 18;
/// Reading off by less is bridged like bad frames and then taken for motion.
const SMALLEST_JUMP: f64 = 60_000.0;
const LARGEST_JUMP: f64 = 30_000_000.0;

impl Injection {
    /// One of all, as likely each.
    pub fn random(random: &mut Random, bridged: u8) -> Self {
        match random.below(NAMES.len() as u32) {
            0 if random.below(2) == 0 => Self::Silent(EncoderFault::StuckHigh),
            0 => Self::Silent(EncoderFault::StuckLow),
            1 => Self::BadCrc,
            2 => Self::ErrorBit,
            3 => Self::Frozen,
            4 => Self::Jump(EncoderFault::Jump {
                counts: (random.between(SMALLEST_JUMP, LARGEST_JUMP) * random.sign()) as i32,
            }),
            5 => Self::FewBadFrames(1 + random.below(u32::from(bridged)) as u8),
            6 => Self::Warning,
            7 => Self::BridgeFault,
            8 => Self::DriveLost,
            9 => Self::DirectionStuck,
            10 => Self::SupplySag(random.between(0.0, 35.5)),
            11 => Self::EmergencyStop,
            12 => Self::Jam,
            13 => Self::Knock(random.between(60.0, 120.0) * random.sign()),
            14 => Self::FewMissedTicks(1 + random.below(3) as u8),
            15 => Self::LateLoop,
            _ => Self::HostSilent,
        }
    }

    /// Place in [`NAMES`].
    #[must_use]
    pub const fn index(&self) -> usize {
        match self {
            Self::Silent(_) => 0,
            Self::BadCrc => 1,
            Self::ErrorBit => 2,
            Self::Frozen => 3,
            Self::Jump(_) => 4,
            Self::FewBadFrames(_) => 5,
            Self::Warning => 6,
            Self::BridgeFault => 7,
            Self::DriveLost => 8,
            Self::DirectionStuck => 9,
            Self::SupplySag(_) => 10,
            Self::EmergencyStop => 11,
            Self::Jam => 12,
            Self::Knock(_) => 13,
            Self::FewMissedTicks(_) => 14,
            Self::LateLoop => 15,
            Self::HostSilent => 16,
        }
    }

    /// What the controller has to say.
    #[must_use]
    pub const fn expected(&self) -> Expected {
        use FaultKind as Kind;
        let (effect, kinds, names_pivot): (_, &[FaultKind], _) = match self {
            Self::Silent(_) => (Effect::BadFrames, &[Kind::EncoderSilent], true),
            Self::BadCrc => (Effect::BadFrames, &[Kind::EncoderCrc], true),
            Self::ErrorBit => (Effect::BadFrames, &[Kind::EncoderError], true),
            Self::Jump(_) => (Effect::BadFrames, &[Kind::EncoderJump], true),
            // At speed it stops impossibly fast.
            Self::Frozen => (
                Effect::Frozen,
                &[Kind::EncoderFrozen, Kind::EncoderJump],
                true,
            ),
            Self::BridgeFault => (Effect::AtOnce, &[Kind::BridgeFault], true),
            Self::SupplySag(_) => (Effect::LowSupply, &[Kind::SupplyLow], false),
            Self::EmergencyStop => (Effect::AtOnce, &[Kind::EmergencyStop], false),
            // At full speed the pivots lag by what was missed, which may be too far.
            Self::LateLoop => (
                Effect::LateTicks,
                &[Kind::LoopLate, Kind::FollowingError],
                false,
            ),
            // The platform ties the pivots together, so another one may be the first to be too far off.
            // At rest too: what is driven and does not stir by a bit is taken for an encoder that is frozen.
            Self::DriveLost => (
                Effect::FollowingError,
                &[Kind::FollowingError, Kind::Stalled, Kind::EncoderFrozen],
                false,
            ),
            Self::DirectionStuck | Self::Knock(_) => (
                Effect::FollowingError,
                &[Kind::FollowingError, Kind::Stalled, Kind::Overspeed],
                false,
            ),
            // Wedged to the last bit it cannot be told from an encoder that is frozen.
            Self::Jam => (
                Effect::FollowingError,
                &[Kind::FollowingError, Kind::Stalled, Kind::EncoderFrozen],
                false,
            ),
            Self::Warning => (Effect::AtOnce, &[], false),
            Self::HostSilent => (Effect::Silence, &[], false),
            Self::FewBadFrames(_) | Self::FewMissedTicks(_) => (Effect::Never, &[], false),
        };
        let (event, within_ticks) = match self {
            Self::Warning => (Some("encoder warns"), COMMAND_SIDE_TICKS),
            Self::HostSilent => (Some("no host heard"), COMMAND_SIDE_TICKS),
            // Where the setpoint slows down, it is the drive that shows it.
            Self::Frozen => (None, 30),
            // The setpoint is compared in other numbers here.
            _ if matches!(effect, Effect::FollowingError) => (None, 1),
            _ => (None, 0),
        };
        Expected {
            effect,
            kinds,
            names_pivot,
            event,
            within_ticks,
        }
    }

    /// Breaks it, or keeps it broken; before each tick from the first on, which has `age` 0.
    pub fn apply(&self, host: &mut Host, axis: usize, age: u64, random: &mut Random) {
        let encoder = &mut host.stage.encoders[axis];
        match *self {
            Self::Silent(fault) | Self::Jump(fault) => encoder.set_fault(fault),
            Self::BadCrc => encoder.set_fault(bad_frame(random)),
            Self::ErrorBit => encoder.set_fault(EncoderFault::ErrorBit),
            Self::Frozen => encoder.set_fault(EncoderFault::Frozen),
            Self::Warning => encoder.set_fault(EncoderFault::WarningBit),
            Self::FewBadFrames(frames) if age < u64::from(frames) => {
                encoder.set_fault(bad_frame(random));
            }
            Self::FewBadFrames(_) => {}
            Self::BridgeFault => host.bridges[axis].set_fault(true),
            Self::DriveLost => host.wiring[axis] = Wiring::Open,
            Self::DirectionStuck => {
                if age == 0 {
                    let forward = host.bridges[axis].state().forward;
                    host.wiring[axis] = Wiring::Direction { forward };
                }
            }
            Self::SupplySag(volts) => {
                if age == 0 {
                    host.stage.set_supply_v(volts);
                }
            }
            Self::EmergencyStop => host.emergency_stop = true,
            Self::Jam | Self::Knock(_) => self.push(&mut host.stage.plant, axis, age),
            Self::FewMissedTicks(ticks) if age >= u64::from(ticks) * MISSED_EVERY => {}
            Self::FewMissedTicks(_) | Self::LateLoop => {
                if age.is_multiple_of(MISSED_EVERY) {
                    host.miss_tick();
                }
            }
            // It is the command side that hears nothing.
            Self::HostSilent => {}
        }
    }

    /// What pushes the machine, from one tick to the next.
    pub fn push(&self, plant: &mut Plant, axis: usize, age: u64) {
        let mut external = External::default();
        match *self {
            Self::Jam if age == 0 => {
                external.jammed_at_rad[axis] = Some(plant.pivots_rad()[axis]);
            }
            Self::Knock(torque_n_m) if age == 0 => external.ring_torque_n_m[axis] = torque_n_m,
            Self::Knock(_) if age == KNOCK_TICKS => {}
            _ => return,
        }
        plant.set_external(external);
    }

    /// The tick of age 0 is the first to see it: what breaks an encoder is seen with the next frame that is latched.
    #[must_use]
    pub const fn is_of_encoder(&self) -> bool {
        self.index() <= 6
    }
}

/// A burst of one to six flipped bits, which a CRC of six bits always finds.
fn bad_frame(random: &mut Random) -> EncoderFault {
    let burst = u64::from(1 | random.below(64));
    let length = 64 - burst.leading_zeros();
    let at = LOWEST + random.below(COVERED - length + 1);
    EncoderFault::BadFrame { flip: burst << at }
}
