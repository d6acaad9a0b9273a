//! The servo of one pivot.

use super::config::PivotServoConfig;
use super::current_limit::CurrentLimit;
use super::dead_time::{compensate_dead_time, dead_time_share};
use super::filter::Filters;
use super::learnt::{FEATURES, Learnt};
use super::presliding::Presliding;
use crate::control::rest_mode::Stiffness;
use crate::drivers::bridge::Duty;
use crate::number;
use kinematics::Angle;

/// Measured current, over the dead time's knee, from which on its size says something of the motor.
const LEAST_MEASURED: f32 = 0.5;

/// What one pivot should do at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotSetpoint {
    /// Rate, rad/s.
    pub rate: f32,
    /// Acceleration, rad/s^2.
    pub acceleration: f32,
    /// Torque the platform asks for, N m.
    pub platform_torque: f32,
    /// Angle.
    pub angle: Angle,
    /// The gear's error is computed when the pivot has its turn; at rest, where nothing changes, the ripple is too.
    pub has_turn: bool,
}

/// What is measured of one pivot at a tick, and what somebody else asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotFeedback {
    /// Measured minus setpoint, 2^-32 turns.
    pub error: i32,
    /// The motor's current as it was measured, ADC counts.
    pub current_counts: i16,
    /// What iterative learning or an excitation adds, V.
    pub added_volts: f32,
}

/// What the three loops have in common at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopSetpoint {
    /// [`ServoConfig::counts_per_volt`](super::ServoConfig::counts_per_volt).
    pub counts_per_volt: f32,
    /// What is in force of the gains.
    pub stiffness: Stiffness,
}

/// State of one pivot's servo.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotServo {
    integral: f32,
    last_error: f32,
    last_inertial: f32,
    /// The signals of the setpoint, as far ahead as the drive takes to follow; the voltage for them, and against ripple.
    signals: [f32; FEATURES],
    feedforward: f32,
    ripple: f32,
    /// Against the gear's cyclic error: its back-EMF, and for its torque.
    gear_error: [f32; 2],
    friction: Presliding,
    learnt: Learnt,
    /// The integral when it learnt last.
    integral_when_learnt: f32,
    /// Motor current over the dead time's knee, by the model.
    current: f32,
    rounding_residue: f32,
    /// Velocity error with a share of the position error, smoothed at rest.
    smoothed: f32,
    filters: Filters,
    /// Volts that the feedback asked for last.
    feedback: f32,
    /// What velocity gain and integral gain are more than their parameters, for the inertia.
    scheduled_excess: f32,
    /// What it asked for last, PWM counts.
    requested_counts: f32,
    current_limit: CurrentLimit,
}

impl PivotServo {
    /// Forgets everything but what was learnt: for servo on at rest, where the error is zero by the choice of the
    /// setpoint.
    pub fn restart(&mut self) {
        *self = Self {
            learnt: self.learnt,
            ..Self::default()
        };
    }

    /// A tick without a step: the error that the next one goes on from. What else it remembers is held.
    pub fn stand_by(&mut self, error: i32) {
        self.last_error = error as f32;
    }

    /// From here on the setpoint is given as what is measured: feedforward and what was learnt drive alone.
    pub fn run_open_loop(&mut self) {
        self.last_error = 0.0;
    }

    /// What it has learnt.
    #[inline]
    pub fn learnt(&self) -> &Learnt {
        &self.learnt
    }

    /// Has learnt this, from now on.
    pub fn restore(&mut self, learnt: &Learnt) {
        self.learnt = *learnt;
    }

    /// What feedback has collected, V.
    #[inline]
    pub fn integral_volts(&self) -> f32 {
        self.integral
    }

    /// Its motor's current by the model, over the dead time's knee.
    #[inline]
    pub fn current_knees(&self) -> f32 {
        self.current
    }

    /// Volts that the feedback asked for last.
    #[inline]
    pub fn feedback_volts(&self) -> f32 {
        self.feedback
    }

    /// Velocity gain and integral gain are this share of their parameters from now on.
    #[inline]
    pub fn schedule(&mut self, share: f32) {
        self.scheduled_excess = share - 1.0;
    }

    /// What it asked for last, PWM counts: not a number where anything that it is made of is none.
    #[inline]
    pub fn requested_counts(&self) -> f32 {
        self.requested_counts
    }

    /// Whether it asked for as much as the bridge can give or the motor may carry, or more.
    #[inline]
    pub fn is_saturated(&self, config: &PivotServoConfig) -> bool {
        self.requested_counts.abs() > config.max_counts || self.current_limit.is_active()
    }

    /// Takes the setpoint of the next [`step`](Self::step), and computes the voltage for it: before that tick has begun.
    #[inline]
    pub fn feed_forward(&mut self, config: &PivotServoConfig, setpoint: &PivotSetpoint) {
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
        if setpoint.has_turn {
            self.gear_error = (config.gear_error).volts(
                setpoint.angle,
                setpoint.rate,
                setpoint.acceleration,
                inertial,
            );
        }
        self.signals = [rate, torque, friction];
        self.feedforward = (config.model_weights[0] + self.learnt.weights[0]) * rate
            + (config.model_weights[1] + self.learnt.weights[1]) * torque
            + (config.model_weights[2] + self.learnt.weights[2]) * friction
            + self.gear_error[1];
        if setpoint.rate != 0.0 || setpoint.has_turn {
            self.ripple = config.ripple.volts(setpoint.angle, setpoint.rate);
        }
    }

    /// Duty for this tick.
    #[inline]
    pub fn step(
        &mut self,
        config: &PivotServoConfig,
        measured: &PivotFeedback,
        common: &LoopSetpoint,
    ) -> Duty {
        let Stiffness {
            gains: share,
            integral_rate,
        } = common.stiffness;
        let error = measured.error as f32;
        let unsmoothed =
            config.rate_gain * (error - self.last_error) + share * (config.position_gain * error);
        self.smoothed += (unsmoothed - self.smoothed) * share;
        let r = self.smoothed;
        self.last_error = error;

        let rate = self.signals[0];
        let feedforward = self.feedforward + measured.added_volts;
        let r = r + self.scheduled_excess * r;
        let feedback = self.filters.step(
            &config.filters,
            self.integral + share * (config.velocity_gain * r),
        );
        self.feedback = feedback;
        let ripple = self.ripple;
        let emf = config.volt_per_rate * rate + self.gear_error[0];
        let volts = feedforward + feedback + ripple + emf;
        // Without the back-EMF: what the current follows. A weight that the rate has learnt is a motor constant that is
        // off. It follows the voltage that is wanted, since what the dead time takes of it is made up for.
        let current = f32::from(measured.current_counts) * config.knee_currents_per_count;
        if current.abs() > LEAST_MEASURED {
            let missing = current - self.current;
            let excess = self.learnt.motor_constant_excess
                - config.motor_constant_step * missing * rate / (1.0 + rate * rate);
            self.learnt.motor_constant_excess =
                clamp_symmetric(excess, config.motor_constant_limit);
        }
        let over_emf = feedforward + feedback + ripple - self.learnt.motor_constant_excess * rate;
        self.current +=
            (over_emf * config.knee_currents_per_volt - self.current) * config.current_step;
        let lost = dead_time_share(self.current);
        let counts = compensate_dead_time(
            volts * common.counts_per_volt,
            lost,
            config.dead_time_counts,
        );
        self.requested_counts = counts;
        let limited = clamp_symmetric(counts, config.max_counts);
        let taken = self.current_limit.volts(&config.current_limit, current);

        // Anti-windup: collecting stops while the bridge or the motor's current is saturated and the error asks for more.
        let (is_free, drive) = if taken == 0.0 {
            (counts == limited, counts)
        } else {
            (false, current)
        };
        if is_free || drive * r < 0.0 {
            self.integral = clamp_symmetric(
                self.integral + share * integral_rate * (config.integral_gain * r),
                config.integral_limit,
            );
        }
        let allowed = limited - taken * common.counts_per_volt;
        self.quantise(clamp_symmetric(allowed, config.max_counts))
    }

    /// Volts that somebody else has given until now: the integral's from now on. Nothing is learnt from that.
    pub fn take_over(&mut self, config: &PivotServoConfig, volts: f32) {
        let before = self.integral;
        self.integral = clamp_symmetric(before + volts, config.integral_limit);
        self.integral_when_learnt += self.integral - before;
    }

    /// Learns nothing from what the integral has collected since it did last.
    #[inline]
    pub fn skip_learning(&mut self) {
        self.integral_when_learnt = self.integral;
    }

    /// Learns from what the integral has collected since it did last. The signals hardly change from tick to tick, so
    /// that the pivots can take turns.
    #[inline]
    pub fn learn(&mut self, config: &PivotServoConfig) {
        let mut collected = self.integral - self.integral_when_learnt;
        self.integral_when_learnt = self.integral;
        let steps = [0, 1, 2].map(|k| config.learning_gains[k] * self.signals[k]);
        // Integral gains that the weights are worth with these signals, the integral's own being 1.
        let added =
            (steps.iter().zip(&self.signals)).fold(0.0, |sum, (step, signal)| sum + step * signal);
        if added > config.most_learning {
            collected *= config.most_learning / added;
        }
        for (k, step) in steps.into_iter().enumerate() {
            let weight = self.learnt.weights[k] + collected * step;
            self.learnt.weights[k] = clamp_symmetric(weight, config.learnt_weight_limit[k]);
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
