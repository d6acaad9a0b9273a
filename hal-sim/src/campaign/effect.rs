//! When what is broken passes the controller's thresholds: judged from the machine and its encoders, in other numbers than the
//! controller's.

use super::current::{Current, Motor};
use super::excited::{Excited, way_counts};
use super::injection::{HEARTBEAT_TICKS, Injection, MISSED_EVERY, second};
use super::inputs::is_bad;
use super::scenario::Scenario;
use super::swings::{Slowed, Swings};
use super::truth::{Subdivided, most_lead_rad, setpoint_turns, shown_errors_rad};
use crate::machine::devices::Encoder;
use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::plant::AXES;
use core::f64::consts::TAU;
use core::ops::Range;
use firmware::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT};
use firmware::motion::Position;
use firmware::parameters::Parameters;

/// Bridged frames that are told.
const OFTEN: u64 = 12;
/// Ticks for which bridges that begin to drive are given time to wake up: 2 ms, and the one in which they began.
const WAKE_TICKS: u64 = 41;
/// Ticks in a row in which a low supply is one.
const LOW_SUPPLY_TICKS: u64 = 4;
/// Ticks of one reading, after which it is asked whether there should have been others.
const SAME_TICKS: u64 = 20;
/// Rate from which on a reading may stay the same for as long as frames are bridged only, rad/s: 0.03 of what the encoder has
/// shown last, which need not be the setpoint's.
const MOVING_RAD_S: f64 = 0.01;
/// The same of what the encoder itself has shown last, counts in a tick: the controller asks for 16 and knows a reading's fraction.
const MOVED_COUNTS: u32 = 14;
/// Ticks from one look at a pivot to the next: longer than that over a threshold, and it has been looked at.
const LOOK_TICKS: u64 = 4;
/// Share of a motor's largest current from which it is held at its limit for certain, and from which it may be: behind a jam that drives it to 8 A
/// the limit holds it an eighth under for some ticks.
const LIMITED: f64 = 0.995;
const NEARLY_LIMITED: f64 = 0.85;
/// Ticks for which it may be further under than that and be limited all the same: where a jam has driven it far over, the limit first takes more than
/// it has to. Its poles lie within 0.88 of the origin, and a tenth of that is left after so many.
const LIMIT_SWINGS_TICKS: u64 = 18;
/// What the heat may be under its threshold for one who sees every fourth sample of the current.
const NEARLY: f64 = 0.99;
/// A following error, over its limit, that is one for certain, and that may be one: the judge's numbers are not the controller's to the bit.
const FOLLOWING: [f64; 2] = [1.0001, 0.9999];
/// Largest duty, as a share of the PWM's counts.
const FULL: f64 = 0.98;

/// Supply that is a fault, V, and how near to a threshold noise decides, V.
const TOO_HIGH_V: f64 = 58.0;
const NEAR_V: f64 = 0.15;
/// Supply over which the brake resistor is on for certain, V; what it has, bears for long and bears besides.
pub(super) const RESISTOR_ON_V: f64 = 54.05;
const RESISTOR_OHM: f64 = 8.2;
const RESISTOR_W: f64 = 50.0;
const RESISTOR_J: f64 = 500.0;
/// Ticks after which a supply is taken for settled since the resistor was switched on; rises from there that are one for certain, and
/// that may be, V; ticks in a row.
const SETTLED_TICKS: u64 = 20;
const RISE_V: [f64; 2] = [0.95, 0.55];
const RISE_TICKS: u64 = 6;
/// Supply under which it is switched off again, V.
pub(super) const RESISTOR_OFF_V: f64 = 52.0;
/// Ticks of a servo that is on, bridges waking up, in which the resistor has been tested three times; and of one test.
const TESTED_TICKS: u64 = 123;
const TEST_TICKS: u64 = 41;
/// Ticks of rest under the servo from one test of the resistor to the next: for certain, with three tries, and at least.
const RESTED_TICKS: [u64; 2] = [40_300, 39_900];
/// Ticks of a servo that is on after which the leads have been tested, and those in which that is judged.
const LEADS_TESTED_TICKS: u64 = 62;
const LEADS_JUDGED: Range<u64> = 42..64;
/// A swing of a bridge's voltage that is one for certain, and that may be one, V; reversals and the ticks in which they come.
const SWING_V: [f64; 2] = [26.0, 15.0];
/// The same of what the velocity gain asks for, which may be three times as high where a pivot carries more.
const ASKED_V: f64 = 6.0;
const REVERSALS: [usize; 2] = [14, 4];
/// And where the setpoint moves.
const REVERSALS_IN_MOTION: usize = 28;
/// A setpoint that hardly moves, rad/s.
const SLOW_RAD_S: f64 = 1.05;

/// What passes a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// In the tick that first sees it.
    AtOnce,
    /// One bad frame more than are bridged.
    BadFrames,
    /// The first tick in which it drives bridges that have had their time to wake up: before, their pins mean nothing.
    Driven,
    /// A low supply, seen often enough, and one that noise may take for that.
    LowSupply,
    /// See above.
    NearlyLowSupply,
    /// A high supply, and one that noise may take for that.
    HighSupply,
    /// See above.
    NearlyHighSupply,
    /// The brake resistor has taken what it bears.
    ResistorHot,
    /// The supply rises while the brake resistor is on, for certain and perhaps.
    SupplyRises,
    /// See above.
    SupplyMayRise,
    /// The brake resistor was broken when the servo went on, and has been tested since; and it broke in that test.
    ResistorTested,
    /// See above.
    ResistorMaybeTested,
    /// So many frames that its CRC refuses that it is told, whatever is bridged of them.
    OftenBad,
    /// One frame more in a row that its CRC refuses than are bridged, and some.
    BadInARow,
    /// See above.
    SomeBad,
    /// A motor's current is not what its voltage drives, and it may not be.
    CurrentUnexplained,
    /// See above.
    CurrentMaybeUnexplained,
    /// A current's reading stays the same, though that goes far.
    CurrentStays,
    /// A lead was lost when the servo went on, and leads have been tested since; and the tick in which that is judged.
    LeadsTested,
    /// See above.
    LeadsMaybeTested,
    /// The brake resistor was broken when the stage came to rest, and has been tested since; and it broke in that test.
    ResistorTestedAtRest,
    /// See above.
    ResistorMaybeTestedAtRest,
    /// A bridge's voltage goes to and fro, over and over; and something like it.
    Oscillates,
    /// See above.
    NearlyOscillates,
    /// One late tick more than are forgiven.
    LateTicks,
    /// What the encoders show is too far from the setpoint, for certain and perhaps.
    FollowingError,
    /// See above.
    NearlyFollowingError,
    /// A pivot is further from its setpoint than any stage allows that nobody has told otherwise.
    FarOff,
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
    /// The same, but for pauses in which its current's limit may swing.
    NearlyAtEnd,
    /// A motor has carried too much current for too long.
    Hot,
    /// The same, but for what a third of the samples tells.
    NearlyHot,
    /// A pivot has gone further than an excitation may take it, for certain and perhaps.
    ExcitedTooFar,
    /// See above.
    NearlyExcitedTooFar,
    /// The same for its rate.
    ExcitedTooFast,
    /// See above.
    NearlyExcitedTooFast,
    /// Nothing has been heard for as long as the host has promised.
    Silence,
}

/// What there is to see in a tick.
pub struct Now<'a> {
    /// The encoders, and the motors' currents (ADC counts), as the tick has read them.
    pub shown: &'a [Encoder; AXES],
    /// See `shown`.
    pub current_counts: [i16; AXES],
    /// The supply as the tick has read it, ADC counts.
    pub supply_counts: u16,
    /// Whether it drives.
    pub is_driven: bool,
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
    subdivision: [Subdivided; AXES],
    lead_rad: f64,
    /// Setpoint of the pivot when it broke, turns.
    broke_at: Option<f64>,
    position: Position,
    /// What the encoders have shown last, counts, and that without the error within a period of the scale that the controller was told.
    raw: [u32; AXES],
    last: [u32; AXES],
    excited: Excited,
    same: [u64; AXES],
    /// What each encoder moved by in the last tick in which it did, counts.
    moved: [u32; AXES],
    fast: [u64; AXES],
    at_full: [u64; AXES],
    /// The same, or at its largest current.
    at_end: [u64; AXES],
    /// The same with short pauses, and ticks of the pause.
    nearly: [u64; AXES],
    pause: [u64; AXES],
    /// Squares of the currents, A^2, smoothed.
    heat: [f64; AXES],
    /// Ticks in a row of driving, of a low and of a high supply, of bad frames; and those with the brake resistor on.
    driven: u64,
    /// Those in which the setpoint has rested, too.
    rested: u64,
    low: [u64; 2],
    high: [u64; 2],
    bad: [u64; AXES],
    all_bad: [u64; AXES],
    resistor_j: f64,
    /// Ticks since the brake resistor was switched on, and the supply when it had settled, V.
    braked: u64,
    settled_v: f64,
    risen: [u64; 2],
    currents: [Current; AXES],
    swings: [[Swings; 4]; AXES],
    slow_volts: [Slowed; AXES],
}

impl<'a> Effects<'a> {
    /// At the beginning of a run.
    #[must_use]
    pub fn new(parameters: &'a Parameters) -> Self {
        Self {
            parameters,
            subdivision: Subdivided::all(parameters),
            lead_rad: most_lead_rad(parameters),
            broke_at: None,
            position: [0; 3],
            raw: [0; AXES],
            last: [0; AXES],
            excited: Excited::NONE,
            same: [0; AXES],
            moved: [0; AXES],
            fast: [0; AXES],
            at_full: [0; AXES],
            at_end: [0; AXES],
            nearly: [0; AXES],
            pause: [0; AXES],
            heat: [0.0; AXES],
            driven: 0,
            rested: 0,
            low: [0; 2],
            high: [0; 2],
            bad: [0; AXES],
            all_bad: [0; AXES],
            resistor_j: 0.0,
            braked: 0,
            settled_v: 0.0,
            risen: [0; 2],
            currents: [Current::NONE; AXES],
            swings: [const { [const { Swings::NONE }; 4] }; AXES],
            slow_volts: [Slowed::default(); AXES],
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
        let goes_on = |so_far: u64, holds: bool| if holds { so_far + 1 } else { 0 };
        self.driven = goes_on(self.driven, now.is_driven);
        let rests = now.is_driven && now.rates_rad_s == [0.0; AXES];
        self.rested = goes_on(self.rested, rests);
        let supply_v = f64::from(now.supply_counts) * SUPPLY_V_PER_COUNT;
        for (i, near_v) in [-NEAR_V, NEAR_V].into_iter().enumerate() {
            let is_low = now.is_driven && supply_v < supervision.supply_min_v + near_v;
            self.low[i] = goes_on(self.low[i], is_low);
            let is_high = now.is_driven && supply_v > TOO_HIGH_V - near_v;
            self.high[i] = goes_on(self.high[i], is_high);
        }
        if supply_v > RESISTOR_ON_V {
            self.resistor_j += (supply_v * supply_v / RESISTOR_OHM - RESISTOR_W) / rate_hz;
        }
        let is_braked = supply_v > RESISTOR_ON_V || self.braked > 0 && supply_v > RESISTOR_OFF_V;
        self.braked = goes_on(self.braked, is_braked);
        if self.braked <= SETTLED_TICKS {
            self.settled_v = supply_v;
        }
        for (risen, rise_v) in self.risen.iter_mut().zip(RISE_V) {
            *risen = goes_on(*risen, is_braked && supply_v > self.settled_v + rise_v);
        }
        for i in 0..AXES {
            let is_bad = is_bad(&now.shown[i]);
            self.bad[i] = goes_on(self.bad[i], is_bad);
            self.all_bad[i] += u64::from(is_bad);
            let is_slow = now
                .rates_rad_s
                .iter()
                .all(|rate| f64::from(rate.abs()) < SLOW_RAD_S);
            let volts =
                f64::from(now.duty[i]) / f64::from(self.parameters.power.pwm_counts) * supply_v;
            let raw = now.shown[i].position();
            let counts = self.subdivision[i].corrected(raw);
            let half = COUNTS_PER_TURN / 2;
            let step = way_counts(counts, self.last[i]);
            self.excited.look(i, counts);
            let moved = counts.wrapping_sub(self.last[i]) % COUNTS_PER_TURN;
            self.last[i] = counts;
            // What the velocity gain makes of the encoder's rate is asked for whether the bridge can give it or not.
            let signed = if moved < half {
                f64::from(moved)
            } else {
                f64::from(moved) - f64::from(COUNTS_PER_TURN)
            };
            let rate_rad_s = signed / f64::from(COUNTS_PER_TURN) * TAU * rate_hz;
            let asked_v = rate_rad_s * self.parameters.servo.gains[i].velocity_v_s_rad;
            // What may be one counts at any rate, what has to be found only where the setpoint hardly moves.
            let may = now.is_driven;
            let slow_volts = self.slow_volts[i].take(volts);
            let seen = [
                (slow_volts, SWING_V[0], may && is_slow),
                (slow_volts, SWING_V[0], may),
                (volts, SWING_V[1], may),
                (asked_v, ASKED_V, may),
            ];
            for (swings, (volts, swing_v, counts)) in self.swings[i].iter_mut().zip(seen) {
                swings.look(volts, swing_v, counts);
            }
            let raw_step = way_counts(raw, self.raw[i]);
            self.raw[i] = raw;
            self.same[i] = goes_on(self.same[i], raw_step == 0);
            if raw_step != 0 {
                self.moved[i] = raw_step;
            }
            self.fast[i] = goes_on(self.fast[i], f64::from(step) > most_counts);
            let duty = f64::from(now.duty[i]).abs();
            let current_a = f64::from(now.current_counts[i]) * CURRENT_A_PER_COUNT;
            let most_a = self.parameters.power.current_limit_a;
            let is_limited = |share: f64| current_a.abs() >= share * most_a;
            let is_full = duty >= full - 0.5;
            self.at_full[i] = goes_on(self.at_full[i], is_full);
            self.at_end[i] = goes_on(self.at_end[i], is_full || is_limited(LIMITED));
            let pauses = duty < full - 1.0 && !is_limited(NEARLY_LIMITED);
            self.pause[i] = goes_on(self.pause[i], pauses);
            self.nearly[i] = goes_on(self.nearly[i], self.pause[i] < LIMIT_SWINGS_TICKS);
            self.heat[i] += (current_a * current_a - self.heat[i]) * part;
            let motor = Motor {
                volts,
                rate_rad_s: if self.parameters.encoders[i].reversed {
                    -rate_rad_s
                } else {
                    rate_rad_s
                },
                current_a,
                // While the leads are tested nothing else is said of the currents.
                is_driven: now.is_driven && self.driven > LEADS_TESTED_TICKS,
                is_limited: [self.at_end[i] > 0, !pauses],
            };
            self.currents[i].look(motor, &self.parameters.drives[i], self.parameters);
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
            Effect::AtOnce if matches!(scenario.injection, Injection::Both(_)) => {
                tick >= scenario.at
            }
            Effect::AtOnce => tick >= first,
            Effect::BadFrames => tick >= first + bridged,
            Effect::Driven => tick >= first && self.driven > WAKE_TICKS,
            Effect::LowSupply => self.low[0] >= LOW_SUPPLY_TICKS,
            Effect::NearlyLowSupply => self.low[1] > 0,
            Effect::HighSupply => self.high[0] >= LOW_SUPPLY_TICKS,
            Effect::NearlyHighSupply => self.high[1] > 0,
            Effect::ResistorHot => self.resistor_j >= RESISTOR_J,
            Effect::SupplyRises => self.risen[0] >= RISE_TICKS,
            Effect::SupplyMayRise => self.risen[1] > 0,
            Effect::ResistorTested => {
                self.driven >= TESTED_TICKS && tick + 1 - self.driven >= scenario.at
            }
            Effect::ResistorMaybeTested => {
                self.driven >= TEST_TICKS && tick + 1 - self.driven + TEST_TICKS >= scenario.at
            }
            Effect::CurrentUnexplained => self.currents.iter().any(Current::is_unexplained),
            Effect::CurrentMaybeUnexplained => {
                self.currents.iter().any(Current::may_be_unexplained)
            }
            Effect::CurrentStays => self.currents.iter().any(Current::stays),
            Effect::LeadsTested => {
                self.driven >= LEADS_TESTED_TICKS && tick + 1 - self.driven >= scenario.at
            }
            Effect::LeadsMaybeTested => LEADS_JUDGED.contains(&self.driven),
            Effect::ResistorTestedAtRest => {
                self.rested >= RESTED_TICKS[0] && tick + 1 - self.rested >= scenario.at
            }
            Effect::ResistorMaybeTestedAtRest => self.rested >= RESTED_TICKS[1],
            Effect::OftenBad => self.all_bad[scenario.axis] >= OFTEN,
            Effect::BadInARow => self.bad[scenario.axis] > bridged,
            // Frames that the CRC does not find belong to the row too.
            Effect::SomeBad => self.bad[scenario.axis] >= 2,
            Effect::Oscillates => {
                self.has_swung(0..1, REVERSALS[0]) || self.has_swung(1..2, REVERSALS_IN_MOTION)
            }
            Effect::NearlyOscillates => self.has_swung(2..4, REVERSALS[1]),
            Effect::LateTicks => tick >= first + MISSED_EVERY * u64::from(supervision.late_ticks),
            Effect::FollowingError | Effect::NearlyFollowingError if self.driven == 0 => false,
            Effect::FollowingError | Effect::NearlyFollowingError => {
                let is_near = effect == Effect::NearlyFollowingError;
                let over = FOLLOWING[usize::from(is_near)];
                // The setpoint of a tick that ends in a fault is not told: it may be slower than the last one by what a tick brakes.
                let limits = &self.parameters.limits;
                let braked_rad_s = if is_near {
                    limits.pivot_acceleration_rad_s2 / limits.rate_hz
                } else {
                    0.0
                };
                let errors = shown_errors_rad(&self.last, self.parameters, now.position);
                // The setpoint is behind by what the pivots go in ticks that do not come.
                let age = tick.checked_sub(scenario.at);
                let missed = age.map_or(0, |age| scenario.injection.missed_ticks(age));
                let allowed_s =
                    supervision.following_error_s + missed as f64 / self.parameters.limits.rate_hz;
                (errors.iter().zip(now.rates_rad_s)).any(|(error, rate_rad_s)| {
                    let rate_rad_s = f64::from(rate_rad_s.abs()) - braked_rad_s;
                    let lag_rad = allowed_s * rate_rad_s.max(0.0);
                    let sure_rad = if is_near {
                        -self.lead_rad
                    } else {
                        self.lead_rad
                    };
                    *error > over * (supervision.following_error_rad + lag_rad) + sure_rad
                })
            }
            Effect::FarOff => {
                let most_rad = Parameters::REFERENCE.supervision.following_error_rad;
                let errors = shown_errors_rad(&self.last, self.parameters, now.position);
                self.driven > 0 && errors.iter().any(|error| *error > most_rad)
            }
            // As it is referenced, the setpoint goes to where the pivot is.
            Effect::FrozenWay if self.driven == 0 => {
                self.broke_at = None;
                false
            }
            Effect::FrozenWay => {
                let turns = setpoint_turns(now.position)[scenario.axis];
                let way = turns - *self.broke_at.get_or_insert(turns);
                (way - way.round()).abs() * TAU > supervision.frozen_rad
            }
            Effect::Still => (0..AXES).any(|i| {
                let is_moving = f64::from(now.rates_rad_s[i].abs()) > MOVING_RAD_S
                    || self.moved[i] >= MOVED_COUNTS;
                self.same[i] >= SAME_TICKS || (is_moving && self.same[i] >= bridged)
            }),
            Effect::Overspeed | Effect::BrieflyOverspeed if self.driven == 0 => false,
            // One that was too fast before it was driven is looked at once the leads have been tested.
            Effect::Overspeed => {
                let looked_at = self.driven.saturating_sub(LEADS_TESTED_TICKS);
                (self.fast.iter()).any(|&ticks| ticks.min(looked_at) >= LOOK_TICKS)
            }
            Effect::BrieflyOverspeed => self.fast.iter().any(|&ticks| ticks > 0),
            // A motor that asks for hardly more than its current's limit is limited in some ticks only, until its integral asks for more.
            Effect::AtEnd => {
                (0..AXES).any(|i| self.at_full[i] > longest || self.at_end[i] > 2 * longest)
            }
            Effect::NearlyAtEnd => self.nearly.iter().any(|&ticks| ticks > longest),
            Effect::Hot => self.heat.iter().any(|&heat| heat > bearable),
            Effect::NearlyHot => self.heat.iter().any(|&heat| heat > NEARLY * bearable),
            Effect::ExcitedTooFar => self.excited.is_too_far(self.parameters, false),
            Effect::NearlyExcitedTooFar => self.excited.is_too_far(self.parameters, true),
            Effect::ExcitedTooFast => self.excited.is_too_fast(self.parameters, false),
            Effect::NearlyExcitedTooFast => self.excited.is_too_fast(self.parameters, true),
            Effect::Silence => tick > now.heard + HEARTBEAT_TICKS,
        }
    }

    fn has_swung(&self, which: Range<usize>, reversals: usize) -> bool {
        (self.swings.iter().flat_map(|pivot| &pivot[which.clone()]))
            .any(|swings| swings.reversals.len() >= reversals)
    }

    /// The platform's setpoint in the last tick, track radii.
    pub fn position(&self) -> [f64; 2] {
        [0, 1].map(|i| self.position[i] as f64 / 4_294_967_296.0)
    }

    /// The tick in which the second of two lost encoders is found.
    #[must_use]
    pub fn second_found(&self, scenario: &Scenario) -> Option<(u64, usize)> {
        let Injection::TwoEncoders(ticks) = scenario.injection else {
            return None;
        };
        let bridged = u64::from(self.parameters.supervision.bridged_frames);
        let tick = scenario.at + u64::from(ticks) + 1 + bridged;
        Some((tick, second(scenario.axis)))
    }
}
