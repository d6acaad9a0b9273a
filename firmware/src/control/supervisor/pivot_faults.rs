//! Faults of a single pivot: one pivot is looked at in a tick, in turn, and none in each fourth, which leaves a snapshot. So they
//! are found at most four ticks (200 us) later than they could be, at a third of the cost.

use super::inspection::{TURN, Turn};
use crate::control::config::{CURRENT_A_PER_COUNT, Config};
use crate::control::{Inputs, State};
use crate::fault::FaultKind;
use crate::number::sqrt_f32;

/// Frames with one reading after which it is asked whether there should have been others: 1 ms, three times the windings' own
/// time. Noise makes a pivot that stands under full drive show two readings in less, as a rule.
const SAME_READINGS: u16 = 20;

impl State {
    /// The motor's temperature, in every state: it cools while nothing drives it.
    pub(in crate::control) fn watch_heat(&mut self, config: &Config, inputs: &Inputs) {
        let i = self.turn;
        let (Some(watch), Some(counts)) = (self.watch.get_mut(i), inputs.current_counts.get(i))
        else {
            return;
        };
        let counts = f32::from(*counts);
        watch.heat += (counts * counts - watch.heat) * config.limits.heating;
        let (heat, most) = (watch.heat, config.limits.heat);
        if heat > most && self.servo_on() {
            const A: f32 = CURRENT_A_PER_COUNT as f32;
            let (value, limit) = (sqrt_f32(heat) * A, sqrt_f32(most) * A);
            self.fail(FaultKind::MotorHot, Some(i), value, limit);
        }
    }

    /// Looks at the pivot whose turn it is, while it is driven; whether all is well with it.
    pub(in crate::control) fn watch_pivot(&mut self, config: &Config, turn: &Turn) -> bool {
        let limits = &config.limits;
        let i = turn.pivot;
        let separation = (turn.next - turn.angle).fraction();
        if separation < limits.separation {
            self.fail_by_angle(FaultKind::PivotsTooClose, i, separation, limits.separation);
            return false;
        }
        let (Some(watch), Some(encoder), Some(servo)) = (
            self.watch.get_mut(i),
            self.encoders.get(i),
            self.servo.get(i),
        ) else {
            return true;
        };
        watch.at_end = if servo.is_at_end(&config.servo) {
            watch.at_end.saturating_add(TURN)
        } else {
            0
        };
        if watch.at_end > limits.at_end {
            let seconds = [watch.at_end, limits.at_end].map(|ticks| ticks as f32 / limits.hz);
            self.fail(FaultKind::Stalled, Some(i), seconds[0], seconds[1]);
            return false;
        }
        if self.lost == Some(i) {
            return true;
        }
        let step = encoder.step().unsigned_abs();
        // After a tick that did not come a step is up to twice as long as it should be.
        if self.lateness == 0 && step > limits.overspeed {
            let rates = [step, limits.overspeed].map(|step| radians(step) * limits.hz);
            self.fail(FaultKind::Overspeed, Some(i), rates[0], rates[1]);
            return false;
        }
        if encoder.same_readings() < TURN as u16 {
            watch.duty = turn.duty.0;
            watch.setpoint = None;
            watch.driven = 0;
            return true;
        }
        let begun = *watch.setpoint.get_or_insert(turn.setpoint);
        let gone = (turn.setpoint - begun).units().unsigned_abs() > limits.frozen_way;
        if gone && encoder.same_readings() >= SAME_READINGS {
            self.freeze(i);
        } else if drives_more(turn.duty.0, watch.duty, limits.frozen_duty) {
            // From here on: a reading that has rested for long may go on resting until the drive has had its time.
            watch.driven += TURN as u16;
            if watch.driven >= SAME_READINGS {
                watch.driven = 0;
                self.freeze(i);
            }
        }
        true
    }

    #[cold]
    fn fail_by_angle(&mut self, kind: FaultKind, pivot: usize, value: u32, limit: u32) {
        self.fail(kind, Some(pivot), radians(value), radians(limit));
    }

    /// A new start of what counts driven time.
    pub(in crate::control) fn rest_watches(&mut self) {
        for watch in &mut self.watch {
            watch.at_end = 0;
            watch.duty = 0;
            watch.setpoint = None;
            watch.driven = 0;
        }
    }
}

/// 2^-32 turns in rad.
fn radians(units: u32) -> f32 {
    const RAD: f32 = (1.0 / crate::control::config::UNITS_PER_RAD) as f32;
    units as f32 * RAD
}

/// Whether a duty is over one before by more than a limit, or as far on the other side of zero. Less than what moved a pivot
/// last need not move it: at the end of a motion friction keeps it where it is.
fn drives_more(duty: i16, before: i16, limit: u16) -> bool {
    let [duty, before, limit] = [i32::from(duty), i32::from(before), i32::from(limit)];
    duty > before.max(0) + limit || duty < before.min(0) - limit
}
