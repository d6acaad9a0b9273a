//! What is broken in a run.

use firmware::parameters::{Parameters, Supervision};

use crate::machine::devices::EncoderFault;
use crate::machine::plant::AXES;

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
    /// The loop stands still. What happens then is the watchdog's.
    LoopStands,
    /// A bit of the kept settings has flipped before the controller starts.
    DamagedSettings,
    /// Commands come faster than the tick can take them: they are refused, and the motion goes on.
    QueueFull,
    /// The program ends itself, by a panic or a processor fault.
    Crash,
    /// The supply rises to this, V, for good.
    SupplyHigh(f64),
    /// The supply rises to this, V, at which the brake resistor is on for good.
    ResistorHot(f64),
    /// The supply has a ripple of this amplitude, V, and frequency, Hz: no fault.
    SupplyRipple(f64, f64),
    /// An encoder drifts by so much, rad/s.
    Drift(f64),
    /// An encoder's scale is off by this share from now on.
    Scale(f64),
    /// A contact fails over and over, so many frames of so many: no more in a row than are bridged.
    Bursts(u8, u8),
    /// This share of the bits of an encoder's frames is wrong.
    BitErrors(f64),
    /// An encoder is lost, and in the same tick something else breaks.
    Both(Other),
    /// A current sensor reads so many amperes more.
    CurrentBias(f64),
    /// The supply's sensor reads this share of what it should.
    SupplyBias(f64),
    /// A motor loses this share of its torque in a tenth of a second.
    Fading(f64),
    /// A ring's friction rises by this, N m, in a tenth of a second.
    Friction(f64),
    /// A carriage jams on its guide.
    GuideJam,
    /// A coupling comes loose by this to either side, rad.
    LooseCoupling(f64),
    /// The load falls off the platform.
    LoadLost,
    /// The plugs of two encoders are exchanged before the controller starts.
    ExchangedLines,
    /// A setting makes the velocity gain so many times as high.
    Gain(f64),
    /// The brake resistor, or its switch, is open.
    ResistorOpen,
    /// The switch of the brake resistor has failed short.
    ResistorStuckOn,
    /// An encoder slips by this, rad, once: no fault, but it is told.
    Slip(f64),
    /// The converter of a current repeats its last sample.
    CurrentStuck,
    /// The converter of the supply repeats its last sample.
    SupplyStuck,
    /// What is kept was written by a newer firmware.
    NewerSettings,
    /// With the servo off and a motor excited, a ring is pushed with this torque, N m, until the motors brake.
    PushedExcited(f64),
    /// A transmission loses this share of its stiffness in a tenth of a second.
    Softer(f64),
}

/// What breaks in the same tick as an encoder falls silent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Other {
    /// The emergency stop is pressed.
    EmergencyStop,
    /// The supply is gone.
    Supply,
    /// The next pivot is jammed.
    Jam,
    /// The next motor's wire breaks.
    DriveLost,
}

/// All kinds of injection, in the table's order.
pub const NAMES: [&str; 50] = [
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
    "loop stands still",
    "settings damaged",
    "queue full",
    "program crashes",
    "supply too high",
    "resistor overloaded",
    "supply ripple",
    "encoder drifts",
    "encoder scale",
    "bursts of bad frames",
    "bit errors",
    "encoder and another",
    "current sensor bias",
    "supply sensor bias",
    "motor fades",
    "friction rises",
    "carriage jammed",
    "coupling loose",
    "load lost",
    "encoders exchanged",
    "gain too high",
    "brake resistor open",
    "resistor stuck on",
    "encoder slips",
    "current sensor stuck",
    "supply sensor stuck",
    "settings newer",
    "pushed while excited",
    "transmission softer",
];

/// One of so many ticks does not come.
pub(super) const MISSED_EVERY: u64 = 5;

impl Injection {
    /// How many ticks have not come, so many after the first that does not.
    pub(super) fn missed_ticks(&self, age: u64) -> u64 {
        let missed = age / MISSED_EVERY + 1;
        match *self {
            Self::FewMissedTicks(ticks) => missed.min(ticks.into()),
            Self::LateLoop => missed,
            _ => 0,
        }
    }
}

/// Longest silence that a host has promised, ms, and in ticks.
pub(super) const HEARTBEAT_MS: u64 = 30;
pub(super) const HEARTBEAT_TICKS: u64 = HEARTBEAT_MS * 20;
/// What the pivots may be off on a stage that is to notice something else, rad.
const LARGE_ERROR_RAD: f64 = 0.2;
/// Current that a motor bears for ever on a stage that is to notice a hot one, A.
pub(super) const HOT_A: f64 = 4.6;
/// Ticks after the injection in which an effect is waited for, and those in which a brake resistor becomes too hot.
const PATIENCE: u64 = 3_000;
const HEATING: u64 = 40_000;

impl Injection {
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
            Self::LoopStands => 21,
            Self::DamagedSettings => 22,
            Self::QueueFull => 23,
            Self::Crash => 24,
            Self::SupplyHigh(_) => 25,
            Self::ResistorHot(_) => 26,
            Self::SupplyRipple(..) => 27,
            Self::Drift(_) => 28,
            Self::Scale(_) => 29,
            Self::Bursts(..) => 30,
            Self::BitErrors(_) => 31,
            Self::Both(_) => 32,
            Self::CurrentBias(_) => 33,
            Self::SupplyBias(_) => 34,
            Self::Fading(_) => 35,
            Self::Friction(_) => 36,
            Self::GuideJam => 37,
            Self::LooseCoupling(_) => 38,
            Self::LoadLost => 39,
            Self::ExchangedLines => 40,
            Self::Gain(_) => 41,
            Self::ResistorOpen => 42,
            Self::ResistorStuckOn => 43,
            Self::Slip(_) => 44,
            Self::CurrentStuck => 45,
            Self::SupplyStuck => 46,
            Self::NewerSettings => 47,
            Self::PushedExcited(_) => 48,
            Self::Softer(_) => 49,
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
                supervision.motor_current_a = HOT_A;
            }
            _ => {}
        }
    }

    /// Ticks after it in which an effect is waited for.
    #[must_use]
    pub const fn patience(&self) -> u64 {
        match self {
            Self::ResistorHot(_) => HEATING,
            Self::HotMotor(_) => 2 * PATIENCE,
            _ => PATIENCE,
        }
    }

    /// Whether somebody pulls who lets go of a stage that is braked or coasts.
    #[must_use]
    pub const fn lets_go(&self) -> bool {
        matches!(self, Self::HotMotor(_) | Self::PushedExcited(_))
    }

    /// Whether it is there from the start.
    #[must_use]
    pub const fn is_before_start(&self) -> bool {
        matches!(
            self,
            Self::DamagedSettings | Self::NewerSettings | Self::ExchangedLines
        )
    }

    /// Whether the program ticks no more, until something starts it again.
    #[must_use]
    pub const fn ends_program(&self) -> bool {
        matches!(self, Self::LoopStands | Self::Crash)
    }

    /// A line that somebody sends in place of breaking something.
    #[must_use]
    pub fn line(&self, parameters: &Parameters) -> Option<String> {
        let Self::Gain(factor) = *self else {
            return None;
        };
        let gain = parameters.servo.gains[0].velocity_v_s_rad * factor;
        Some(format!(
            "CCL 1 ADVANCED\nSPA 1 0x54500301 {:.3}",
            gain.min(500.0)
        ))
    }

    /// The tick of age 0 is the first to see it: what breaks an encoder is seen with the next frame that is latched.
    #[must_use]
    pub const fn is_of_encoder(&self) -> bool {
        self.index() <= 6
            || matches!(
                self,
                Self::TwoEncoders(_) | Self::BitErrors(_) | Self::Both(_)
            )
    }
}

/// The pivot whose encoder is lost after that of another one.
pub(super) const fn second(axis: usize) -> usize {
    (axis + 1) % AXES
}
