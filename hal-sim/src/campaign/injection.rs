//! What is broken in a run, and how the simulated hardware does it.

use firmware::parameters::Supervision;

use crate::front::{Host, Wiring};
use crate::machine::devices::EncoderFault;
use crate::machine::plant::{AXES, External, Plant};
use crate::random::Random;

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
    /// So many ticks do not come, one in five: no fault of the loop, but at speed the pivots lead by what was missed.
    FewMissedTicks(u8),
    /// One tick in five does not come.
    LateLoop,
    /// The host falls silent, which has promised a heartbeat: no fault, but the motion is stopped and that is told.
    HostSilent,
    /// A ring is pulled at with this torque, N m, more than its motor bears for ever, until the motor lets it go.
    HotMotor(f64),
    /// A ring is driven with this torque, N m, by something else, on a stage that allows a large following error.
    Runaway(f64),
    /// Something hard gets in a pivot's way, on a stage that allows a large following error.
    Wedged,
    /// An encoder falls silent, and so many ticks later the next one, while the stage is being stopped.
    TwoEncoders(u16),
    /// The loop stands still for so many ticks until the watchdog bites, and the controller starts again.
    Watchdog(u16),
    /// A bit of the kept settings has flipped before the controller starts.
    DamagedSettings,
    /// Commands come faster than the tick can take them: they are refused, and the motion goes on.
    QueueFull,
}

/// All kinds of injection, in the table's order.
pub const NAMES: [&str; 24] = [
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
    "motor hot",
    "pivot runs away",
    "pivot wedged",
    "two encoders",
    "watchdog",
    "settings damaged",
    "queue full",
];

/// How long a pivot is hit: 4 ms.
const KNOCK_TICKS: u64 = 80;
/// One of so many ticks does not come.
pub(super) const MISSED_EVERY: u64 = 5;
/// Longest silence that a host has promised, ms, and in ticks.
pub(super) const HEARTBEAT_MS: u64 = 30;
pub(super) const HEARTBEAT_TICKS: u64 = HEARTBEAT_MS * 20;
/// How long a ring is driven by something else: 15 ms.
const RUNAWAY_TICKS: u64 = 300;
/// What the pivots may be off on a stage that is to notice something else, rad.
const LARGE_ERROR_RAD: f64 = 0.2;
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
            14 => Self::FewMissedTicks(1 + random.below(9) as u8),
            15 => Self::LateLoop,
            16 => Self::HostSilent,
            17 => Self::HotMotor(random.between(26.0, 30.0) * random.sign()),
            18 => Self::Runaway(random.between(100.0, 180.0) * random.sign()),
            19 => Self::Wedged,
            // A controlled stop takes 1,200 ticks.
            20 => Self::TwoEncoders(1 + random.below(1_200) as u16),
            // 20 ms, by an oscillator that is good to -30 and +50 %.
            21 => Self::Watchdog(280 + random.below(320) as u16),
            22 => Self::DamagedSettings,
            _ => Self::QueueFull,
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
            Self::HotMotor(_) => 17,
            Self::Runaway(_) => 18,
            Self::Wedged => 19,
            Self::TwoEncoders(_) => 20,
            Self::Watchdog(_) => 21,
            Self::DamagedSettings => 22,
            Self::QueueFull => 23,
        }
    }

    /// Sets the stage up so that this is what it notices: a following error comes before most that a pivot can do, and a motor
    /// gets hot in 20 s.
    pub const fn set_up(&self, supervision: &mut Supervision) {
        match self {
            Self::Runaway(_) => supervision.following_error_rad = LARGE_ERROR_RAD,
            Self::Wedged => {
                supervision.following_error_rad = LARGE_ERROR_RAD;
                supervision.max_saturation_s = 0.02;
                // Held as fast, its encoder need not show anything new.
                supervision.frozen_rad = 1.0;
                supervision.frozen_v = 60.0;
            }
            Self::HotMotor(_) => {
                supervision.motor_heating_s = 0.12;
                // Some of the weaker machines need 4 A for long in a motion of their own.
                supervision.motor_current_a = 5.8;
            }
            _ => {}
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
            Self::TwoEncoders(ticks) => {
                encoder.set_fault(EncoderFault::StuckHigh);
                if age >= u64::from(ticks) {
                    host.stage.encoders[second(axis)].set_fault(EncoderFault::StuckLow);
                }
            }
            Self::Jam | Self::Knock(_) | Self::HotMotor(_) | Self::Runaway(_) | Self::Wedged => {
                self.push(&mut host.stage.plant, axis, age)
            }
            Self::FewMissedTicks(ticks) if age >= u64::from(ticks) * MISSED_EVERY => {}
            Self::FewMissedTicks(_) | Self::LateLoop => {
                if age.is_multiple_of(MISSED_EVERY) {
                    host.miss_tick();
                }
            }
            Self::Watchdog(ticks) if age == 0 => {
                for _ in 0..ticks {
                    host.miss_tick();
                }
            }
            // What is not of the loop's hardware: the run does it.
            Self::HostSilent | Self::Watchdog(_) | Self::DamagedSettings | Self::QueueFull => {}
        }
    }

    /// What pushes the machine, from one tick to the next.
    pub fn push(&self, plant: &mut Plant, axis: usize, age: u64) {
        let mut external = External::default();
        match *self {
            Self::Jam | Self::Wedged if age == 0 => {
                external.jammed_at_rad[axis] = Some(plant.pivots_rad()[axis]);
            }
            Self::Knock(torque_n_m) | Self::Runaway(torque_n_m) | Self::HotMotor(torque_n_m)
                if age == 0 =>
            {
                external.ring_torque_n_m[axis] = torque_n_m;
            }
            Self::Knock(_) if age == KNOCK_TICKS => {}
            Self::Runaway(_) if age == RUNAWAY_TICKS => {}
            _ => return,
        }
        plant.set_external(external);
    }

    /// Whoever pulls at a ring that is held lets go when it is not held any more.
    pub fn let_go(&self, plant: &mut Plant) {
        if matches!(self, Self::HotMotor(_)) {
            plant.set_external(External::default());
        }
    }

    /// The tick of age 0 is the first to see it: what breaks an encoder is seen with the next frame that is latched.
    #[must_use]
    pub const fn is_of_encoder(&self) -> bool {
        self.index() <= 6 || matches!(self, Self::TwoEncoders(_))
    }
}

/// The pivot whose encoder is lost after that of another one.
pub(super) const fn second(axis: usize) -> usize {
    (axis + 1) % AXES
}

/// A burst of one to six flipped bits, which a CRC of six bits always finds.
fn bad_frame(random: &mut Random) -> EncoderFault {
    let burst = u64::from(1 | random.below(64));
    let length = 64 - burst.leading_zeros();
    let at = LOWEST + random.below(COVERED - length + 1);
    EncoderFault::BadFrame { flip: burst << at }
}
