//! What the controller's 12 bit ADC (3.3 V) reads of the bridges.

use firmware::drivers::power_stage::{BUS, CURRENT_SENSOR};
use serde::{Deserialize, Serialize};

use crate::machine::plant::AXES;
use crate::random::Random;

/// Largest count.
pub const FULL_SCALE_COUNTS: u16 = 4095;

/// Volts at the input for each ampere of motor current: a shunt of 10 mohm and an amplifier of 20, which see the current with its
/// sign in every state of the bridge. Full scale is +-8.25 A.
pub const CURRENT_V_A: f64 = CURRENT_SENSOR.shunt_ohm * CURRENT_SENSOR.gain;
/// Volts at the input at no current.
pub const CURRENT_ZERO_V: f64 = CURRENT_SENSOR.zero_v;

/// Volts at the input for each volt of supply: 19 kohm over 1 kohm. Full scale is 66 V.
pub const SUPPLY_V_V: f64 = 1.0 / BUS.divider;

const REFERENCE_V: f64 = 3.3;

const SAMPLED_S: [f64; AXES] = [5.3e-6, 7.2e-6, 9.1e-6];

/// What the analog inputs are off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnalogParameters {
    /// Standard deviation of a sample, counts.
    pub noise_counts: f64,
    /// What the current inputs read at no current, counts.
    pub current_offset_counts: [f64; AXES],
    /// What the current inputs read over what flows.
    pub current_gain: [f64; AXES],
    /// The same of the supply.
    pub supply_gain: f64,
    /// When each current is sampled, s after the beginning of a period of the PWM. It decides what of the ripple a sample has.
    pub current_sampled_s: [f64; AXES],
}

impl AnalogParameters {
    /// What a 12 bit converter beside switching bridges has for noise; offsets of some 10 mA from amplifier and reference, gains within
    /// 1 % from shunts; a divider of 1 % resistors. The currents are sampled one after the other, 1.9 us apart, from the latch on, which comes
    /// 3 us after a period's beginning (`firmware/src/bin/stage/timeline.rs`); 1 us of interrupt and 1.3 us of sampling go before.
    pub const REFERENCE: Self = Self {
        noise_counts: 1.5,
        current_offset_counts: [3.0, -2.0, 4.0],
        current_gain: [1.01, 0.99, 1.004],
        supply_gain: 0.995,
        current_sampled_s: SAMPLED_S,
    };

    /// Without errors.
    pub const EXACT: Self = Self {
        noise_counts: 0.0,
        current_offset_counts: [0.0; AXES],
        current_gain: [1.0; AXES],
        supply_gain: 1.0,
        current_sampled_s: SAMPLED_S,
    };

    /// Counts of the motor currents and of the supply, in a sample with a number of its own: the same number, the same noise.
    #[must_use]
    pub fn sample(
        &self,
        currents_a: [f64; AXES],
        supply_v: f64,
        number: u64,
    ) -> ([u16; AXES], u16) {
        let mut random = Random::new(number);
        let mut noise = || {
            if self.noise_counts == 0.0 {
                0.0
            } else {
                self.noise_counts * random.normal()
            }
        };
        let currents = [0, 1, 2].map(|axis| {
            let input_v = CURRENT_ZERO_V + currents_a[axis] * CURRENT_V_A * self.current_gain[axis];
            counts(input_v, self.current_offset_counts[axis] + noise())
        });
        let supply = counts(supply_v * SUPPLY_V_V * self.supply_gain, noise());
        (currents, supply)
    }
}

fn counts(input_v: f64, more_counts: f64) -> u16 {
    let scaled = input_v / REFERENCE_V * f64::from(FULL_SCALE_COUNTS + 1) + more_counts;
    // The cast saturates, and takes NaN for zero.
    (scaled.round() as u16).min(FULL_SCALE_COUNTS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_scale_and_saturate() {
        let exact = |currents_a, supply_v| AnalogParameters::EXACT.sample(currents_a, supply_v, 0);
        let full = FULL_SCALE_COUNTS;
        assert_eq!(exact([-1.0, 22.9, 0.0], 48.0), ([1800, full, 2048], 2979));
        assert_eq!(exact([-22.9; AXES], -1.0), ([0; AXES], 0));
    }

    #[test]
    fn errors_are_as_large_as_they_are_said_to_be() {
        let parameters = AnalogParameters::REFERENCE;
        let samples = 20_000_u32;
        let (mut mean, mut square) = (0.0, 0.0);
        for number in 0..samples {
            let ([_, counts, _], _) = parameters.sample([0.0, 2.0, 0.0], 48.0, u64::from(number));
            mean += f64::from(counts) / f64::from(samples);
            square += f64::from(counts).powi(2) / f64::from(samples);
        }
        let expected = (1.65 + 2.0 * CURRENT_V_A * 0.99) / REFERENCE_V * 4096.0 - 2.0;
        assert!((mean - expected).abs() < 0.05, "{mean} {expected}");
        let deviation = (square - mean * mean).sqrt();
        // A count's own rounding adds its twelfth.
        let with_rounding = (1.5_f64.powi(2) + 1.0 / 12.0).sqrt();
        assert!(
            (deviation / with_rounding - 1.0).abs() < 0.03,
            "{deviation}"
        );
    }
}
