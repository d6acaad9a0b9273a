//! The limit of a motor's current: volts that are taken away in the direction of a current that is too large.
//!
//! The measured current acts back on the voltage as a proportional and integral controller that only ever takes away. With the winding's
//! `i' = (v - R i - e) / L` and a tick of T between measurement and voltage, the gains put its poles within 0.88 of the origin (T = 50 us,
//! R T / L = 0.15), whatever the back-EMF e is off. It comes after the bridge's own limit, so that what it has to take away does not grow.

/// Proportional gain over L / T, V/A, and the integral's over it.
const PROPORTIONAL: f64 = 0.55;
const INTEGRAL: f32 = 0.15;

/// Constants of the limit. Currents are over the dead time's knee.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurrentLimitConfig {
    limit: f32,
    gain: f32,
}

impl CurrentLimitConfig {
    /// For a limit (A), a winding (H), a knee (A) and a rate of ticks.
    pub fn new(limit_a: f64, inductance_h: f64, knee_a: f64, rate_hz: f64) -> Self {
        Self {
            limit: (limit_a / knee_a) as f32,
            gain: (PROPORTIONAL * inductance_h * rate_hz * knee_a) as f32,
        }
    }
}

/// What is taken away at the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CurrentLimit {
    /// The integral's part, V, from 0.
    volts: f32,
    /// Follows from `volts`, and is kept beside them: with a comparison in every tick in its place the three servos took 5 % longer.
    is_active: bool,
}

impl CurrentLimit {
    /// Whether it takes anything away.
    #[inline]
    pub const fn is_active(&self) -> bool {
        self.is_active
    }

    /// Volts to take away with this current measured, with their sign.
    #[inline]
    pub fn volts(&mut self, config: &CurrentLimitConfig, measured: f32) -> f32 {
        let excess = measured.abs() - config.limit;
        if excess <= 0.0 && !self.is_active {
            return 0.0;
        }
        self.limit(config, measured, excess)
    }

    #[cold]
    fn limit(&mut self, config: &CurrentLimitConfig, measured: f32, excess: f32) -> f32 {
        let proportional = config.gain * excess;
        let volts = self.volts + INTEGRAL * proportional;
        self.volts = if volts > 0.0 { volts } else { 0.0 };
        let total = self.volts + proportional;
        self.is_active = self.volts > 0.0;
        if total > 0.0 {
            total.copysign(measured)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNEE_A: f64 = 0.043;

    /// A winding under a voltage that it cannot bear, with a back-EMF, the limit's volts a tick late.
    fn settle(wanted_v: f64, back_emf_v: f64, limit_a: f64) -> (f64, f64) {
        let config = CurrentLimitConfig::new(limit_a, 0.7e-3, KNEE_A, 20_000.0);
        let mut limit = CurrentLimit::default();
        let (mut current_a, mut most_a, mut taken_v) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..400 {
            let measured = (current_a / KNEE_A) as f32;
            for _ in 0..50 {
                let rate_a_s = (wanted_v - taken_v - back_emf_v - 2.1 * current_a) / 0.7e-3;
                current_a += rate_a_s * 1e-6;
            }
            taken_v = f64::from(limit.volts(&config, measured));
            most_a = most_a.max(current_a.abs());
        }
        (current_a, most_a)
    }

    #[test]
    fn a_current_settles_at_its_limit_whatever_the_back_emf() {
        for (wanted_v, back_emf_v) in [
            (47.0, 0.0),
            (-47.0, 0.0),
            (47.0, 20.0),
            (47.0, -30.0),
            (20.0, 0.0),
        ] {
            let (current_a, most_a) = settle(wanted_v, back_emf_v, 6.0);
            let drive_v: f64 = wanted_v - back_emf_v;
            assert!(
                (current_a - 6.0_f64.copysign(drive_v)).abs() < 0.05,
                "{wanted_v} {back_emf_v}: {current_a}"
            );
            // Until the first volts are taken away the current grows for two ticks.
            println!("{wanted_v} V against {back_emf_v} V: {most_a:.1} A at most");
            assert!(
                most_a < 6.0 + drive_v.abs() * 0.12,
                "{wanted_v} {back_emf_v}: {most_a}"
            );
        }
    }

    #[test]
    fn a_current_under_its_limit_is_left_alone() {
        let (current_a, most_a) = settle(12.0, 0.0, 6.0);
        assert!(
            (current_a - 12.0 / 2.1).abs() < 1e-3 && most_a < 5.72,
            "{current_a} {most_a}"
        );
    }
}
