//! Faults that the inputs show.

use crate::control::config::{Config, MAX_SUPPLY_COUNTS};
use crate::control::state::{Inputs, State};
use crate::control::units::SUPPLY_V_PER_COUNT;
use crate::fault::{FaultKind, Reaction};
use crate::mode::Mode;

/// Ticks in a row that a bad supply is one: 0.2 ms, over which a converter's noise is none.
const BAD_SUPPLY_TICKS: u8 = 4;
/// Ticks over which one late tick is forgiven.
pub(super) const LATE_RECOVERY_TICKS: u32 = 100;

impl State {
    /// Checks the inputs. In a tick with nothing unusual that is one comparison for all of them.
    #[inline]
    pub(in crate::control) fn check_inputs(&mut self, config: &Config, inputs: &Inputs) {
        let [one, two, three] = inputs.bridge_fault;
        let reported =
            inputs.emergency_stop | inputs.program_damaged | inputs.late | one | two | three;
        let [first, second, third] = self.bridge_faults;
        let seen = first | second | third;
        let pending = self.lateness | u32::from(self.bad_supply_ticks) | u32::from(seen);
        let is_well = (self.encoders.iter()).all(|encoder| encoder.unusable().is_none());
        let is_fed = config.limits.has_good_supply(inputs.supply_counts);
        if reported || pending != 0 || !is_well || !is_fed || self.mode == Mode::Fault {
            self.check_unusual_inputs(config, inputs);
        }
    }

    #[cold]
    fn check_unusual_inputs(&mut self, config: &Config, inputs: &Inputs) {
        if self.mode == Mode::Fault {
            // An encoder that is lost loses its turns, whatever else is wrong already.
            self.referenced &= self.encoders.iter().all(|e| e.unusable().is_none());
            return;
        }
        if inputs.emergency_stop {
            self.raise_fault(FaultKind::EmergencyStop, None, 0.0, 0.0);
            return;
        }
        if inputs.program_damaged {
            self.raise_fault(FaultKind::ImageDamaged, None, 0.0, 0.0);
            return;
        }
        self.check_lateness(config, inputs.late);
        if self.is_driven() {
            self.check_power(config, inputs);
        } else {
            self.bridge_faults = [false; 3];
        }
        if self.referenced || matches!(self.mode, Mode::Stopping | Mode::Exciting) {
            self.check_encoders();
        }
    }

    fn check_lateness(&mut self, config: &Config, late: bool) {
        if late {
            self.lateness = self.lateness.saturating_add(LATE_RECOVERY_TICKS);
            let most = config.limits.late_ticks;
            if self.lateness > most.saturating_mul(LATE_RECOVERY_TICKS) {
                let value = self.lateness.div_ceil(LATE_RECOVERY_TICKS) as f32;
                self.raise_fault(FaultKind::LoopLate, None, value, most as f32);
            }
        } else {
            self.lateness = self.lateness.saturating_sub(1);
        }
    }

    fn check_power(&mut self, config: &Config, inputs: &Inputs) {
        self.check_bridges(config, inputs);
        let (counts, limits) = (inputs.supply_counts, &config.limits);
        if limits.has_good_supply(counts) {
            self.bad_supply_ticks = 0;
            return;
        }
        self.bad_supply_ticks += 1;
        if self.bad_supply_ticks >= BAD_SUPPLY_TICKS {
            self.bad_supply_ticks = 0;
            let (kind, limit) = if counts < limits.min_supply_counts {
                (FaultKind::SupplyLow, limits.min_supply_counts)
            } else {
                (FaultKind::SupplyHigh, MAX_SUPPLY_COUNTS)
            };
            let volts = |counts: u16| f32::from(counts) * SUPPLY_V_PER_COUNT as f32;
            self.raise_fault(kind, None, volts(counts), volts(limit));
        }
    }

    /// A fault pin is believed in its second tick in a row: a spike on an open-drain line next to 40 kHz is no fault, and a bridge
    /// that has switched itself off stays so. While the bridges wake up their pins mean nothing.
    fn check_bridges(&mut self, config: &Config, inputs: &Inputs) {
        if self.waking_ticks != 0 {
            return;
        }
        let faults = config.wiring.bridge_faults(&inputs.bridge_fault);
        let before = core::mem::replace(&mut self.bridge_faults, faults);
        for (i, (now, before)) in faults.into_iter().zip(before).enumerate() {
            if now && before {
                self.raise_fault(FaultKind::BridgeFault, Some(i), 0.0, 0.0);
            }
        }
    }

    fn check_encoders(&mut self) {
        for i in 0..3 {
            if self.lost_pivot == Some(i) {
                continue;
            }
            if let Some(kind) = self.encoders[i].unusable() {
                self.raise_fault(kind, Some(i), 0.0, 0.0);
            }
        }
    }

    /// An encoder that repeats itself, found out by what should have moved it. The servo has been misled by then, so
    /// that its integral is nothing to go on blindly with; the pivot is slow, or it would have been found by its own
    /// speed.
    #[cold]
    pub(in crate::control) fn fault_frozen_encoder(&mut self, pivot: usize) {
        if let Some(encoder) = self.encoders.get_mut(pivot) {
            encoder.mark_unusable(FaultKind::EncoderFrozen);
        }
        let kind = FaultKind::EncoderFrozen;
        self.raise_fault_with(Reaction::Brake, kind, Some(pivot), [0.0; 2]);
    }
}
