//! Constants of the servo, derived from the parameters.

use super::current_limit::CurrentLimitConfig;
use super::filter::FilterConfig;
use super::gear_error::GearErrorConfig;
use super::inertia::{carried_inertia, largest_carried_inertia};
use super::learnt::{FEATURES, Learnt};
use super::platform_torque::Body;
use super::ripple::RippleConfig;
use crate::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT, UNITS_PER_RAD};
use crate::iterative_learning::InversePlant;
use crate::parameters::Parameters;

/// Largest share of full duty: the bridge needs its charge pump refreshed and the current sense its window.
pub(super) const MAX_DUTY: f64 = 0.98;
/// Encoder's resolution, 2^-26 turns.
const COUNT_RAD: f64 = core::f64::consts::TAU / 67_108_864.0;
/// Counts of change in a tick whose voltage a frozen encoder's drive must exceed, and of which an oscillation's swing must be worth
/// more: what noise does not reach.
const FROZEN_COUNTS: f64 = 6.0;
const OSCILLATION_COUNTS: f64 = 25.0;
/// Time constant with which the measured current corrects the motor constant.
const MOTOR_CONSTANT_S: f64 = 0.01;
/// Most that learning adds to the corner of the velocity loop's integral: what a loop has phase for that is a third as fast as the model's,
/// since the motors are weaker and the load is heavier than it knows.
const LEARNING_CORNER_1_S: f64 = 350.0;
/// Torque at which its signal is 1, N m: what the reference motion asks for.
const TORQUE_SCALE_N_M: f64 = 6.0;

/// Constants of the servo.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoConfig {
    /// What the pivots carry.
    pub body: Body,
    /// Loops and drives, pivot by pivot.
    pub pivots: [PivotServoConfig; 3],
    /// Share of velocity gain and integral gain for each kg m^2 that a pivot moves, where they are scheduled.
    gains_per_inertia: Option<f32>,
    /// PWM counts a volt where the supply reads one ADC count.
    counts_per_volt_at_one_count: f32,
}

/// Constants of one pivot's servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotServoConfig {
    /// Of the following error's change in a tick and of the error itself (2^-32 turns, measured minus setpoint) to r.
    pub(super) rate_gain: f32,
    pub(super) position_gain: f32,
    pub(super) velocity_gain: f32,
    pub(super) integral_gain: f32,
    pub(super) filters: FilterConfig,
    pub(super) ripple: RippleConfig,
    pub(super) gear_error: GearErrorConfig,
    pub(super) learning_gains: [f32; FEATURES],
    /// What all of it may be worth together, in integral gains.
    pub(super) most_learning: f32,
    pub(super) inertia: f32,
    /// Volts a signal asks for by the model: viscous friction's per rad/s, per torque, Coulomb friction's.
    pub(super) model_weights: [f32; FEATURES],
    /// Back-EMF.
    pub(super) volt_per_rate: f32,
    /// Ticks by which torque and friction look ahead: latency and the winding's time constant.
    pub(super) lead_ticks: f32,
    pub(super) latency_s: f32,
    /// Presliding lengths a tick, for a rate of 1 rad/s.
    pub(super) presliding_per_rate: f32,
    /// Current over the dead time's knee, for a volt at rest.
    pub(in crate::control) knee_currents_per_volt: f32,
    /// Current over the knee of an ADC count; share of what the current is off by that the motor constant is corrected by, in volts.
    pub(in crate::control) knee_currents_per_count: f32,
    pub(super) motor_constant_step: f32,
    pub(super) motor_constant_limit: f32,
    /// Share of the way to its final value that the current goes in a tick.
    pub(in crate::control) current_step: f32,
    pub(super) current_limit: CurrentLimitConfig,
    /// What the dead time takes of a pulse, PWM counts.
    pub(in crate::control) dead_time_counts: f32,
    /// Largest duty, PWM counts.
    pub(in crate::control) max_counts: f32,
    /// Change of the duty that must change a reading, PWM counts.
    pub(in crate::control) frozen_duty: u16,
    /// Swing of the feedback that is an oscillation, V.
    pub(in crate::control) oscillation_swing: f32,
    /// Anti-windup: largest size of the integral, V.
    pub(super) integral_limit: f32,
    pub(super) learnt_weight_limit: [f32; FEATURES],
    /// What it starts with, and goes on with when this changes.
    pub(in crate::control) learnt: Learnt,
    /// What it moves in the middle of the disk, kg m^2.
    middle_inertia: f32,
}

impl ServoConfig {
    /// Derives the constants.
    pub fn new(parameters: &Parameters) -> Self {
        let power = &parameters.power;
        let scheduled = parameters.servo.scheduled_inertia_kg_m2;
        Self {
            body: Body::new(parameters),
            pivots: [0, 1, 2].map(|pivot| PivotServoConfig::new(parameters, pivot)),
            gains_per_inertia: (scheduled > 0.0).then_some((1.0 / scheduled) as f32),
            counts_per_volt_at_one_count: (f64::from(power.pwm_counts) / SUPPLY_V_PER_COUNT) as f32,
        }
    }

    /// The share of a pivot's velocity gain and integral gain for what it moves with its guides so long and at such angles;
    /// 1 where the gains are the same everywhere.
    #[inline]
    pub fn scheduled_share(&self, lengths: &[f32; 3], cosines: &[f32; 3], pivot: usize) -> f32 {
        match (self.gains_per_inertia, self.pivots.get(pivot)) {
            (Some(per_inertia), Some(PivotServoConfig { inertia, .. })) => {
                per_inertia * (inertia + carried_inertia(&self.body, lengths, cosines, pivot))
            }
            _ => 1.0,
        }
    }

    /// PWM counts per volt at a measured supply (ADC counts). A supply that reads as nothing gives no drive.
    #[inline]
    pub fn counts_per_volt(&self, supply_counts: f32) -> f32 {
        if supply_counts < 1.0 {
            0.0
        } else {
            self.counts_per_volt_at_one_count / supply_counts
        }
    }
}

impl PivotServoConfig {
    /// From errors to the volts that they are worth, for iterative learning.
    #[inline]
    pub fn inverse_plant(&self) -> InversePlant {
        const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
        let [volt_per_rate, volt_per_torque, _] = self.model_weights;
        InversePlant {
            volt_s2: RAD * volt_per_torque * self.middle_inertia,
            volt_s: RAD * (self.volt_per_rate + volt_per_rate),
            lead_ticks: self.lead_ticks,
        }
    }

    fn new(parameters: &Parameters, pivot: usize) -> Self {
        let Parameters {
            servo,
            limits,
            power,
            supervision,
            ..
        } = parameters;
        let (drive, gains) = (&parameters.drives[pivot], &servo.gains[pivot]);
        let period_s = 1.0 / limits.rate_hz;
        let torque_per_ampere = drive.torque_constant_n_m_a * drive.gear_ratio;
        let volt_per_torque = drive.resistance_ohm / torque_per_ampere;
        // What makes each signal about 1 is taken into its weight: gains carry it twice, limits once.
        let scale = [1.0 / limits.pivot_rate_rad_s, 1.0 / TORQUE_SCALE_N_M, 1.0];
        let share = [1.0, 1.0, servo.friction_learning];
        // By the volt that the integral has collected.
        let learning = servo.learning;
        let torque_lead_s = servo.latency_s + drive.inductance_h / drive.resistance_ohm;
        let rad_per_unit = 1.0 / UNITS_PER_RAD;
        let full = f64::from(power.pwm_counts);
        let limit_share = MAX_DUTY.min(power.voltage_limit_v / power.supply_v);
        // In the middle of the disk; a pivot alone.
        let carried = carried_inertia(&Body::new(parameters), &[1.0; 3], &[1.0; 3], pivot);
        let middle_inertia = drive.inertia_kg_m2 + f64::from(carried);
        // What a change of one count in a tick is worth grows with the gain, and the thresholds with it.
        let filters = FilterConfig::new(&servo.filters[pivot], limits.rate_hz);
        // Where gains go by the inertia, with what it is at most.
        let largest_share = match servo.scheduled_inertia_kg_m2 {
            scheduled if scheduled > 0.0 => {
                let radius = parameters.geometry.usable_radius();
                let carried = largest_carried_inertia(&Body::new(parameters), radius, pivot);
                (drive.inertia_kg_m2 + carried) / scheduled
            }
            _ => 1.0,
        };
        let largest_gain = gains.velocity_v_s_rad * largest_share;
        let volt_per_count =
            largest_gain * f64::from(filters.noise_gain()) * COUNT_RAD * limits.rate_hz;
        let frozen_v = supervision.frozen_v.max(FROZEN_COUNTS * volt_per_count);
        let oscillation_v = supervision
            .oscillation_v
            .max(OSCILLATION_COUNTS * volt_per_count);
        Self {
            rate_gain: (-limits.rate_hz * rad_per_unit) as f32,
            position_gain: (-gains.position_1_s * rad_per_unit) as f32,
            velocity_gain: gains.velocity_v_s_rad as f32,
            integral_gain: (gains.integral_v_rad * period_s) as f32,
            filters,
            ripple: RippleConfig::new(&servo.ripple[pivot].harmonics, drive, servo.latency_s),
            gear_error: GearErrorConfig::new(
                &servo.gear_errors[pivot],
                drive,
                servo.latency_s,
                limits.rate_hz,
            ),
            learning_gains: [0, 1, 2].map(|k| (learning * share[k] * scale[k] * scale[k]) as f32),
            // Without an integral there is nothing to learn from, and nothing to be bounded.
            most_learning: (LEARNING_CORNER_1_S * gains.velocity_v_s_rad / gains.integral_v_rad)
                .min(f64::from(u16::MAX)) as f32,
            inertia: drive.inertia_kg_m2 as f32,
            model_weights: [drive.viscous_n_m_s, 1.0, drive.coulomb_n_m]
                .map(|torque| (volt_per_torque * torque) as f32),
            volt_per_rate: torque_per_ampere as f32,
            lead_ticks: (torque_lead_s * limits.rate_hz) as f32,
            latency_s: servo.latency_s as f32,
            presliding_per_rate: (period_s / drive.presliding_rad) as f32,
            knee_currents_per_volt: (1.0 / (drive.resistance_ohm * drive.dead_time_knee_a)) as f32,
            knee_currents_per_count: (CURRENT_A_PER_COUNT / drive.dead_time_knee_a) as f32,
            motor_constant_step: (period_s / MOTOR_CONSTANT_S
                * drive.resistance_ohm
                * drive.dead_time_knee_a) as f32,
            motor_constant_limit: (0.5 * torque_per_ampere) as f32,
            current_step: (1.0 - libm::exp(-period_s * drive.resistance_ohm / drive.inductance_h))
                as f32,
            current_limit: CurrentLimitConfig::new(
                power.current_limit_a,
                drive.inductance_h,
                drive.dead_time_knee_a,
                limits.rate_hz,
            ),
            dead_time_counts: (drive.dead_time_s * power.pwm_hz * full) as f32,
            max_counts: (limit_share * full) as f32,
            frozen_duty: (frozen_v / power.supply_v * full).min(full) as u16,
            oscillation_swing: oscillation_v as f32,
            integral_limit: (limit_share.min(0.5) * power.supply_v) as f32,
            learnt_weight_limit: scale.map(|scale| (power.supply_v * 0.25 * scale) as f32),
            learnt: Learnt::new(&parameters.learnt[pivot]),
            middle_inertia: middle_inertia as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With 5 kg and gains that go by the inertia a count is worth as much more as the gains are at most; without, as before.
    #[test]
    fn thresholds_follow_scheduled_gains() {
        let mut parameters = Parameters::REFERENCE;
        // What is set is below what a count's noise asks for.
        parameters.supervision.frozen_v = 0.01;
        parameters.supervision.oscillation_v = 0.01;
        let thresholds = |parameters: &Parameters| {
            let pivot = PivotServoConfig::new(parameters, 1);
            [f64::from(pivot.frozen_duty), pivot.oscillation_swing.into()]
        };
        let fixed = thresholds(&parameters);
        parameters.platform.payload_kg = 5.0;
        parameters.platform.payload_inertia_kg_m2 = 0.02;
        assert_eq!(thresholds(&parameters), fixed);
        parameters.servo.scheduled_inertia_kg_m2 = 0.04;
        let config = ServoConfig::new(&parameters);
        let middle = config.scheduled_share(&[1.0; 3], &[1.0; 3], 1);
        for (scheduled, fixed) in thresholds(&parameters).into_iter().zip(fixed) {
            let share = scheduled / fixed;
            assert!(
                share > 1.2 * f64::from(middle) && share < 4.0,
                "{share} of {middle}"
            );
        }
    }
}
