//! When what is broken passes the controller's thresholds: judged from the machine and its encoders, in other numbers than the
//! controller's.

use super::injection::{HEARTBEAT_TICKS, MISSED_EVERY, second};
use super::scenario::Scenario;
use super::truth::{setpoint_turns, shown_errors_rad};
use crate::machine::devices::Encoder;
use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::plant::AXES;
use core::f64::consts::TAU;
use firmware::control::units::CURRENT_A_PER_COUNT;
use firmware::motion::Position;
use firmware::parameters::Parameters;

/// Ticks in a row in which a low supply is one.
const LOW_SUPPLY_TICKS: u64 = 4;
/// Ticks of one reading, after which it is asked whether there should have been others.
const SAME_TICKS: u64 = 20;
/// Rate from which on a reading may stay the same for as long as frames are bridged only, rad/s: 0.03 of what the encoder has
/// shown last, which need not be the setpoint's.
const MOVING_RAD_S: f64 = 0.01;
/// Ticks from one look at a pivot to the next: longer than that over a threshold, and it has been looked at.
const LOOK_TICKS: u64 = 4;
/// Share of a motor's largest current from which it is held at its limit for certain, and from which it may be.
const LIMITED: f64 = 0.995;
const NEARLY_LIMITED: f64 = 0.9;
/// What the heat may be under its threshold for one who sees every fourth sample of the current.
const NEARLY: f64 = 0.99;
/// Largest duty, as a share of the PWM's counts.
const FULL: f64 = 0.98;

/// What passes a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// In the tick that first sees it.
    AtOnce,
    /// One bad frame more than are bridged.
    BadFrames,
    /// A low supply, seen often enough.
    LowSupply,
    /// One late tick more than are forgiven.
    LateTicks,
    /// What the encoders show is too far from the setpoint.
    FollowingError,
    /// The setpoint of the pivot has gone further than a reading may stay the same.
    FrozenWay,
    /// A reading has stayed the same for as long as it may.
    Still,
    /// A pivot is too fast, for as long as it takes to be looked at.
    Overspeed,
    /// The same for a tick, in which it may be looked at.
    BrieflyOverspeed,
    /// A bridge has been at its largest duty for too long.
    AtEnd,
    /// The same, but for pauses too short to be looked at for sure.
    NearlyAtEnd,
    /// A motor has carried too much current for too long.
    Hot,
    /// The same, but for what a third of the samples tells.
    NearlyHot,
    /// Nothing has been heard for as long as the host has promised.
    Silence,
}

/// What there is to see in a tick.
pub struct Now<'a> {
    /// The encoders, and the motors' currents (ADC counts), as the tick has read them.
    pub shown: &'a [Encoder; AXES],
    /// See `shown`.
    pub current_counts: [i16; AXES],
    /// What the tick has computed: the platform's setpoint, the rates of the pivots' setpoints, the duties.
    pub position: Position,
    /// See `position`.
    pub rates_rad_s: [f32; AXES],
    /// See `position`; PWM counts.
    pub duty: [i16; AXES],
    /// The tick in which the host was heard last.
    pub heard: u64,
}

/// Follows a run, and knows for how long each pivot has done what it should not.
pub struct Effects<'a> {
    parameters: &'a Parameters,
    /// Setpoint of the pivot when it broke, turns.
    broke_at: Option<f64>,
    position: Position,
    last: [u32; AXES],
    same: [u64; AXES],
    fast: [u64; AXES],
    at_end: [u64; AXES],
    /// The same with short pauses, and ticks of the pause.
    nearly: [u64; AXES],
    pause: [u64; AXES],
    /// Squares of the currents, A^2, smoothed.
    heat: [f64; AXES],
}

impl<'a> Effects<'a> {
    /// At the beginning of a run.
    #[must_use]
    pub const fn new(parameters: &'a Parameters) -> Self {
        Self {
            parameters,
            broke_at: None,
            position: [0; 3],
            last: [0; AXES],
            same: [0; AXES],
            fast: [0; AXES],
            at_end: [0; AXES],
            nearly: [0; AXES],
            pause: [0; AXES],
            heat: [0.0; AXES],
        }
    }

    /// Takes a tick.
    pub fn look(&mut self, now: &Now<'_>) {
        self.position = now.position;
        let supervision = &self.parameters.supervision;
        let rate_hz = self.parameters.limits.rate_hz;
        let fastest_rad_s = self.parameters.limits.pivot_rate_rad_s * supervision.overspeed_factor;
        let most_counts = fastest_rad_s / rate_hz / TAU * f64::from(COUNTS_PER_TURN);
        let full = FULL * f64::from(self.parameters.power.pwm_counts);
        let part = 1.0 - (-1.0 / (rate_hz * supervision.motor_heating_s)).exp();
        for i in 0..AXES {
            let counts = now.shown[i].position();
            let half = COUNTS_PER_TURN / 2;
            let step = (counts.wrapping_sub(self.last[i]).wrapping_add(half) % COUNTS_PER_TURN)
                .abs_diff(half);
            self.last[i] = counts;
            let goes_on = |so_far: u64, holds: bool| if holds { so_far + 1 } else { 0 };
            self.same[i] = goes_on(self.same[i], step == 0);
            self.fast[i] = goes_on(self.fast[i], f64::from(step) > most_counts);
            let duty = f64::from(now.duty[i]).abs();
            let current_a = f64::from(now.current_counts[i]) * CURRENT_A_PER_COUNT;
            let most_a = self.parameters.power.current_limit_a;
            let is_limited = |share: f64| current_a.abs() >= share * most_a;
            self.at_end[i] = goes_on(self.at_end[i], duty >= full - 0.5 || is_limited(LIMITED));
            let pauses = duty < full - 1.0 && !is_limited(NEARLY_LIMITED);
            self.pause[i] = goes_on(self.pause[i], pauses);
            self.nearly[i] = goes_on(self.nearly[i], self.pause[i] < LOOK_TICKS);
            self.heat[i] += (current_a * current_a - self.heat[i]) * part;
        }
    }

    /// Whether an effect has passed its threshold, in the tick that was looked at last.
    pub fn has(&mut self, effect: Effect, tick: u64, scenario: &Scenario, now: &Now<'_>) -> bool {
        let supervision = &self.parameters.supervision;
        let bridged = u64::from(supervision.bridged_frames);
        let longest = (supervision.max_saturation_s * self.parameters.limits.rate_hz) as u64;
        let bearable = supervision.motor_current_a * supervision.motor_current_a;
        let first = scenario.at + u64::from(scenario.injection.is_of_encoder());
        match effect {
            Effect::AtOnce => tick >= first,
            Effect::BadFrames => tick >= first + bridged,
            Effect::LowSupply => tick >= first + LOW_SUPPLY_TICKS - 1,
            Effect::LateTicks => tick >= first + MISSED_EVERY * u64::from(supervision.late_ticks),
            Effect::FollowingError => {
                let errors = shown_errors_rad(now.shown, self.parameters, now.position);
                (errors.iter().zip(now.rates_rad_s)).any(|(error, rate_rad_s)| {
                    let lag_rad = supervision.following_error_s * f64::from(rate_rad_s.abs());
                    *error > supervision.following_error_rad + lag_rad
                })
            }
            Effect::FrozenWay => {
                let turns = setpoint_turns(now.position)[scenario.axis];
                let way = turns - *self.broke_at.get_or_insert(turns);
                (way - way.round()).abs() * TAU > supervision.frozen_rad
            }
            Effect::Still => (0..AXES).any(|i| {
                let is_moving = f64::from(now.rates_rad_s[i].abs()) > MOVING_RAD_S;
                self.same[i] >= SAME_TICKS || (is_moving && self.same[i] >= bridged)
            }),
            Effect::Overspeed => self.fast.iter().any(|&ticks| ticks >= LOOK_TICKS),
            Effect::BrieflyOverspeed => self.fast.iter().any(|&ticks| ticks > 0),
            Effect::AtEnd => self.at_end.iter().any(|&ticks| ticks > longest),
            Effect::NearlyAtEnd => self.nearly.iter().any(|&ticks| ticks > longest),
            Effect::Hot => self.heat.iter().any(|&heat| heat > bearable),
            Effect::NearlyHot => self.heat.iter().any(|&heat| heat > NEARLY * bearable),
            Effect::Silence => tick > now.heard + HEARTBEAT_TICKS,
        }
    }

    /// The platform's setpoint in the last tick, track radii.
    pub fn position(&self) -> [f64; 2] {
        [0, 1].map(|i| self.position[i] as f64 / 4_294_967_296.0)
    }

    /// The tick in which the second of two lost encoders is found.
    #[must_use]
    pub fn second_found(&self, scenario: &Scenario) -> Option<(u64, usize)> {
        let super::Injection::TwoEncoders(ticks) = scenario.injection else {
            return None;
        };
        let bridged = u64::from(self.parameters.supervision.bridged_frames);
        let tick = scenario.at + u64::from(ticks) + 1 + bridged;
        Some((tick, second(scenario.axis)))
    }
}
