//! How the simulated hardware breaks.

use firmware::drivers::power_stage::CURRENT_A_PER_COUNT;

use super::injection::{Injection, MISSED_EVERY, Other, second};
use crate::front::{Host, Wiring};
use crate::machine::devices::{BrakeResistorFault, EncoderFault};
use crate::machine::plant::{External, Payload, Plant};
use crate::random::Random;

/// How long a pivot is hit: 4 ms.
const KNOCK_TICKS: u64 = 80;
/// How long a ring is driven by something else: 15 ms.
const RUNAWAY_TICKS: u64 = 300;
/// In how long what rises or fades does so: a tenth of a second.
const RISE_TICKS: f64 = 2_000.0;
const TICK_S: f64 = 50e-6;
/// Bits of the frame that a bad one may have flipped: position, flags and CRC behind a preamble of ten clocks.
const COVERED: u32 = 34;
const LOWEST: u32 = 18;

impl Injection {
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
            Self::Jam
            | Self::Knock(_)
            | Self::HotMotor(_)
            | Self::Runaway(_)
            | Self::Wedged
            | Self::PushedExcited(_) => self.push(&mut host.stage.plant, axis, age),
            Self::FewMissedTicks(ticks) if age >= u64::from(ticks) * MISSED_EVERY => {}
            Self::FewMissedTicks(_) | Self::LateLoop => {
                if age.is_multiple_of(MISSED_EVERY) {
                    host.miss_tick();
                }
            }
            Self::Crash if age == 0 => host.watchdog.crash(),
            Self::SupplyHigh(volts) | Self::ResistorHot(volts) if age == 0 => {
                host.stage.set_supply_v(volts);
            }
            Self::ResistorOpen if age == 0 => {
                (host.stage).set_brake_resistor_fault(Some(BrakeResistorFault::Open));
            }
            Self::ResistorStuckOn if age == 0 => {
                (host.stage).set_brake_resistor_fault(Some(BrakeResistorFault::StuckOn));
            }
            Self::SupplyRipple(ripple_v, hz) if age == 0 => {
                host.stage.set_supply_ripple(ripple_v, hz);
            }
            Self::Drift(rad_s) => encoder.set_offset(rad_s * TICK_S * age as f64),
            // Off by nothing where it was when it broke: the angle since then is the plant's.
            Self::Scale(share) => {
                let moved_rad = host.stage.plant.pivot_rates_rad_s()[axis] * TICK_S;
                encoder.set_offset(encoder.offset_rad() + share * moved_rad);
            }
            Self::Bursts(frames, of) if age % u64::from(of) < u64::from(frames) => {
                encoder.set_fault(bad_frame(random));
            }
            Self::BitErrors(rate) => encoder.set_fault(wrong_bits(rate, random)),
            Self::Both(other) => {
                encoder.set_fault(EncoderFault::StuckHigh);
                match other {
                    Other::EmergencyStop => host.emergency_stop = true,
                    Other::Supply => host.stage.set_supply_v(0.0),
                    Other::DriveLost => host.wiring[second(axis)] = Wiring::Open,
                    Other::Jam => self.push(&mut host.stage.plant, axis, age),
                }
            }
            Self::CurrentBias(amperes) if age == 0 => {
                host.stage.analog_inputs().current_offset_counts[axis] +=
                    amperes / CURRENT_A_PER_COUNT;
            }
            Self::Slip(rad) if age == 0 => encoder.set_offset(rad),
            Self::CurrentStuck if age == 0 => host.stage.stick_current_sensor(axis),
            Self::SupplyStuck if age == 0 => host.stage.stick_supply_sensor(),
            Self::SupplyBias(share) if age == 0 => {
                host.stage.analog_inputs().supply_gain *= share;
            }
            Self::Fading(_)
            | Self::Friction(_)
            | Self::GuideJam
            | Self::LooseCoupling(_)
            | Self::Softer(_) => {
                self.push(&mut host.stage.plant, axis, age);
            }
            Self::LoadLost if age == 0 => host.stage.plant.set_payload(Payload::NONE),
            Self::ExchangedLines if age == 0 => {
                host.stage.exchange_encoders(axis, second(axis));
            }
            // What is not of the loop's hardware: the run does it.
            Self::HostSilent
            | Self::LoopStands
            | Self::DamagedSettings
            | Self::NewerSettings
            | Self::QueueFull
            | Self::Gain(_) => {}
            // Once done, it stays.
            Self::Crash
            | Self::SupplyHigh(_)
            | Self::ResistorHot(_)
            | Self::Bursts(..)
            | Self::CurrentBias(_)
            | Self::SupplyBias(_)
            | Self::LoadLost
            | Self::ExchangedLines
            | Self::ResistorOpen
            | Self::ResistorStuckOn
            | Self::SupplyRipple(..)
            | Self::Slip(_)
            | Self::CurrentStuck
            | Self::SupplyStuck => {}
        }
    }

    /// What pushes the machine, from one tick to the next.
    pub fn push(&self, plant: &mut Plant, axis: usize, age: u64) {
        let mut external = External::default();
        match *self {
            Self::Jam | Self::Wedged if age == 0 => {
                external.jammed_at_rad[axis] = Some(plant.pivots_rad()[axis]);
            }
            Self::Both(Other::Jam) if age == 0 => {
                let next = second(axis);
                external.jammed_at_rad[next] = Some(plant.pivots_rad()[next]);
            }
            Self::GuideJam if age == 0 => {
                external.guide_jammed_at_m[axis] = Some(plant.rhos_m()[axis]);
            }
            Self::LooseCoupling(rad) if age == 0 => external.loose_rad[axis] = rad,
            Self::Softer(share) => external.lost_stiffness[axis] = share * risen(age),
            Self::Fading(share) => external.lost_torque[axis] = share * risen(age),
            Self::Friction(torque_n_m) => {
                external.more_friction_n_m[axis] = torque_n_m * risen(age);
            }
            // Slowly, or the servo would be surprised.
            Self::HotMotor(torque_n_m) => {
                external.ring_torque_n_m[axis] = torque_n_m * risen(age);
            }
            Self::Knock(torque_n_m)
            | Self::Runaway(torque_n_m)
            | Self::PushedExcited(torque_n_m)
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
        if self.lets_go() {
            plant.set_external(External::default());
        }
    }
}

/// How far what rises has risen.
fn risen(age: u64) -> f64 {
    (age as f64 / RISE_TICKS).min(1.0)
}

/// A burst of one to six flipped bits, which a CRC of six bits always finds.
fn bad_frame(random: &mut Random) -> EncoderFault {
    let burst = u64::from(1 | random.below(64));
    let length = 64 - burst.leading_zeros();
    let at = LOWEST + random.below(COVERED - length + 1);
    EncoderFault::BadFrame { flip: burst << at }
}

/// Each bit of a frame is wrong with this probability: some frames have several, and the CRC does not find one in 64 of those.
fn wrong_bits(rate: f64, random: &mut Random) -> EncoderFault {
    let hit = |flip: u64, bit: u32| {
        let is_hit = random.between(0.0, 1.0) < rate;
        flip | u64::from(is_hit) << bit
    };
    EncoderFault::BadFrame {
        flip: (0..64).fold(0, hit),
    }
}
