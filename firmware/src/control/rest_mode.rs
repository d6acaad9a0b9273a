//! Rest mode: with the setpoint at rest the loop becomes slower, and with a push or a motion it is the full one again.
//!
//! At full stiffness the loop answers the noise of the encoders, and hunts: friction lets go in time, the motor then floats in the gap of
//! its transmission with a third of the inertia that the gains are for. A loop that is ten times as slow does neither. Velocity
//! gain and position gain fall to the share s, and the rate of the integral to 2 s.
//!
//! Friction goes on letting go for minutes, and the integral has to take the motor's torque along. It lags by what it is slow: the
//! stage walks by some 50 nrad of theta. So its rate rises to the full one as long as an error stays. Where none does, rate and gains
//! fall a little further: with the full rate the loop would hunt in a gap of 2 urad, where no torque holds the motor to one side.
//! The rate rises from its low end: on its way down from the full one it would hunt at once.
//!
//! Most of it lets go in the first second, and the more the encoders' noise shakes the motor the more. The full loop takes that along
//! at once, so the fall waits for [`CREEPING_S`], unless the full loop hunts.
//! Everything changes over many ticks: no step in duty.

use crate::parameters::Parameters;

/// Time at rest in which friction lets go fastest: where the loop does not hunt, it stays the full one for so long.
const CREEPING_S: f64 = 0.6;
/// Mean of the pivots' largest error, encoder counts, from which the full loop hunts. Encoder noise of 200 nrad makes 0.7, hunting in a
/// gap of 2 urad 1.5 to 3.
const HUNTING_COUNTS: f64 = 1.2;
const HUNTING_S: f64 = 0.05;
/// What counts of a larger error: that of the arrival is soon forgotten.
const MOST_HUNTING: f32 = 2.0;
/// Time constants with which the loop becomes slower, and, once it is slow, slower and faster by the errors that stay.
const SOFTENING_S: f64 = 0.2;
const SLACKENING_S: f64 = 0.2;
const QUICKENING_S: f64 = 0.5;
/// What is left of the gains at rest where no error lasts.
const SLACK: f64 = 0.5;
/// Share of the integral's rate at rest where no error lasts, over that of the gains.
const REST_INTEGRAL: f64 = 2.0;
/// Error that lasts for about this time, encoder counts.
const LASTING_COUNTS: f64 = 0.15;
const LASTING_S: f64 = 0.2;
/// Time in which it is the full one again.
const STIFFENING_S: f64 = 5e-4;
/// Mean error that counts as rest, of the one that wakes: a push that lasts does not send the loop to and fro.
const QUIET_SHARE: f64 = 0.5;
/// For this, over a longer mean: the full loop's hunting, 300 to 700 Hz, is no push.
const SMOOTHING_S: f64 = 0.01;
/// While the loop becomes slow it may still hunt: a push is what is so much larger.
const WAKE_WHILE_SOFTENING: f64 = 5.0;
/// Units of an encoder count.
pub(super) const UNITS_PER_COUNT: f64 = 64.0;

/// Constants of rest mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestModeConfig {
    /// Ticks at rest before the fall where the loop hunts or is falling already, and where it is the full one.
    delay_ticks: [u32; 2],
    /// Mean of the largest error that is hunting.
    hunting_sum: f32,
    hunting_smoothing: f32,
    /// Sums of errors over the settling mean, 2^-32 turns: those that wake while the loop is not quite slow and when it is, and
    /// that which keeps it from becoming slow.
    wake_sums: [u32; 2],
    quiet_sum: f32,
    /// Share of the way to a new sum that the smoothed one goes in a tick.
    smoothing: f32,
    /// Shares at rest, and what is left of them after a tick.
    stiffness: f32,
    slack_stiffness: f32,
    softening: f32,
    integral_softening: f32,
    /// Share of the integral's rate where no error lasts.
    rest_integral_rate: f32,
    /// What becomes of the shares in a tick where an error lasts, and where none does; and what an error is that lasts.
    quickening: f32,
    slackening: f32,
    lasting_sum: f32,
    lasting_smoothing: f32,
    /// What of full shares comes back in a tick.
    stiffening: f32,
}

impl RestModeConfig {
    /// Derives the constants; the mean is over so many ticks.
    pub fn new(parameters: &Parameters, mean_ticks: usize) -> Self {
        let rate_hz = parameters.limits.rate_hz;
        let rest = &parameters.servo.rest;
        let wake_sum = rest.wake_counts * UNITS_PER_COUNT * mean_ticks as f64;
        let decay = |time_s: f64| libm::exp(-1.0 / (time_s * rate_hz)) as f32;
        Self {
            delay_ticks: [rest.delay_s, rest.delay_s.max(CREEPING_S)]
                .map(|delay_s| libm::ceil(delay_s * rate_hz) as u32),
            hunting_sum: (HUNTING_COUNTS * UNITS_PER_COUNT * mean_ticks as f64) as f32,
            wake_sums: [WAKE_WHILE_SOFTENING * wake_sum, wake_sum].map(|sum| sum as u32),
            quiet_sum: (wake_sum * QUIET_SHARE) as f32,
            smoothing: (1.0 / (SMOOTHING_S * rate_hz)) as f32,
            hunting_smoothing: (1.0 / (HUNTING_S * rate_hz)) as f32,
            stiffness: rest.stiffness as f32,
            slack_stiffness: if rest.stiffness < 1.0 {
                (SLACK * rest.stiffness) as f32
            } else {
                1.0
            },
            softening: decay(SOFTENING_S),
            integral_softening: decay(2.0 * SOFTENING_S),
            rest_integral_rate: (REST_INTEGRAL * rest.stiffness).min(1.0) as f32,
            quickening: 1.0 / decay(QUICKENING_S),
            slackening: decay(SLACKENING_S),
            lasting_sum: (LASTING_COUNTS * UNITS_PER_COUNT * mean_ticks as f64) as f32,
            lasting_smoothing: (1.0 / (LASTING_S * rate_hz)) as f32,
            stiffening: (1.0 / (STIFFENING_S * rate_hz)) as f32,
        }
    }
}

/// What is in force of the gains in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Share of velocity gain and position gain, 0 to 1.
    pub gains: f32,
    /// Share of the integral's rate.
    pub integral_rate: f32,
}

impl Stiffness {
    /// The full loop.
    pub const FULL: Self = Self {
        gains: 1.0,
        integral_rate: 1.0,
    };
}

impl Default for Stiffness {
    fn default() -> Self {
        Self::FULL
    }
}

/// State of rest mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestMode {
    /// Sums of the pivots' errors over the settling mean, smoothed, and smoothed for longer.
    slow_sums: [f32; 3],
    lasting_sums: [f32; 3],
    /// The largest of their magnitudes, smoothed.
    largest_sum: f32,
    quiet_ticks: u32,
    /// A push has woken the loop: on its way to the full one.
    woken: bool,
    stiffness: Stiffness,
}

impl RestMode {
    /// What is in force of the gains in this tick. Takes the sums of the following errors over the settling mean, 2^-32
    /// turns.
    #[inline]
    pub fn update(&mut self, config: &RestModeConfig, moving: bool, sums: &[i32; 3]) -> Stiffness {
        if moving {
            (self.slow_sums, self.lasting_sums) = ([0.0; 3], [0.0; 3]);
            self.largest_sum = 0.0;
            self.stiffen(config);
            return self.stiffness;
        }
        let (mut fast, mut slow, mut lasting) = (0, 0.0_f32, 0.0_f32);
        let smoothed = self.slow_sums.iter_mut().zip(&mut self.lasting_sums);
        for ((slow_sum, lasting_sum), &sum) in smoothed.zip(sums) {
            *slow_sum += (sum as f32 - *slow_sum) * config.smoothing;
            *lasting_sum += (*slow_sum - *lasting_sum) * config.lasting_smoothing;
            slow = larger(slow, slow_sum.abs());
            lasting = larger(lasting, lasting_sum.abs());
            fast = sum.unsigned_abs().max(fast);
        }
        let is_soft = self.stiffness.gains <= config.stiffness;
        let bounded = smaller(fast as f32, MOST_HUNTING * config.hunting_sum);
        self.largest_sum += (bounded - self.largest_sum) * config.hunting_smoothing;
        let waits = self.largest_sum <= config.hunting_sum && self.stiffness.gains >= 1.0;
        // What has begun is finished: on its way the loop counts as not quite slow, and would ask for a larger push.
        self.woken |= fast > config.wake_sums[usize::from(is_soft)];
        if self.woken {
            self.stiffen(config);
        } else if slow > config.quiet_sum {
            self.quiet_ticks = 0;
        } else if self.quiet_ticks < config.delay_ticks[usize::from(waits)] {
            self.quiet_ticks += 1;
        } else {
            self.soften(config, lasting > config.lasting_sum);
        }
        self.stiffness
    }

    fn soften(&mut self, config: &RestModeConfig, lasts: bool) {
        let Stiffness {
            gains,
            integral_rate,
        } = &mut self.stiffness;
        if *gains > config.stiffness {
            *gains = larger(*gains * config.softening, config.stiffness);
            *integral_rate = larger(
                *integral_rate * config.integral_softening,
                config.rest_integral_rate,
            );
        } else if lasts {
            *gains = smaller(*gains * config.quickening, config.stiffness);
            *integral_rate = smaller(*integral_rate * config.quickening, 1.0);
        } else {
            *gains = larger(*gains * config.slackening, config.slack_stiffness);
            *integral_rate = larger(
                *integral_rate * config.slackening,
                config.rest_integral_rate,
            );
        }
    }

    fn stiffen(&mut self, config: &RestModeConfig) {
        self.quiet_ticks = 0;
        let Stiffness {
            gains,
            integral_rate,
        } = &mut self.stiffness;
        *gains = smaller(*gains + config.stiffening, 1.0);
        *integral_rate = smaller(*integral_rate + config.stiffening, 1.0);
        self.woken &= *gains < 1.0 || *integral_rate < 1.0;
    }

    /// The full loop, from now on.
    pub fn restart(&mut self) {
        *self = Self::default();
    }
}

// `f32::max` and `min` are calls of a function on the chip, for what they make of a NaN.

#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

#[inline]
fn smaller(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEAN_TICKS: usize = 20;
    const TICKS_A_SECOND: usize = 20_000;
    const MILLISECOND: usize = 20;

    fn update(
        state: &mut RestMode,
        config: &RestModeConfig,
        moving: bool,
        counts: f64,
    ) -> Stiffness {
        let sum = (counts * UNITS_PER_COUNT * MEAN_TICKS as f64) as i32;
        state.update(config, moving, &[0, sum, 0])
    }

    /// The shares after ten seconds at rest, and the largest change of one from tick to tick on the way.
    fn rested(config: &RestModeConfig) -> (RestMode, f32) {
        let (mut state, mut last, mut step) = (RestMode::default(), Stiffness::FULL, 0.0_f32);
        for _ in 0..10 * TICKS_A_SECOND {
            let now = update(&mut state, config, false, 0.0);
            step = larger(step, (now.gains - last.gains).abs());
            step = larger(step, (now.integral_rate - last.integral_rate).abs());
            last = now;
        }
        (state, step)
    }

    /// A small push, one so large that it would be one while the loop is on its way too, or a motion: the full loop within a
    /// millisecond, a tenth of it in a tick at most.
    #[test]
    fn a_push_and_a_motion_bring_the_full_loop_back_within_a_millisecond() {
        let parameters = Parameters::REFERENCE;
        let config = RestModeConfig::new(&parameters, MEAN_TICKS);
        for (moving, counts) in [
            (
                false,
                WAKE_WHILE_SOFTENING * parameters.servo.rest.wake_counts + 1.0,
            ),
            (false, parameters.servo.rest.wake_counts + 1.0),
            (true, 0.0),
        ] {
            let (mut state, step) = rested(&config);
            // Slowly: a thousandth of the full gains in a tick.
            assert!(step < 1e-3, "{step}");
            let mut last = state.stiffness;
            assert!(last.gains < 0.11 && last.integral_rate < 0.21, "{last:?}");
            let ticks = (1..).take(1_000).find(|_| {
                let now = update(&mut state, &config, moving, counts);
                assert!(now.gains - last.gains < 0.101 && now.gains >= last.gains);
                last = now;
                now == Stiffness::FULL
            });
            assert!(
                ticks.is_some_and(|ticks| ticks <= MILLISECOND),
                "{moving}: {ticks:?}, {last:?}"
            );
        }
        // Less than a push: nothing comes back.
        let (mut state, _) = rested(&config);
        for _ in 0..MILLISECOND {
            update(
                &mut state,
                &config,
                false,
                parameters.servo.rest.wake_counts - 1.0,
            );
        }
        assert!(state.stiffness.gains < 0.11);
    }

    /// While friction lets go and the integral lags behind it, its rate is the full one, though the gains stay low; without an
    /// error it is not, and does not get there on its way down from the full loop either.
    #[test]
    fn an_error_that_lasts_brings_the_rate_of_the_integral_back() {
        let parameters = Parameters::REFERENCE;
        let config = RestModeConfig::new(&parameters, MEAN_TICKS);
        let low = (REST_INTEGRAL * parameters.servo.rest.stiffness) as f32;
        let (mut state, _) = rested(&config);
        assert_eq!(state.stiffness.integral_rate, low);
        for (counts, rate) in [(0.2, 1.0), (0.1, low), (-0.2, 1.0), (0.0, low)] {
            for _ in 0..4 * TICKS_A_SECOND {
                let now = update(&mut state, &config, false, counts);
                assert!(now.gains <= parameters.servo.rest.stiffness as f32);
            }
            assert_eq!(state.stiffness.integral_rate, rate, "{counts}");
        }
    }

    /// Friction lets go fastest in the first second, and the full loop follows that best; one that hunts falls as soon as it may.
    #[test]
    fn the_full_loop_stays_while_friction_lets_go_unless_it_hunts() {
        let parameters = Parameters::REFERENCE;
        let config = RestModeConfig::new(&parameters, MEAN_TICKS);
        // What the mean has of 500 Hz, and of an arrival 10 ms long that is 100 counts off.
        for (amplitude, arrival, from_s, to_s) in [
            (2.5, 0.0, parameters.servo.rest.delay_s, 0.079),
            (1.0, 0.0, CREEPING_S, CREEPING_S + 0.01),
            (1.0, 100.0, CREEPING_S, CREEPING_S + 0.045),
        ] {
            let mut state = RestMode::default();
            let falls = (0..TICKS_A_SECOND).find(|&tick| {
                let hunting = amplitude * libm::sin(tick as f64 * core::f64::consts::TAU / 40.0);
                let counts = if tick < 10 * MILLISECOND {
                    arrival
                } else {
                    0.0
                } + hunting;
                update(&mut state, &config, false, counts).gains < 1.0
            });
            let falls_s = falls.map(|tick| tick as f64 / TICKS_A_SECOND as f64);
            assert!(
                falls_s.is_some_and(|falls_s| (from_s..to_s).contains(&falls_s)),
                "{amplitude}, {arrival}: {falls_s:?}"
            );
        }
    }
}
