//! A tick of the test of the motors' leads, and what comes of it.

use super::{PART_TICKS, TICKS, TURNED};
use crate::control::config::Config;
use crate::control::state::State;
use crate::drivers::bridge::Duty;

impl State {
    /// A tick of the test: its duties. A fault comes of it as soon as it is seen.
    #[cold]
    pub(in crate::control) fn test_leads(
        &mut self,
        config: &Config,
        errors: &[i32; 3],
        current_counts: &[i16; 3],
    ) -> [Duty; 3] {
        let tick = TICKS - self.lead_test.ticks_left;
        self.lead_test.ticks_left -= 1;
        let sign = match tick / PART_TICKS {
            0 => 1.0,
            1 => -1.0,
            _ => 0.0,
        };
        let counts_per_volt = config.servo.counts_per_volt(self.supply);
        let unexplained = f32::from(config.limits.unexplained_current_counts);
        // What a part has driven is measured in the tick after.
        let is_measured = tick == PART_TICKS || tick == 2 * PART_TICKS;
        let mut duty = [Duty(0); 3];
        for (i, duty) in duty.iter_mut().enumerate() {
            let (Some(motor), Some(config), Some(&counts), Some(error)) = (
                self.lead_test.motors.get_mut(i),
                config.servo.pivots.get(i),
                current_counts.get(i),
                errors.get(i),
            ) else {
                continue;
            };
            let knees_per_count = config.knee_currents_per_count;
            let current = f32::from(counts) * knees_per_count;
            if tick == 0 {
                motor.before = current;
            }
            let is_told = is_measured && error.unsigned_abs() < TURNED;
            let unexplained = unexplained * knees_per_count;
            if is_told && let Some(knees) = motor.missing(current, unexplained) {
                let [missing, limit] = knees.map(|it| it / knees_per_count);
                self.fault_unexplained_current(i, missing, limit);
                break;
            }
            *duty = motor.step(config, sign, counts_per_volt);
        }
        duty
    }
}
