//! Friction of a ring, or of a carriage on its guide: the LuGre bristle model with presliding and Stribeck effect, plus viscous
//! friction.
//!
//! Canudas de Wit et al., "A new model for control of systems with friction", IEEE TAC 40(3), 1995:
//! `z' = v - sigma0 |v| z / g(v)` and `T = sigma0 z + sigma1 z' + sigma2 v`. Three changes:
//!
//! - `g(v) = Tc + (Ts - Tc) / (1 + (v/vs)^2)` (Hess and Soom, 1990) in place of the Gaussian: the same shape without
//!   an exponential, which would be a third of the cost of a step.
//! - `z' = k (z_ss - z)` with `k = sigma0 |v| / g` and `z_ss = sign(v) g / sigma0` is the same equation, written so
//!   that its stiff part can be limited: `k` never exceeds 2 / step. The bristle then still settles, within a step or
//!   two, on the very torque that it settles on in the exact model, and the integrator stays stable at any rate.
//! - `sigma1(v) = sigma1 / (1 + (sigma1 v / 2 Tc)^2)`: the bristles' damping fades, so that `sigma1(v) |v|` never exceeds Tc. With a
//!   constant sigma1 a quick reversal would find twice the Coulomb friction. With `s = sigma0 z / g` the dry part is
//!   `g s + sigma1 v (1 - s)`, which lies between `-g` and `g` for all `s` from -1 to 1 as soon as `sigma1 |v| <= g`.

use super::parameters::FrictionParameters;

/// Precomputed constants of one friction. A ring's are in N m and rad, a guide's in N and m.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    coulomb: f64,
    static_excess: f64,
    /// The static excess over Coulomb friction.
    excess_ratio: f64,
    inverse_stribeck: f64,
    stiffness: f64,
    bristle_damping: f64,
    /// sigma1 / 2 Tc: of the rate at which the bristles' damping has fallen to half.
    inverse_fading_rate: f64,
    viscous: f64,
}

/// Friction (it opposes the motion: subtract it) and rate of the bristle.
#[derive(Clone, Copy, Debug)]
pub struct FrictionState {
    /// What has to be overcome, N m or N.
    pub force: f64,
    /// Time derivative of the bristle deflection, rad/s or m/s.
    pub bristle_rate: f64,
}

impl Friction {
    /// Takes the constants, with what is switched off at zero.
    #[must_use]
    pub fn new(parameters: &FrictionParameters, is_dry: bool, is_viscous: bool) -> Self {
        let on = |flag: bool| if flag { 1.0 } else { 0.0 };
        let (dry, viscous) = (on(is_dry), on(is_viscous));
        Self {
            coulomb: parameters.coulomb * dry,
            static_excess: parameters.coulomb * (parameters.stiction_ratio - 1.0) * dry,
            excess_ratio: parameters.stiction_ratio - 1.0,
            inverse_stribeck: 1.0 / parameters.stribeck_rate,
            stiffness: parameters.coulomb / parameters.presliding * dry,
            bristle_damping: parameters.bristle_damping * dry,
            inverse_fading_rate: 0.5 * parameters.bristle_damping / parameters.coulomb,
            viscous: parameters.viscous * viscous,
        }
    }

    /// The same for a friction that grows with a load: what is dry of it without one may be switched off, and the bristles stay.
    #[must_use]
    pub fn with_loads(parameters: &FrictionParameters, is_dry: bool, is_viscous: bool) -> Self {
        let unloaded = Self::new(parameters, is_dry, is_viscous);
        Self {
            coulomb: unloaded.coulomb,
            static_excess: unloaded.static_excess,
            ..Self::new(parameters, true, is_viscous)
        }
    }

    /// Evaluates the model at a rate and a bristle deflection, for an integration step of `step_s`.
    #[must_use]
    pub fn evaluate(&self, rate: f64, bristle: f64, step_s: f64) -> FrictionState {
        let viscous = self.viscous * rate;
        if self.coulomb == 0.0 {
            return FrictionState {
                force: viscous,
                bristle_rate: 0.0,
            };
        }
        let bristle_rate = self.bristle_rate(rate, bristle, step_s);
        let fading = rate * self.inverse_fading_rate;
        let damping = self.bristle_damping / (1.0 + fading * fading);
        FrictionState {
            force: self.stiffness * bristle + damping * bristle_rate + viscous,
            bristle_rate,
        }
    }

    /// The same while a load adds `more` to the Coulomb friction, N m or N, and to the break-away by the same ratio.
    ///
    /// The bristles stay as stiff and bend further: under a load contacts yield further before they slip (Mindlin, 1949). Bristles
    /// that are bent beyond the break-away of a load that has fallen are felt no more than that, and slip with the motion. So no load,
    /// however it changes, puts energy into them.
    #[must_use]
    pub fn evaluate_under_load(
        &self,
        rate: f64,
        bristle: f64,
        step_s: f64,
        more: f64,
    ) -> FrictionState {
        if more == 0.0 {
            return self.evaluate(rate, bristle, step_s);
        }
        let coulomb = self.coulomb + more;
        let loaded = Self {
            coulomb,
            static_excess: coulomb * self.excess_ratio,
            ..*self
        };
        let bristle_rate = loaded.bristle_rate(rate, bristle, step_s);
        // sigma1(v) with the Coulomb friction of the load: it never exceeds that.
        let (fading, square) = (0.5 * self.bristle_damping * rate, coulomb * coulomb);
        let damping = self.bristle_damping * square / (square + fading * fading);
        let dry = self.stiffness * bristle + damping * bristle_rate;
        FrictionState {
            force: loaded.at_most_break_away(dry, rate) + self.viscous * rate,
            bristle_rate,
        }
    }

    /// Energy stored in the bristle, J.
    #[must_use]
    pub fn energy_j(&self, bristle: f64) -> f64 {
        0.5 * self.stiffness * bristle * bristle
    }

    /// No more than g(v) of what is dry.
    fn at_most_break_away(&self, dry: f64, rate: f64) -> f64 {
        let stribeck = rate * self.inverse_stribeck;
        // As a fraction: it rarely is more, and a division takes as long as all the rest.
        let denominator = 1.0 + stribeck * stribeck;
        let numerator = self.coulomb * denominator + self.static_excess;
        if dry.abs() * denominator <= numerator {
            return dry;
        }
        (numerator / denominator).copysign(dry)
    }

    fn bristle_rate(&self, rate: f64, bristle: f64, step_s: f64) -> f64 {
        let stribeck = rate * self.inverse_stribeck;
        // g(v) as a fraction, so that its reciprocal costs the only division.
        let denominator = 1.0 + stribeck * stribeck;
        let numerator = self.coulomb * denominator + self.static_excess;
        let scale = self.stiffness * denominator / numerator;
        let relaxation_1_s = scale * rate.abs();
        if relaxation_1_s * step_s <= 2.0 {
            // In this form the rate is smooth through zero, where the sign below is not defined.
            return rate - relaxation_1_s * bristle;
        }
        let settled = rate.signum() / scale;
        2.0 / step_s * (settled - bristle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::plant::PlantParameters;

    const STEP_S: f64 = 15e-6;

    fn ring() -> Friction {
        Friction::new(&PlantParameters::REFERENCE.ring_friction, true, true)
    }

    /// Lets the bristle run at a constant rate, with the plant's own integrator, and returns the friction torque.
    fn settle(friction: &Friction, rate_rad_s: f64, steps: u32) -> f64 {
        let slope = |bristle| friction.evaluate(rate_rad_s, bristle, STEP_S).bristle_rate;
        let mut bristle = 0.0;
        for _ in 0..steps {
            let first = slope(bristle);
            let second = slope(bristle + 0.5 * STEP_S * first);
            let third = slope(bristle + 0.5 * STEP_S * second);
            let fourth = slope(bristle + STEP_S * third);
            bristle += STEP_S / 6.0 * (first + 2.0 * (second + third) + fourth);
        }
        friction.evaluate(rate_rad_s, bristle, STEP_S).force
    }

    #[test]
    fn sliding_friction_is_coulomb_plus_viscous_at_any_rate() {
        let friction = ring();
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
        let friction = ring();
        let torque_n_m = settle(&friction, 1e-4, 1_000_000);
        assert!((torque_n_m - 0.12).abs() < 1e-4, "{torque_n_m}");
    }

    #[test]
    fn presliding_is_a_spring() {
        let friction = ring();
        let state = friction.evaluate(0.0, 50e-6, STEP_S);
        assert!((state.force - 0.05).abs() < 1e-12);
        assert_eq!(state.bristle_rate, 0.0);
    }

    fn with_loads() -> Friction {
        Friction::with_loads(&PlantParameters::REFERENCE.motor_friction, false, true)
    }

    /// A load that comes and goes with the motion, at any phase and at one, two or 2.7 times its frequency: what is dry stays within the
    /// break-away of the load that is there, it takes energy and never gives more than its bristles had, and it is the same mirrored.
    #[test]
    fn a_load_adds_friction_that_only_takes() {
        let friction = with_loads();
        let excess = PlantParameters::REFERENCE.motor_friction.stiction_ratio;
        let sine =
            |turns: f64| <f64 as kinematics::Scalar>::sin_cos(core::f64::consts::TAU * turns).0;
        let (mut felt_n_m, mut taken_j) = (0.0_f64, 0.0_f64);
        for (frequency_hz, rate_rad_s) in [(2.0, 1.0), (20.0, 0.03), (200.0, 0.2), (200.0, 2.0)] {
            for (times, phase) in [(1.0, 0.0), (1.0, 0.25), (1.0, 0.6), (2.0, 0.4), (2.7, 0.1)] {
                let (mut bristle, mut lost_j) = (0.0, 0.0_f64);
                for step in 0..(2.0 / frequency_hz / STEP_S) as u64 {
                    let turns = step as f64 * STEP_S * frequency_hz;
                    let rate = rate_rad_s * sine(turns);
                    let more_n_m = (0.8 * sine(times * turns + phase)).max(0.0);
                    let at = |bristle: f64| {
                        friction.evaluate_under_load(rate, bristle, STEP_S, more_n_m)
                    };
                    let state = at(bristle);
                    assert!(state.force.abs() <= excess * more_n_m * (1.0 + 1e-12));
                    let other = friction.evaluate_under_load(-rate, -bristle, STEP_S, more_n_m);
                    assert_eq!(state.force, -other.force);
                    assert_eq!(state.bristle_rate, -other.bristle_rate);
                    // By the middle of the step: then force times way is energy to the second order.
                    let middle = at(bristle + 0.5 * STEP_S * state.bristle_rate);
                    let before_j = friction.energy_j(bristle);
                    bristle += STEP_S * middle.bristle_rate;
                    let stored_j = friction.energy_j(bristle) - before_j;
                    lost_j += middle.force * rate * STEP_S - stored_j;
                    felt_n_m = felt_n_m.max(state.force.abs());
                    assert!(
                        middle.force * rate * STEP_S - stored_j > -LEAST_J,
                        "{frequency_hz} Hz, {times} at {phase}, step {step}"
                    );
                }
                taken_j = taken_j.max(lost_j);
            }
        }
        assert!(felt_n_m > 0.8 && taken_j > 0.1, "{felt_n_m} {taken_j}");
    }
    /// What a step of the test is off, J: of some microjoules.
    const LEAST_J: f64 = 1e-9;

    /// Bristles that a load has bent give nothing back when the next load finds them bent.
    #[test]
    fn a_load_that_comes_and_goes_pumps_nothing() {
        let friction = with_loads();
        let (mut bristle, mut given_j) = (0.0_f64, 0.0_f64);
        // Out without a load, back under one: what is felt is what was bent.
        for step in 0..4_000_u32 {
            let is_out = step % 100 < 50;
            let (rate, more_n_m) = if is_out { (0.02, 0.02) } else { (-0.02, 0.8) };
            let state = friction.evaluate_under_load(rate, bristle, STEP_S, more_n_m);
            bristle += STEP_S * state.bristle_rate;
            given_j -= state.force * rate * STEP_S;
            assert!(given_j < 1e-9, "{step}: {given_j:e}");
        }
    }

    #[test]
    fn a_load_that_is_nothing_changes_nothing() {
        let parameters = &PlantParameters::REFERENCE.motor_friction;
        let friction = Friction::with_loads(parameters, true, true);
        for rate in [-3.0, -0.2, -4e-3, 0.0, 1e-3, 0.05, 0.4] {
            for bristle in [-100e-6, -30e-6, 0.0, 90e-6] {
                let without = friction.evaluate(rate, bristle, STEP_S);
                let with = friction.evaluate_under_load(rate, bristle, STEP_S, 1e-12);
                assert!((with.force - without.force).abs() < 1e-9);
                assert!((with.bristle_rate - without.bristle_rate).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn sliding_under_a_load_takes_the_load_and_what_is_there_without() {
        let parameters = &PlantParameters::REFERENCE.motor_friction;
        for (is_dry, unloaded_n_m) in [(false, 0.0), (true, 0.2)] {
            let friction = Friction::with_loads(parameters, is_dry, true);
            for rate_rad_s in [0.5, 10.0] {
                let mut bristle = 0.0;
                for _ in 0..20_000 {
                    let state = friction.evaluate_under_load(rate_rad_s, bristle, STEP_S, 0.64);
                    bristle += STEP_S * state.bristle_rate;
                }
                let state = friction.evaluate_under_load(rate_rad_s, bristle, STEP_S, 0.64);
                let expected_n_m = unloaded_n_m + 0.64;
                assert!(
                    (state.force / expected_n_m - 1.0).abs() < 1e-4,
                    "{}",
                    state.force
                );
                let without = friction.evaluate_under_load(rate_rad_s, bristle, STEP_S, 0.0);
                assert_eq!(without.force == 0.0, !is_dry);
            }
        }
    }

    #[test]
    fn dry_friction_never_exceeds_the_break_away_torque() {
        let friction = ring();
        // Sways with 300 rad/s^2 at their ends, slow and quick, and one at the largest rate of a pivot.
        for frequency_hz in [0.5_f64, 2.0, 5.0, 20.0, 100.0, 500.0] {
            let omega_1_s = core::f64::consts::TAU * frequency_hz;
            let rate = |time_s: f64| {
                300.0 / omega_1_s * <f64 as kinematics::Scalar>::sin_cos(omega_1_s * time_s).0
            };
            let (mut bristle, mut worst_n_m) = (0.0, 0.0_f64);
            for step in 0..(2.0 / frequency_hz / STEP_S) as u64 {
                let time_s = step as f64 * STEP_S;
                let slope = |bristle, part| {
                    friction
                        .evaluate(rate(time_s + part * STEP_S), bristle, STEP_S)
                        .bristle_rate
                };
                let first = slope(bristle, 0.0);
                let second = slope(bristle + 0.5 * STEP_S * first, 0.5);
                let third = slope(bristle + 0.5 * STEP_S * second, 0.5);
                let fourth = slope(bristle + STEP_S * third, 1.0);
                bristle += STEP_S / 6.0 * (first + 2.0 * (second + third) + fourth);
                let rate = rate(time_s + STEP_S);
                let dry_n_m = friction.evaluate(rate, bristle, STEP_S).force - 0.05 * rate;
                worst_n_m = worst_n_m.max(dry_n_m.abs());
            }
            assert!(worst_n_m < 0.1201, "{frequency_hz} Hz: {worst_n_m} N m");
        }
    }
}
