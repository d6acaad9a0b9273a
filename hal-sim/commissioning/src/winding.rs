//! Resistance and inductance of a winding from short pulses, and whether current and encoder answer as they should.
//!
//! `L i' = u - R i - K w - d f(i)` is integrated through the pulses with the rate w that the encoder shows and the voltage that the bridge was told,
//! d being what its dead time takes, f the current over its knee, cut at 1. The four numbers and an offset are those with which the
//! computed current is nearest to the measured one. Pulses of two sizes and both signs tell d from R. The ring hardly moves: K stays what
//! it was thought to be unless the pulses say otherwise.

use crate::dead_time::dead_time_share;
use crate::least_squares::minimise;
use crate::record::{Signals, Timing};
use nalgebra::DVector;

/// What is thought of a winding before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindingGuess {
    /// ohm.
    pub resistance_ohm: f64,
    /// H.
    pub inductance_h: f64,
    /// Back-EMF for each rad/s of the ring, V s/rad.
    pub motor_constant: f64,
    /// Dead time's share of the supply, V.
    pub dead_time_v: f64,
    /// Current from which the whole dead time counts, A.
    pub knee_a: f64,
}

/// A winding as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    /// ohm.
    pub resistance_ohm: f64,
    /// H.
    pub inductance_h: f64,
    /// What the dead time takes, V.
    pub dead_time_v: f64,
    /// Of resistance, inductance and dead time: standard deviations.
    pub deviations: [f64; 3],
    /// Whether the ring of this encoder turned the way of the volts (1), against it (-1), or did not turn (0).
    pub sense: i8,
}

/// Why a winding is not as it should be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WindingError {
    /// Signals of different lengths, or none.
    #[error("volts, current and angle of a pulse are not as long as each other, or there are none")]
    Lengths,
    /// No volts.
    #[error("no pulse in the record: its volts never pass {LEAST_V} V")]
    NoPulse,
    /// No current.
    #[error(
        "{volts} V drive no current: a wire or the winding is open, a plug is out, or the bridge sleeps"
    )]
    Open {
        /// Largest voltage.
        volts: f64,
    },
    /// Much current, or no rise.
    #[error("{resistance_ohm:.2} ohm: the winding or its wires are shorted")]
    Short {
        /// As found.
        resistance_ohm: f64,
    },
    /// Current against the voltage.
    #[error("the current is against the voltage: its sensor or the bridge's direction is reversed")]
    Reversed,
    /// A resistance that is not what the parameter says.
    #[error(
        "{resistance_ohm:.2} ohm is not within a factor of two of what was expected: another motor, or a bad contact"
    )]
    Unexpected {
        /// As found.
        resistance_ohm: f64,
    },
    /// No fit.
    #[error("the current does not rise as that of a winding does")]
    NoFit,
}

const LEAST_V: f64 = 0.5;
/// Currents under this share of what was expected are none.
const OPEN: f64 = 0.1;
/// A resistance under this share of what was expected is a short.
const SHORT: f64 = 0.25;
/// What the dead time may be off, V, and the others, as a logarithm, before anything is measured.
const DEAD_TIME_SPREAD_V: f64 = 0.3;
const SPREADS: [f64; 3] = [2.0, 2.0, 0.4];
/// Noise of a current sample, A: what known things are weighed against.
const NOISE_A: f64 = 6e-3;
/// Steps of the integration in a tick, and way of a ring that is a motion, rad.
const STEPS: usize = 10;
const LEAST_WAY_RAD: f64 = 5e-6;

/// The winding of a drive from pulses (each with some ticks before and after) of two sizes and both signs.
///
/// # Errors
/// [`WindingError`].
pub fn winding(
    pulses: &[Signals],
    timing: &Timing,
    guess: &WindingGuess,
) -> Result<Winding, WindingError> {
    if pulses.is_empty()
        || pulses
            .iter()
            .any(|pulse| pulse.ticks().is_none_or(|ticks| ticks < 3))
    {
        return Err(WindingError::Lengths);
    }
    let most = |values: &dyn Fn(&Signals) -> f64| pulses.iter().map(values).fold(0.0, f64::max);
    let volts = most(&|pulse| largest(&pulse.volts));
    if volts < LEAST_V {
        return Err(WindingError::NoPulse);
    }
    let expected_a = (volts - guess.dead_time_v).max(0.1) / guess.resistance_ohm;
    if most(&|pulse| largest(&pulse.current_a)) < OPEN * expected_a {
        return Err(WindingError::Open { volts });
    }
    let along: f64 = pulses
        .iter()
        .flat_map(|pulse| pulse.volts.iter().zip(&pulse.current_a))
        .map(|(u, i)| u * i)
        .sum();
    if along < 0.0 {
        return Err(WindingError::Reversed);
    }
    let residuals = |unknowns: &DVector<f64>| residuals(unknowns, pulses, timing, guess);
    let found = minimise(&DVector::zeros(5), 40, residuals).ok_or(WindingError::NoFit)?;
    let [r, l, _, d, _] = std::array::from_fn(|k| found.at[k]);
    let (resistance_ohm, inductance_h) =
        (guess.resistance_ohm * r.exp(), guess.inductance_h * l.exp());
    if resistance_ohm < SHORT * guess.resistance_ohm {
        return Err(WindingError::Short { resistance_ohm });
    }
    if (resistance_ohm / guess.resistance_ohm).ln().abs() > std::f64::consts::LN_2 {
        return Err(WindingError::Unexpected { resistance_ohm });
    }
    let deviation = |k: usize| found.covariance[(k, k)].max(0.0).sqrt();
    Ok(Winding {
        resistance_ohm,
        inductance_h,
        dead_time_v: guess.dead_time_v + d,
        deviations: [
            resistance_ohm * deviation(0),
            inductance_h * deviation(1),
            deviation(3),
        ],
        sense: sense(pulses),
    })
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Which way the ring went while the voltage was on.
fn sense(pulses: &[Signals]) -> i8 {
    let mut way = 0.0;
    for pulse in pulses {
        for (angles, volts) in pulse.angle_rad.windows(2).zip(&pulse.volts) {
            way += (angles[1] - angles[0]) * volts.signum() * f64::from(volts.abs() > LEAST_V);
        }
    }
    let way = way / pulses.len() as f64;
    if way.abs() < LEAST_WAY_RAD {
        0
    } else {
        way.signum() as i8
    }
}

/// Logarithms of resistance, inductance and motor constant over the guess; dead time over the guess, V; offset of the current, A.
fn residuals(
    unknowns: &DVector<f64>,
    pulses: &[Signals],
    timing: &Timing,
    guess: &WindingGuess,
) -> DVector<f64> {
    let [r, l, k, d, offset] = std::array::from_fn(|place| unknowns[place]);
    let numbers = WindingGuess {
        resistance_ohm: guess.resistance_ohm * r.exp(),
        inductance_h: guess.inductance_h * l.exp(),
        motor_constant: guess.motor_constant * k.exp(),
        dead_time_v: guess.dead_time_v + d,
        knee_a: guess.knee_a,
    };
    let mut all = Vec::new();
    for pulse in pulses {
        let computed = currents(pulse, timing, &numbers);
        all.extend(
            pulse
                .current_a
                .iter()
                .zip(computed)
                .map(|(measured, computed)| (measured - computed - offset) / NOISE_A),
        );
    }
    all.extend([
        r / SPREADS[0],
        l / SPREADS[1],
        k / SPREADS[2],
        d / DEAD_TIME_SPREAD_V,
    ]);
    DVector::from_vec(all)
}

/// The current at each sample, from none at the first.
fn currents(pulse: &Signals, timing: &Timing, numbers: &WindingGuess) -> Vec<f64> {
    let (mut current, mut all) = (0.0, Vec::with_capacity(pulse.volts.len()));
    let step_s = timing.tick_s / STEPS as f64;
    let last = pulse.volts.len() - 1;
    // A sample's age is counted into when the voltage changes: both are relative.
    let change_s = timing.duty_s - timing.current_s;
    for tick in 0..=last {
        all.push(current);
        let [before, now] = [tick.saturating_sub(1), tick].map(|tick| pulse.volts[tick]);
        let rate = (pulse.angle_rad[(tick + 1).min(last)] - pulse.angle_rad[tick]) / timing.tick_s;
        for step in 0..STEPS {
            // What of the step is before the change.
            let old = ((change_s - step as f64 * step_s) / step_s).clamp(0.0, 1.0);
            let volts = old * before + (1.0 - old) * now;
            let slope = |current: f64| {
                let lost =
                    numbers.dead_time_v.min(volts.abs()) * dead_time_share(current, numbers.knee_a);
                (volts - numbers.resistance_ohm * current - numbers.motor_constant * rate - lost)
                    / numbers.inductance_h
            };
            let halfway = current + 0.5 * step_s * slope(current);
            current += step_s * slope(halfway);
        }
    }
    all
}
