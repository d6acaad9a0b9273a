//! Faults that the inputs show.

use super::super::{Inputs, State};
use crate::config::{Config, SUPPLY_V_PER_COUNT};
use crate::fault::FaultKind;
use crate::link::Mode;

/// Ticks in a row that a low supply is one: 0.2 ms, over which a converter's noise is none.
const SUPPLY_TICKS: u8 = 4;
/// Ticks over which one late tick is forgiven.
const FORGIVEN: u32 = 100;
/// Frames with one reading after which it is asked whether there should have been others.
const SAME_READINGS: u16 = 4;

impl State {
    pub(in super::super) fn check_inputs(&mut self, config: &Config, inputs: &Inputs) {
        if self.mode == Mode::Fault {
            // An encoder that is lost loses its turns, whatever else is wrong already.
            self.referenced &= self.encoders.iter().all(|e| e.unusable().is_none());
            return;
        }
        if inputs.emergency_stop {
            self.fail(FaultKind::EmergencyStop, None, 0.0, 0.0);
            return;
        }
        self.check_lateness(config, inputs.late);
        let driven = self.servo_on();
        if driven {
            self.check_power(config, inputs);
        }
        if self.referenced || self.mode == Mode::Stopping {
            self.check_encoders(config, driven);
        }
    }

    fn check_lateness(&mut self, config: &Config, late: bool) {
        if late {
            self.lateness = self.lateness.saturating_add(FORGIVEN);
            let most = config.limits.late_ticks;
            if self.lateness > most.saturating_mul(FORGIVEN) {
                let value = self.lateness.div_ceil(FORGIVEN) as f32;
                self.fail(FaultKind::LoopLate, None, value, most as f32);
            }
        } else {
            self.lateness = self.lateness.saturating_sub(1);
        }
    }

    fn check_power(&mut self, config: &Config, inputs: &Inputs) {
        for i in 0..3 {
            if inputs.bridge_fault[i] {
                self.fail(FaultKind::BridgeFault, Some(i), 0.0, 0.0);
            }
        }
        if inputs.supply_counts >= config.limits.supply_min {
            self.low_supply = 0;
            return;
        }
        self.low_supply += 1;
        if self.low_supply >= SUPPLY_TICKS {
            self.low_supply = 0;
            let volts = |counts: u16| f32::from(counts) * SUPPLY_V_PER_COUNT as f32;
            let limit = config.limits.supply_min;
            self.fail(
                FaultKind::SupplyLow,
                None,
                volts(inputs.supply_counts),
                volts(limit),
            );
        }
    }

    fn check_encoders(&mut self, config: &Config, driven: bool) {
        for i in 0..3 {
            if self.lost == Some(i) {
                continue;
            }
            let encoder = &self.encoders[i];
            if let Some(kind) = encoder.unusable() {
                self.fail(kind, Some(i), 0.0, 0.0);
            } else if driven && encoder.same_readings() >= SAME_READINGS {
                let way = f32::from(encoder.same_readings()) * self.rates[i].abs();
                if way > config.limits.frozen_way {
                    self.freeze(i);
                }
            }
        }
    }

    /// An encoder that repeats itself.
    #[cold]
    pub(super) fn freeze(&mut self, pivot: usize) {
        if let Some(encoder) = self.encoders.get_mut(pivot) {
            encoder.give_up(FaultKind::EncoderFrozen);
        }
        self.fail(FaultKind::EncoderFrozen, Some(pivot), 0.0, 0.0);
    }
}
