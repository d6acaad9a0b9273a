//! Faults of a single pivot: one pivot is inspected in a tick, one after the other, and none in each fourth tick, which
//! sends a snapshot. So they are found at most four ticks (200 us) later than they could be, at a third of the cost.

use crate::control::config::Config;
use crate::control::inspection::{INSPECTION_PERIOD_TICKS, Inspection};
use crate::control::oscillation::OscillationWatch;
use crate::control::state::State;
use crate::control::units::UNITS_PER_RAD;
use crate::fault::FaultKind;

/// Frames with one reading after which it is asked whether there should have been others: 1 ms, three times the
/// windings' own time. Noise makes a pivot that stands under full drive show two readings in less, as a rule.
const REPEATED_READINGS: u16 = 20;

impl State {
    /// Inspects a pivot while it is driven; whether all is well with it.
    pub(in crate::control) fn inspect_pivot(
        &mut self,
        config: &Config,
        inspection: &Inspection,
    ) -> bool {
        let limits = &config.limits;
        let i = inspection.pivot;
        let separation = (inspection.next - inspection.angle).fraction();
        let closer = self.calibrated.margins.separation;
        if separation.saturating_add(closer) < limits.min_separation {
            self.raise_angle_fault(
                FaultKind::PivotsTooClose,
                i,
                separation,
                limits.min_separation,
            );
            return false;
        }
        let (Some(watch), Some(encoder), Some(servo)) = (
            self.pivot_watches.get_mut(i),
            self.encoders.get(i),
            self.servo.get(i),
        ) else {
            return true;
        };
        watch.saturated_ticks = if servo.is_saturated(&config.servo.pivots[i]) {
            watch
                .saturated_ticks
                .saturating_add(INSPECTION_PERIOD_TICKS)
        } else {
            0
        };
        if watch.saturated_ticks > limits.max_saturated_ticks {
            let seconds = [watch.saturated_ticks, limits.max_saturated_ticks]
                .map(|ticks| ticks as f32 / limits.rate_hz);
            self.raise_fault(FaultKind::Stalled, Some(i), seconds[0], seconds[1]);
            return false;
        }
        let most = config.servo.pivots[i].oscillation_swing;
        let watched = &mut watch.oscillation;
        let forgetting = limits.oscillation_memory;
        if watched.update(servo.feedback_volts(), most, forgetting, inspection.slowly) {
            let swing = watched.swing();
            self.raise_fault(FaultKind::Oscillation, Some(i), swing, most);
            return false;
        }
        if self.lost_pivot == Some(i) {
            return true;
        }
        let step = encoder.step().unsigned_abs();
        // After a tick that did not come a step is up to twice as long as it should be.
        if self.lateness == 0 && step > limits.max_step {
            let rates = [step, limits.max_step].map(|step| radians(step) * limits.rate_hz);
            self.raise_fault(FaultKind::Overspeed, Some(i), rates[0], rates[1]);
            return false;
        }
        if encoder.repeated_readings() < INSPECTION_PERIOD_TICKS as u16 {
            watch.duty = inspection.duty.0;
            watch.setpoint = None;
            watch.driven_ticks = 0;
            return true;
        }
        let begun = *watch.setpoint.get_or_insert(inspection.setpoint);
        let gone = (inspection.setpoint - begun).units().unsigned_abs() > limits.frozen_distance;
        if gone && encoder.repeated_readings() >= REPEATED_READINGS {
            self.fault_frozen_encoder(i);
        } else if drive_exceeds(
            inspection.duty.0,
            watch.duty,
            config.servo.pivots[i].frozen_duty,
        ) {
            // From here on: a reading that has rested for long may go on resting until the drive has had its time.
            watch.driven_ticks += INSPECTION_PERIOD_TICKS as u16;
            if watch.driven_ticks >= REPEATED_READINGS {
                watch.driven_ticks = 0;
                self.fault_frozen_encoder(i);
            }
        }
        true
    }

    #[cold]
    fn raise_angle_fault(&mut self, kind: FaultKind, pivot: usize, value: u32, limit: u32) {
        self.raise_fault(kind, Some(pivot), radians(value), radians(limit));
    }

    /// A new start of what counts driven time.
    pub(in crate::control) fn reset_watches(&mut self) {
        for watch in &mut self.pivot_watches {
            watch.saturated_ticks = 0;
            watch.unexplained_ticks = 0;
            watch.oscillation = OscillationWatch::default();
            watch.duty = 0;
            watch.setpoint = None;
            watch.driven_ticks = 0;
        }
    }
}

/// 2^-32 turns in rad.
fn radians(units: u32) -> f32 {
    const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
    units as f32 * RAD
}

/// Whether a duty is over one before by more than a limit, or as far on the other side of zero. Less than what moved a
/// pivot last need not move it: at the end of a motion friction keeps it where it is.
fn drive_exceeds(duty: i16, before: i16, limit: u16) -> bool {
    let [duty, before, limit] = [i32::from(duty), i32::from(before), i32::from(limit)];
    duty > before.max(0) + limit || duty < before.min(0) - limit
}
