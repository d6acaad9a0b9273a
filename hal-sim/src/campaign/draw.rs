//! Which fault a run has, and how large it is.

use super::injection::{HOT_A, Injection, NAMES, Other};
use crate::machine::devices::{EncoderFault, StageParameters};
use crate::random::Random;

/// Reading off by less is bridged like bad frames and then taken for motion.
const SMALLEST_JUMP: f64 = 60_000.0;
const LARGEST_JUMP: f64 = 30_000_000.0;
/// What is more than a pivot moves with what its acceleration and noise may add; what is less than a jump.
const SMALLEST_SLIP_RAD: f64 = 12e-6;
const LARGEST_SLIP_RAD: f64 = 110e-6;

impl Injection {
    /// One of all, as likely each, of a size that fits the machine.
    pub fn random(random: &mut Random, bridged: u8, stage: &StageParameters) -> Self {
        let kind = random.below(NAMES.len() as u32);
        match kind {
            0..24 => Self::plain(kind, random, bridged, stage),
            _ => Self::subtle(kind, random, bridged, stage),
        }
    }

    fn plain(kind: u32, random: &mut Random, bridged: u8, stage: &StageParameters) -> Self {
        match kind {
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
            10 => Self::SupplySag(random.between(0.0, 35.0)),
            11 => Self::EmergencyStop,
            12 => Self::Jam,
            13 => Self::Knock(random.between(60.0, 120.0) * random.sign()),
            14 => Self::FewMissedTicks(1 + random.below(9) as u8),
            15 => Self::LateLoop,
            16 => Self::HostSilent,
            17 => {
                // What this motor holds with more than it bears, and less than its limit of 6 A; it may have friction's help.
                let plant = &stage.plant;
                let current_a = random.between(1.15 * HOT_A, 1.26 * HOT_A);
                let friction_n_m = plant.ring_friction.coulomb + plant.motor_friction.coulomb;
                let held_n_m = plant.ring_torque_constant_n_m_a() * current_a + friction_n_m;
                Self::HotMotor(held_n_m * random.sign())
            }
            18 => Self::Runaway(random.between(100.0, 180.0) * random.sign()),
            19 => Self::Wedged,
            // A controlled stop takes 1,200 ticks.
            20 => Self::TwoEncoders(1 + random.below(1_200) as u16),
            21 => Self::LoopStands,
            22 => Self::DamagedSettings,
            _ => Self::QueueFull,
        }
    }

    fn subtle(kind: u32, random: &mut Random, bridged: u8, stage: &StageParameters) -> Self {
        match kind {
            24 => Self::Crash,
            25 => Self::SupplyHigh(random.between(60.5, 64.0)),
            26 => Self::ResistorHot(random.between(56.0, 57.0)),
            27 => Self::SupplyRipple(random.between(0.2, 2.5), random.between(50.0, 300.0)),
            28 => Self::Drift(random.between(0.1e-3, 5e-3) * random.sign()),
            29 => Self::Scale(random.between(1e-5, 3e-3) * random.sign()),
            30 => {
                let frames = 1 + random.below(u32::from(bridged));
                Self::Bursts(frames as u8, (frames + 4 + random.below(40)) as u8)
            }
            31 => Self::BitErrors(random.between(1e-4, 20e-3)),
            32 => Self::Both(*random.pick(&[
                Other::EmergencyStop,
                Other::Supply,
                Other::Jam,
                Other::DriveLost,
            ])),
            33 => Self::CurrentBias(random.between(0.2, 3.0) * random.sign()),
            34 => Self::SupplyBias(random.between(0.85, 1.1)),
            35 => Self::Fading(random.between(0.1, 0.7)),
            36 => Self::Friction(random.between(0.5, 10.0)),
            37 => Self::GuideJam,
            38 => Self::LooseCoupling(random.between(20e-6, 3e-3)),
            39 => Self::LoadLost,
            40 => Self::ExchangedLines,
            41 => Self::Gain(random.between(3.0, 12.0)),
            42 => Self::ResistorOpen,
            43 => Self::ResistorStuckOn,
            44 => Self::Slip(random.between(SMALLEST_SLIP_RAD, LARGEST_SLIP_RAD) * random.sign()),
            45 => Self::CurrentStuck,
            46 => Self::SupplyStuck,
            47 => Self::NewerSettings,
            48 => {
                // From what hardly moves it against its friction on, to what is too fast at once.
                let plant = &stage.plant;
                let friction_n_m = plant.ring_friction.coulomb + plant.motor_friction.coulomb;
                let more_n_m = 0.3 * random.between(0.0, 5.0).exp();
                Self::PushedExcited((friction_n_m + more_n_m) * random.sign())
            }
            // Its resonance falls to 0.95 to 0.3 of what it was.
            _ => Self::Softer(random.between(0.1, 0.9)),
        }
    }
}
