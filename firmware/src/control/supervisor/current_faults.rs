//! Faults that a motor's current shows: all three are looked at every fourth tick, in which no pivot is inspected.

use crate::control::config::Config;
use crate::control::inspection::{INSPECTION_PERIOD_TICKS, SNAPSHOT_SLOT};
use crate::control::state::State;
use crate::control::units::CURRENT_A_PER_COUNT;
use crate::fault::FaultKind;
use crate::mode::Mode;
use crate::number::sqrt_f32;

/// Share of the current that its voltage should drive by which the measured one may be off: a winding's resistance may be a third off,
/// and grows by a quarter when it is hot.
const EXPLAINED_SHARE: f32 = 0.6;
/// Share of what a current may be off by that it may have gone by the model while its reading has stayed the same to the bit.
const STUCK_SHARE: f32 = 0.5;
/// How long a current may be unexplained, ticks: 3 ms driven, nine of the windings' own times; 100 ms with the servo off, where a
/// motor that is turned by hand drives none, and what flowed before has gone.
const DRIVEN_TICKS: u32 = 60;
const OFF_TICKS: u32 = 2_000;

impl State {
    /// Looks at all three currents, in the slot in which no pivot is inspected.
    #[inline]
    pub(in crate::control) fn check_currents(
        &mut self,
        config: &Config,
        current_counts: &[i16; 3],
    ) {
        if self.inspection_slot != SNAPSHOT_SLOT {
            return;
        }
        for (i, counts) in current_counts.iter().enumerate() {
            self.check_current(config, i, *counts);
        }
        if self.mode == Mode::Holding {
            self.test_brake_resistor_at_rest(&config.limits);
        }
    }

    // One copy of the code: it lies in memory that is short.
    #[inline(never)]
    fn check_current(&mut self, config: &Config, pivot: usize, counts: i16) {
        self.check_motor_heat(config, pivot, counts);
        if self.servo_on() {
            // The test of the leads drives what the servo's model does not know.
            if !self.is_waking() {
                self.check_driven_current(config, pivot, counts);
            }
        } else if self.mode == Mode::Off && config.commissioned {
            self.check_idle_current(config, pivot, counts);
        }
    }

    /// The motor's temperature, in every state: it cools while nothing drives it.
    fn check_motor_heat(&mut self, config: &Config, pivot: usize, counts: i16) {
        let Some(watch) = self.pivot_watches.get_mut(pivot) else {
            return;
        };
        let counts = f32::from(counts);
        watch.mean_square_current +=
            (counts * counts - watch.mean_square_current) * config.limits.winding_smoothing;
        let (heat, most) = (
            watch.mean_square_current,
            config.limits.max_mean_square_current,
        );
        if heat > most && self.is_driven() {
            let (value, limit) = (sqrt_f32(heat) * AMPERE, sqrt_f32(most) * AMPERE);
            self.raise_fault(FaultKind::MotorHot, Some(pivot), value, limit);
        }
    }

    /// A motor that nothing drives carries nothing, unless its bridge conducts or its sensor is off.
    fn check_idle_current(&mut self, config: &Config, pivot: usize, counts: i16) {
        let Some(watch) = self.pivot_watches.get_mut(pivot) else {
            return;
        };
        let most = config.limits.unexplained_current_counts;
        watch.unexplained_ticks = longer(watch.unexplained_ticks, counts.unsigned_abs() < most);
        if watch.unexplained_ticks > OFF_TICKS {
            self.fault_unexplained_current(pivot, f32::from(counts), f32::from(most));
        }
    }

    /// Whether a motor carries what its voltage should drive, by the servo's model of it: a lead that is lost, a bridge that does not do
    /// what it is told, a winding that has shorted and a sensor that is off all show here, before the pivot does.
    fn check_driven_current(&mut self, config: &Config, pivot: usize, counts: i16) {
        let (Some(watch), Some(servo), Some(servo_config)) = (
            self.pivot_watches.get_mut(pivot),
            self.servo.get(pivot),
            config.servo.pivots.get(pivot),
        ) else {
            return;
        };
        let knees_per_count = servo_config.knee_currents_per_count;
        let model = servo.current_knees();
        let unexplained = f32::from(config.limits.unexplained_current_counts) * knees_per_count;
        let mut apart = f32::from(counts) * knees_per_count - model;
        let mut most = unexplained + EXPLAINED_SHARE * model.abs();
        if counts == watch.current_counts {
            // A reading that stays the same to the bit says nothing of the current: what counts is how far that has gone since then.
            let stayed = watch.model_then - model;
            if stayed.abs() > STUCK_SHARE * unexplained {
                (apart, most) = (stayed, STUCK_SHARE * unexplained);
            }
        } else {
            watch.current_counts = counts;
            watch.model_then = model;
        }
        // What is taken away at its limits the model does not know.
        let is_explained = apart.abs() < most || servo.is_saturated(servo_config);
        watch.unexplained_ticks = longer(watch.unexplained_ticks, is_explained);
        if watch.unexplained_ticks > DRIVEN_TICKS {
            let values = [apart, most].map(|knees| knees / knees_per_count);
            self.fault_unexplained_current(pivot, values[0], values[1]);
        }
    }

    /// Both in ADC counts.
    #[cold]
    pub(in crate::control) fn fault_unexplained_current(
        &mut self,
        pivot: usize,
        value: f32,
        limit: f32,
    ) {
        let kind = FaultKind::CurrentUnexplained;
        self.raise_fault(kind, Some(pivot), value * AMPERE, limit * AMPERE);
    }
}

/// An ADC count of a current, A.
const AMPERE: f32 = CURRENT_A_PER_COUNT as f32;

/// How long something has gone on, from one look to the next.
#[inline]
const fn longer(ticks: u32, is_over: bool) -> u32 {
    if is_over {
        0
    } else {
        ticks.saturating_add(INSPECTION_PERIOD_TICKS)
    }
}
