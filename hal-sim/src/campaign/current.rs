//! Whether a motor carries what its voltage drives: the winding's equation from the bridge's duty and the encoder's rate.

use firmware::parameters::{Drive, Parameters};

/// What the controller allows besides its threshold, as a share of the current that should flow, and for how many ticks.
const SHARE: f64 = 0.6;
const DRIVEN_TICKS: u64 = 60;
const OFF_TICKS: u64 = 2_000;
/// Share of its threshold that a current may have gone while its reading stays the same.
const STUCK_SHARE: f64 = 0.5;
/// Largest share by which it may learn that a motor constant is another one.
const LEARNT: f64 = 0.5;
/// Shares of what is allowed from which on it is found for certain, and may be: the controller's model has the setpoint's rate.
const CERTAIN: f64 = 1.3;
const POSSIBLE: f64 = 0.7;
/// And how much longer it has to last to be looked at for certain: looks are four ticks apart, and noise makes pauses.
const LONGER: f64 = 1.2;

/// What there is to see of a motor in a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motor {
    pub volts: f64,
    pub rate_rad_s: f64,
    pub current_a: f64,
    pub is_driven: bool,
    /// At its largest voltage or current, for certain; and nearly.
    pub is_limited: [bool; 2],
}

/// One motor's current, and for how long it has not been what it should be: for certain, and possibly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Current {
    model_a: f64,
    driven: [u64; 2],
    off: [u64; 2],
    /// The last reading, the model's current when it was read for the first time, and for how long that has been far from the model's since.
    last_a: f64,
    then_a: f64,
    then_v: f64,
    stays: [u64; 2],
}

impl Current {
    pub const NONE: Self = Self {
        model_a: 0.0,
        driven: [0; 2],
        off: [0; 2],
        last_a: 0.0,
        then_a: 0.0,
        then_v: 0.0,
        stays: [0; 2],
    };

    pub fn look(&mut self, motor: Motor, drive: &Drive, parameters: &Parameters) {
        let per_tick = drive.resistance_ohm / drive.inductance_h / parameters.limits.rate_hz;
        let back_emf_v = drive.torque_constant_n_m_a * drive.gear_ratio * motor.rate_rad_s;
        let final_a = (motor.volts - back_emf_v) / drive.resistance_ohm;
        self.model_a += (final_a - self.model_a) * (1.0 - (-per_tick).exp());
        let allowed_a = parameters.supervision.unexplained_current_a;
        if !motor.is_driven {
            self.model_a = 0.0;
        }
        if motor.current_a != self.last_a {
            (self.last_a, self.then_a) = (motor.current_a, self.model_a);
            self.then_v = back_emf_v;
        }
        let gone_a = (self.model_a - self.then_a).abs();
        // So much of it the controller may take for a motor constant that is another one.
        let learnt_v = LEARNT * (back_emf_v.abs() + self.then_v.abs());
        // And the dead time, which the controller knows of, takes of the voltage, whichever way the current flows then and now.
        let power = &parameters.power;
        let dead_v = 2.0 * drive.dead_time_s * power.pwm_hz * power.supply_v;
        let unsure_a = (learnt_v + dead_v) / drive.resistance_ohm;
        let most_a = allowed_a + SHARE * self.model_a.abs();
        let apart_a = (motor.current_a - self.model_a).abs();
        let goes_on = |so_far: u64, holds: bool| if holds { so_far + 1 } else { 0 };
        for (i, factor) in [CERTAIN, POSSIBLE].into_iter().enumerate() {
            let is_apart = apart_a > factor * most_a;
            // What may be limited is not found for certain, what is limited for certain is not looked at.
            let is_driven = motor.is_driven && !motor.is_limited[1 - i];
            self.driven[i] = goes_on(self.driven[i], is_apart && is_driven);
            // For certain by more, possibly by less.
            let unsure_a = if i == 0 { unsure_a } else { -unsure_a };
            let is_gone = gone_a > factor * STUCK_SHARE * allowed_a + unsure_a;
            self.stays[i] = goes_on(self.stays[i], is_gone && is_driven);
            self.off[i] = goes_on(self.off[i], is_apart && !motor.is_driven);
        }
    }

    /// Has to be found by now.
    pub fn is_unexplained(&self) -> bool {
        let long = |ticks: u64| (LONGER * ticks as f64) as u64;
        self.driven[0] > long(DRIVEN_TICKS) || self.off[0] > long(OFF_TICKS)
    }

    /// Has to be found by now as one that does not change.
    pub fn stays(&self) -> bool {
        self.stays[0] as f64 > LONGER * DRIVEN_TICKS as f64
    }

    /// May be found by now.
    pub const fn may_be_unexplained(&self) -> bool {
        self.driven[1] > DRIVEN_TICKS * 3 / 4
            || self.stays[1] > DRIVEN_TICKS * 3 / 4
            || self.off[1] > OFF_TICKS * 3 / 4
    }
}
