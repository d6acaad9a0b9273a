//! The tick of an excitation with the servo off.

use super::config::Config;
use super::encoder::Encoder;
use super::excitation::{ExcitationSignal, GuardBroken};
use super::next_setpoint::feed_forward;
use super::pivot_setpoints::PivotSetpoints;
use super::rest_mode::Stiffness;
use super::state::State;
use super::units::UNITS_PER_RAD;
use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::number;
use kinematics::Angle;

impl State {
    /// Duties of a tick; none, which brakes, from its end until the motors are let go.
    #[cold]
    #[inline(never)]
    pub(super) fn drive_excited(
        &mut self,
        config: &Config,
        pivots: &[Angle; 3],
        current_counts: &[i16; 3],
    ) -> [Duty; 3] {
        if self.excitation.request().is_none() {
            if self.excitation.has_come_to_rest() {
                self.finish_motion();
            }
            return [Duty(0); 3];
        }
        let steps = self.encoders.each_ref().map(Encoder::step);
        if let Some(broken) = self.excitation.broken_guard(pivots, steps) {
            self.raise_guard_fault(config, broken);
            return [Duty(0); 3];
        }
        if self.waking_ticks != 0 {
            self.waking_ticks -= 1;
            return [Duty(0); 3];
        }
        let next = self.excitation.next_volts(pivots, current_counts);
        let (Some((pivot, volts)), Some(request)) = (next, self.excitation.request()) else {
            return [Duty(0); 3];
        };
        let counts_per_volt = config.servo.counts_per_volt(self.supply);
        let (most, stiffness) = (request.guards.volts, request.guards.stiffness);
        let most_counts = number::round_ties_even(most * counts_per_volt).0 as i16;
        let mut duty = [Duty(0); 3];
        if matches!(request.signal, ExcitationSignal::Ring { .. }) {
            let wanted = PivotSetpoints::at_rest(self.excitation.setpoints);
            let errors = [0, 1, 2].map(|i| (pivots[i] - wanted.angles[i]).units() as i32);
            let stiffness = Stiffness {
                gains: stiffness,
                integral_rate: stiffness,
            };
            feed_forward(&mut self.servo, config, &wanted, self.inspection_slot);
            let (asked, _) = self.step_servos(config, &errors, stiffness, current_counts);
            duty = asked.map(|asked| Duty(asked.0.min(most_counts).max(-most_counts)));
        } else if let Some(duty) = duty.get_mut(pivot) {
            let counts = number::round_ties_even(volts * counts_per_volt).0;
            *duty = Duty(counts as i16);
        }
        duty
    }

    #[cold]
    fn raise_guard_fault(&mut self, config: &Config, broken: GuardBroken) {
        const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
        match broken {
            GuardBroken::Way(pivot, way, limit) => {
                let [way, limit] = [way, limit].map(|units| units as f32 * RAD);
                self.raise_fault(FaultKind::ExcitationWay, Some(pivot), way, limit);
            }
            GuardBroken::Rate(pivot, step, limit) => {
                let rates = [step, limit].map(|units| units as f32 * RAD * config.limits.rate_hz);
                self.raise_fault(FaultKind::Overspeed, Some(pivot), rates[0], rates[1]);
            }
        }
    }
}
