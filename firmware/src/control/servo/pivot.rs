//! The servo of one pivot.

use super::dead_time::{compensate_dead_time, dead_time_share};
use super::platform_torque::Body;
use super::presliding::Presliding;
use crate::control::units::{SUPPLY_V_PER_COUNT, UNITS_PER_RAD};
use crate::drivers::bridge::Duty;
use crate::number;
use crate::parameters::Parameters;

/// Constants of the servo.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoConfig {
    /// What the pivots carry.
    pub body: Body,
    /// Of the following error's change in a tick and of the error itself (2^-32 turns, measured minus setpoint) to r.
    rate_gain: f32,
    position_gain: f32,
    velocity_gain: f32,
    integral_gain: f32,
    learning_gains: [f32; FEATURES],
    inertia: f32,
    /// Volts a signal asks for by the model: viscous friction's per rad/s, per torque, Coulomb friction's.
    model_weights: [f32; FEATURES],
    /// Back-EMF.
    volt_per_rate: f32,
    /// Ticks by which torque and friction look ahead: latency and the winding's time constant.
    lead_ticks: f32,
    latency_s: f32,
    /// Presliding lengths a tick, for a rate of 1 rad/s.
    presliding_per_rate: f32,
    /// Current over the dead time's knee, for a volt at rest.
    knee_currents_per_volt: f32,
    /// Share of the way to its final value that the current goes in a tick.
    current_step: f32,
    /// What the dead time takes of a pulse, PWM counts.
    dead_time_counts: f32,
    /// Largest duty, PWM counts.
    max_counts: f32,
    /// PWM counts a volt where the supply reads one ADC count.
    counts_per_volt_at_one_count: f32,
    /// Anti-windup: largest size of the integral, V.
    integral_limit: f32,
    learnt_weight_limit: [f32; FEATURES],
}

/// Signals of the setpoint that feedforward learns the weight of: rate, torque, friction.
const FEATURES: usize = 3;

/// Largest share of full duty: the bridge needs its charge pump refreshed and the current sense its window.
const MAX_DUTY: f64 = 0.98;

impl ServoConfig {
    /// Derives the constants.
    pub fn new(parameters: &Parameters) -> Self {
        let Parameters {
            geometry,
            platform,
            drive,
            servo,
            limits,
            ..
        } = parameters;
        let radius_m = geometry.radius_mm * 1e-3;
        let [x_m, y_m] = platform.payload_centre_mm.map(|mm| mm * 1e-3);
        let period_s = 1.0 / limits.rate_hz;
        let torque_per_ampere = drive.torque_constant_n_m_a * drive.gear_ratio;
        let volt_per_torque = drive.resistance_ohm / torque_per_ampere;
        // Torque at which its signal is 1: what the reference motion asks for.
        let torque_scale = 6.0;
        // What makes each signal about 1 is taken into its weight: gains carry it twice, limits once.
        let scale = [1.0 / limits.pivot_rate_rad_s, 1.0 / torque_scale, 1.0];
        let share = [1.0, 1.0, servo.friction_learning];
        // By the volt that the integral has collected.
        let learning = servo.learning;
        let torque_lead_s = servo.latency_s + drive.inductance_h / drive.resistance_ohm;
        let rad_per_unit = 1.0 / UNITS_PER_RAD;
        Self {
            body: Body {
                mass: ((platform.mass_kg + platform.payload_kg) * radius_m * radius_m) as f32,
                inertia: (platform.inertia_kg_m2
                    + platform.payload_inertia_kg_m2
                    + platform.payload_kg * (x_m * x_m + y_m * y_m))
                    as f32,
                moment: [x_m, y_m].map(|m| (platform.payload_kg * m * radius_m) as f32),
            },
            rate_gain: (-limits.rate_hz * rad_per_unit) as f32,
            position_gain: (-servo.position_1_s * rad_per_unit) as f32,
            velocity_gain: servo.velocity_v_s_rad as f32,
            integral_gain: (servo.integral_v_rad * period_s) as f32,
            learning_gains: [0, 1, 2].map(|k| (learning * share[k] * scale[k] * scale[k]) as f32),
            inertia: drive.inertia_kg_m2 as f32,
            model_weights: [drive.viscous_n_m_s, 1.0, drive.coulomb_n_m]
                .map(|torque| (volt_per_torque * torque) as f32),
            volt_per_rate: torque_per_ampere as f32,
            lead_ticks: (torque_lead_s * limits.rate_hz) as f32,
            latency_s: servo.latency_s as f32,
            presliding_per_rate: (period_s / drive.presliding_rad) as f32,
            knee_currents_per_volt: (1.0 / (drive.resistance_ohm * drive.dead_time_knee_a)) as f32,
            current_step: (1.0 - libm::exp(-period_s * drive.resistance_ohm / drive.inductance_h))
                as f32,
            dead_time_counts: (drive.dead_time_s * drive.pwm_hz) as f32
                * f32::from(drive.pwm_counts),
            max_counts: (MAX_DUTY * f64::from(drive.pwm_counts)) as f32,
            counts_per_volt_at_one_count: (f64::from(drive.pwm_counts) / SUPPLY_V_PER_COUNT) as f32,
            integral_limit: (drive.supply_v * 0.5) as f32,
            learnt_weight_limit: scale.map(|scale| (drive.supply_v * 0.25 * scale) as f32),
        }
    }
}

impl ServoConfig {
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

/// What one pivot should do at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotSetpoint {
    /// Measured minus setpoint, 2^-32 turns.
    pub error: i32,
    /// Rate, rad/s.
    pub rate: f32,
    /// Acceleration, rad/s^2.
    pub acceleration: f32,
    /// Torque the platform asks for, N m.
    pub platform_torque: f32,
}

/// State of one pivot's servo.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotServo {
    integral: f32,
    last_error: f32,
    last_inertial: f32,
    /// The signals at the last tick, as far ahead as the drive takes to follow.
    signals: [f32; FEATURES],
    friction: Presliding,
    /// Weights of the signals, volts per unit, and the integral when they were learnt last.
    learnt_weights: [f32; FEATURES],
    integral_when_learnt: f32,
    /// Motor current over the dead time's knee.
    current: f32,
    rounding_residue: f32,
    /// What it asked for last, PWM counts.
    requested_counts: f32,
}

impl PivotServo {
    /// Forgets everything but what was learnt: for servo on at rest, where the error is zero by the choice of the
    /// setpoint.
    pub fn restart(&mut self) {
        *self = Self {
            learnt_weights: self.learnt_weights,
            ..Self::default()
        };
    }

    /// From here on the setpoint is given as what is measured: feedforward and what was learnt drive alone.
    pub fn run_open_loop(&mut self) {
        self.last_error = 0.0;
    }

    /// What it asked for last, PWM counts: not a number where anything that it is made of is none.
    #[inline]
    pub fn requested_counts(&self) -> f32 {
        self.requested_counts
    }

    /// Whether it asked for as much as the bridge can give, or more.
    #[inline]
    pub fn is_saturated(&self, config: &ServoConfig) -> bool {
        self.requested_counts.abs() > config.max_counts
    }

    /// Duty for this tick; `counts_per_volt` is [`ServoConfig::counts_per_volt`].
    #[inline]
    pub fn step(
        &mut self,
        config: &ServoConfig,
        setpoint: &PivotSetpoint,
        counts_per_volt: f32,
    ) -> Duty {
        let error = setpoint.error as f32;
        let r = config.rate_gain * (error - self.last_error) + config.position_gain * error;
        self.last_error = error;

        let last_contact = self.friction.deflection();
        let contact = self
            .friction
            .advance(setpoint.rate * config.presliding_per_rate);
        let inertial = setpoint.platform_torque + config.inertia * setpoint.acceleration;
        // The signals as they will be when what is asked for acts. What was learnt holds for that, too: a motor weaker
        // by a fifth needs a fifth more for the current's change as well.
        let rate = setpoint.rate + config.latency_s * setpoint.acceleration;
        let torque = inertial + config.lead_ticks * (inertial - self.last_inertial);
        let friction = contact + config.lead_ticks * (contact - last_contact);
        self.last_inertial = inertial;
        self.signals = [rate, torque, friction];
        let feedforward = (config.model_weights[0] + self.learnt_weights[0]) * rate
            + (config.model_weights[1] + self.learnt_weights[1]) * torque
            + (config.model_weights[2] + self.learnt_weights[2]) * friction;

        // Without the back-EMF: what the current follows. It follows the voltage that is wanted, since what the dead
        // time takes of it is made up for.
        let over_emf = feedforward + self.integral + config.velocity_gain * r;
        self.current +=
            (over_emf * config.knee_currents_per_volt - self.current) * config.current_step;
        let volts = over_emf + config.volt_per_rate * rate;
        let share = dead_time_share(self.current);
        let counts = compensate_dead_time(volts * counts_per_volt, share, config.dead_time_counts);
        self.requested_counts = counts;
        let limited = clamp_symmetric(counts, config.max_counts);

        // Anti-windup: collecting stops while the bridge is saturated and the error asks for more.
        if counts == limited || counts * r < 0.0 {
            self.integral = clamp_symmetric(
                self.integral + config.integral_gain * r,
                config.integral_limit,
            );
        }
        self.quantise(limited)
    }

    /// Learns from what the integral has collected since it did last. The signals hardly change from tick to tick, so
    /// that the pivots can take turns.
    #[inline]
    pub fn learn(&mut self, config: &ServoConfig) {
        let collected = self.integral - self.integral_when_learnt;
        self.integral_when_learnt = self.integral;
        for (k, signal) in self.signals.into_iter().enumerate() {
            let weight = self.learnt_weights[k] + config.learning_gains[k] * collected * signal;
            self.learnt_weights[k] = clamp_symmetric(weight, config.learnt_weight_limit[k]);
        }
    }

    /// Rounds to whole counts and carries the rest over, so that the duty is right on average: at rest a count of 4,200
    /// is coarser than friction forgives.
    #[inline]
    fn quantise(&mut self, counts: f32) -> Duty {
        let wanted = counts + self.rounding_residue;
        let (whole, rounded) = number::round_ties_even(wanted);
        self.rounding_residue = wanted - rounded;
        Duty(whole as i16)
    }
}

/// `value`, or what lies nearest to it within +-`most`: cheaper than `clamp`, which looks at both ends (and at their
/// order).
#[inline]
fn clamp_symmetric(value: f32, most: f32) -> f32 {
    if value.abs() <= most {
        value
    } else {
        clamped_end(value, most)
    }
}

/// What is no number asks for nothing: not for full drive.
#[cold]
#[inline(never)]
fn clamped_end(value: f32, most: f32) -> f32 {
    if value < 0.0 {
        -most
    } else if value > 0.0 {
        most
    } else {
        0.0
    }
}
