//! Friction at a ring: the LuGre bristle model with presliding and Stribeck effect, plus viscous friction.
//!
//! Canudas de Wit et al., "A new model for control of systems with friction", IEEE TAC 40(3), 1995:
//! `z' = v - sigma0 |v| z / g(v)` and `T = sigma0 z + sigma1 z' + sigma2 v`. Two changes:
//!
//! - `g(v) = Tc + (Ts - Tc) / (1 + (v/vs)^2)` (Hess and Soom, 1990) in place of the Gaussian: the same shape without
//!   an exponential, which would be a third of the cost of a step.
//! - `z' = k (z_ss - z)` with `k = sigma0 |v| / g` and `z_ss = sign(v) g / sigma0` is the same equation, written so
//!   that its stiff part can be limited: `k` never exceeds 2 / step. The bristle then still settles, within a step or
//!   two, on the very torque that it settles on in the exact model, and the integrator stays stable at any rate.

use super::parameters::PlantParameters;

/// Precomputed constants of one ring's friction.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    coulomb_n_m: f64,
    static_excess_n_m: f64,
    inverse_stribeck_s_rad: f64,
    stiffness_n_m_rad: f64,
    bristle_damping_n_m_s_rad: f64,
    viscous_n_m_s_rad: f64,
}

/// Friction torque (it opposes the motion: subtract it) and rate of the bristle.
#[derive(Clone, Copy, Debug)]
pub struct FrictionState {
    /// Torque that the ring has to overcome, N m.
    pub torque_n_m: f64,
    /// Time derivative of the bristle deflection, rad/s.
    pub bristle_rate_rad_s: f64,
}

impl Friction {
    /// Takes the constants, with the switched-off effects at zero.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let on = |flag: bool| if flag { 1.0 } else { 0.0 };
        let dry = on(parameters.imperfections.dry_friction);
        let viscous = on(parameters.imperfections.viscous_friction);
        Self {
            coulomb_n_m: parameters.coulomb_n_m * dry,
            static_excess_n_m: parameters.coulomb_n_m * (parameters.stiction_ratio - 1.0) * dry,
            inverse_stribeck_s_rad: 1.0 / parameters.stribeck_rad_s,
            stiffness_n_m_rad: parameters.coulomb_n_m / parameters.presliding_rad * dry,
            bristle_damping_n_m_s_rad: parameters.bristle_damping_n_m_s_rad * dry,
            viscous_n_m_s_rad: parameters.viscous_n_m_s_rad * viscous,
        }
    }

    /// Evaluates the model at a ring rate and a bristle deflection (rad), for an integration step of `step_s`.
    #[must_use]
    pub fn evaluate(&self, rate_rad_s: f64, bristle_rad: f64, step_s: f64) -> FrictionState {
        let viscous_n_m = self.viscous_n_m_s_rad * rate_rad_s;
        if self.coulomb_n_m == 0.0 {
            return FrictionState {
                torque_n_m: viscous_n_m,
                bristle_rate_rad_s: 0.0,
            };
        }
        let bristle_rate_rad_s = self.bristle_rate(rate_rad_s, bristle_rad, step_s);
        FrictionState {
            torque_n_m: self.stiffness_n_m_rad * bristle_rad
                + self.bristle_damping_n_m_s_rad * bristle_rate_rad_s
                + viscous_n_m,
            bristle_rate_rad_s,
        }
    }

    /// Energy stored in the bristle, J.
    #[must_use]
    pub fn energy_j(&self, bristle_rad: f64) -> f64 {
        0.5 * self.stiffness_n_m_rad * bristle_rad * bristle_rad
    }

    fn bristle_rate(&self, rate_rad_s: f64, bristle_rad: f64, step_s: f64) -> f64 {
        let stribeck = rate_rad_s * self.inverse_stribeck_s_rad;
        // g(v) as a fraction, so that its reciprocal costs the only division.
        let denominator = 1.0 + stribeck * stribeck;
        let numerator_n_m = self.coulomb_n_m * denominator + self.static_excess_n_m;
        let scale = self.stiffness_n_m_rad * denominator / numerator_n_m;
        let relaxation_1_s = scale * rate_rad_s.abs();
        if relaxation_1_s * step_s <= 2.0 {
            // In this form the rate is smooth through zero, where the sign below is not defined.
            return rate_rad_s - relaxation_1_s * bristle_rad;
        }
        let settled_rad = rate_rad_s.signum() / scale;
        2.0 / step_s * (settled_rad - bristle_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 15e-6;

    /// Lets the bristle run at a constant rate, with the plant's own integrator, and returns the friction torque.
    fn settle(friction: &Friction, rate_rad_s: f64, steps: u32) -> f64 {
        let slope = |bristle| {
            friction
                .evaluate(rate_rad_s, bristle, STEP_S)
                .bristle_rate_rad_s
        };
        let mut bristle = 0.0;
        for _ in 0..steps {
            let first = slope(bristle);
            let second = slope(bristle + 0.5 * STEP_S * first);
            let third = slope(bristle + 0.5 * STEP_S * second);
            let fourth = slope(bristle + STEP_S * third);
            bristle += STEP_S / 6.0 * (first + 2.0 * (second + third) + fourth);
        }
        friction.evaluate(rate_rad_s, bristle, STEP_S).torque_n_m
    }

    #[test]
    fn sliding_friction_is_coulomb_plus_viscous_at_any_rate() {
        let friction = Friction::new(&PlantParameters::REFERENCE);
        for rate_rad_s in [1.0_f64, 10.0, 17.0, 100.0, 1000.0] {
            for signed_rad_s in [rate_rad_s, -rate_rad_s] {
                let expected_n_m = signed_rad_s.signum() * (0.1 + 0.05 * rate_rad_s);
                let torque_n_m = settle(&friction, signed_rad_s, 100);
                assert!(
                    (torque_n_m - expected_n_m).abs() < 2e-6,
                    "{signed_rad_s}: {torque_n_m}"
                );
            }
        }
    }

    #[test]
    fn slow_sliding_needs_the_break_away_torque() {
        let friction = Friction::new(&PlantParameters::REFERENCE);
        let torque_n_m = settle(&friction, 1e-4, 1_000_000);
        assert!((torque_n_m - 0.12).abs() < 1e-4, "{torque_n_m}");
    }

    #[test]
    fn presliding_is_a_spring() {
        let friction = Friction::new(&PlantParameters::REFERENCE);
        let state = friction.evaluate(0.0, 50e-6, STEP_S);
        assert!((state.torque_n_m - 0.05).abs() < 1e-12);
        assert_eq!(state.bristle_rate_rad_s, 0.0);
    }
}
