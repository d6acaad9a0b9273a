//! Judges a run while it goes on.

use firmware::fault::Reaction;
use firmware::mode::Mode;

use super::effect::{Effects, Now};
use super::expected::{Cause, MOST_EARLY};
use super::injection::Injection;
use super::outcome::{End, Outcome, Seen};
use super::scenario::Scenario;
use super::truth::{Path, fastest_rad_s, overrun_mm};
use crate::front::{Host, Wiring};
use crate::machine::devices::{BridgeState, Encoder, Stage};
use crate::machine::plant::AXES;

/// Ticks after the injection in which an effect is waited for.
const PATIENCE: u64 = 3_000;
/// Most ticks that a stage is watched after a fault, until it rests.
const AFTERMATH: u64 = 20_000;
/// Slower than this a pivot is at rest, rad/s.
pub(super) const AT_REST_RAD_S: f64 = 0.01;
/// Ticks between two looks at path and limits: 0.2 mm at full speed.
const LOOK_EVERY: u64 = 20;

/// See the module.
pub(super) struct Watch<'a> {
    pub outcome: Outcome,
    scenario: &'a Scenario,
    effects: Effects<'a>,
    /// The ticks in which the causes passed their thresholds.
    passed: Vec<Option<u64>>,
    /// Setpoints of the centre, and where it was after the injection and after the fault.
    asked: Path,
    been: Vec<[f64; 2]>,
    left: Path,
    turned_from: Option<f64>,
    /// The tick in which the host was heard last.
    pub heard: u64,
    /// The stage was being stopped in the tick before.
    was_stopping: bool,
    /// The stage when the reaction had to begin.
    in_time: Option<Moment>,
}

impl<'a> Watch<'a> {
    pub fn new(scenario: &'a Scenario, is_control: bool) -> Self {
        let causes = scenario.injection.expected().causes;
        Self {
            outcome: Outcome {
                scenario: scenario.clone(),
                is_control,
                effect: None,
                is_founded: false,
                deadline: None,
                fault: None,
                worse: None,
                second: None,
                told: None,
                deviation_mm: 0.0,
                travelled: (0.0, 0.0),
                overrun_mm: 0.0,
                unavoidable_mm: 0.0,
                end: End::Driven,
                is_torn: false,
            },
            scenario,
            effects: Effects::new(&scenario.parameters),
            passed: vec![None; causes.len()],
            asked: Path::default(),
            been: Vec::new(),
            left: Path::default(),
            turned_from: None,
            heard: 0,
            was_stopping: false,
            in_time: None,
        }
    }

    /// After a tick, which has read these encoders and currents.
    pub fn look(
        &mut self,
        tick: u64,
        host: &Host,
        read: (&[Encoder; AXES], [i16; AXES]),
        seen: &Seen,
    ) {
        let Some(sample) = seen.sample() else {
            return;
        };
        let (shown, current_counts) = read;
        let now = Now {
            shown,
            current_counts,
            position: sample.setpoint.position,
            rates_rad_s: sample.pivot_rates,
            duty: sample.duty.map(|duty| duty.0),
            heard: self.heard,
        };
        self.effects.look(&now);
        self.outcome.fault = self.outcome.fault.or(host.fault());
        self.outcome.worse = host.stop_ended_by();
        if let Some((at, pivot)) = self.effects.second_found(self.scenario)
            && at == tick
            && self.was_stopping
        {
            self.outcome.second = Some((at, pivot));
        }
        self.was_stopping = sample.mode == Mode::Stopping;
        self.look_for_effects(tick, host, &now);
        if tick.is_multiple_of(LOOK_EVERY) {
            self.look_at_path(tick, host, sample.mode);
        }
    }

    fn look_at_path(&mut self, tick: u64, host: &Host, mode: Mode) {
        let plant = &host.stage.plant;
        let [x, y, theta] = plant.pose();
        let place = [x * 1e3, y * 1e3];
        let radius_mm = self.scenario.parameters.geometry.radius_mm;
        let is_on = matches!(mode, Mode::Holding | Mode::Moving | Mode::Stopping);
        if is_on || self.outcome.fault.is_some() {
            let setpoint = [0, 1].map(|i| self.effects.position()[i] * radius_mm);
            self.asked.go(setpoint);
        }
        if tick >= self.scenario.at {
            self.been.push(place);
        }
        if self.is_left_alone(tick) {
            let from = *self.turned_from.get_or_insert(theta);
            self.left.go(place);
            self.outcome.travelled.1 = (theta - from).abs().to_degrees();
        }
        self.outcome.overrun_mm = self.outcome.overrun_mm.max(overrun_mm(plant));
        self.outcome.is_torn |= plant.broken().is_some();
    }

    /// There is a fault, or the controller has started anew and lets go.
    fn is_left_alone(&self, tick: u64) -> bool {
        let is_restarted = matches!(self.scenario.injection, Injection::Watchdog(_))
            && tick >= self.scenario.at
            && !self.outcome.is_control;
        self.outcome.fault.is_some() || is_restarted
    }

    fn look_for_effects(&mut self, tick: u64, host: &Host, now: &Now<'_>) {
        // The judge may be behind.
        let is_done = (self.outcome.fault).is_some_and(|fault| tick > fault.tick + MOST_EARLY);
        if self.outcome.is_control || tick < self.scenario.at || is_done {
            return;
        }
        let causes = self.scenario.injection.expected().causes;
        for (cause, passed) in causes.iter().zip(&mut self.passed) {
            if passed.is_none() && self.effects.has(cause.effect, tick, self.scenario, now) {
                *passed = Some(tick);
                let deadline = cause.within_ticks.map(|within| tick + within);
                let earliest = self.outcome.deadline.into_iter().chain(deadline).min();
                self.outcome.deadline = earliest;
            }
        }
        if self.in_time.is_none()
            && self
                .outcome
                .deadline
                .is_some_and(|deadline| tick >= deadline)
        {
            self.in_time = Some(Moment {
                tick,
                stage: host.stage.clone(),
                wiring: host.wiring,
            });
        }
    }

    pub fn is_over(&self, tick: u64, host: &Host) -> bool {
        if self.outcome.is_torn {
            return true;
        }
        if !self.is_left_alone(tick) {
            return tick >= self.scenario.at + PATIENCE;
        }
        let since = (self.outcome.fault).map_or(self.scenario.at, |fault| fault.tick);
        let resting = tick.is_multiple_of(LOOK_EVERY)
            && fastest_rad_s(&host.stage.plant) < AT_REST_RAD_S
            && tick > since + LOOK_EVERY;
        resting || tick >= since + AFTERMATH
    }

    pub fn finish(self) -> Outcome {
        let mut outcome = self.outcome;
        let causes = self.scenario.injection.expected().causes;
        let kind = outcome.fault.map(|fault| fault.kind);
        let of_it: Vec<_> = (causes.iter().zip(&self.passed))
            .filter(|(cause, _)| cause.kind == kind)
            .filter_map(|(cause, passed)| Some((cause, (*passed)?)))
            .collect();
        outcome.is_founded = of_it.iter().any(|(cause, passed)| {
            (outcome.fault).is_none_or(|fault| *passed <= fault.tick + cause.early_ticks)
        });
        // What need not be latched has no instant from which to count.
        let counts =
            |cause: &Cause| cause.within_ticks.is_some() && (kind.is_none() || cause.kind == kind);
        outcome.effect = (causes.iter().zip(&self.passed))
            .filter(|(cause, _)| counts(cause))
            .filter_map(|(_, passed)| *passed)
            .min();
        outcome.deviation_mm = (self.been.iter())
            .map(|&place| self.asked.distance(place))
            .fold(0.0, f64::max);
        outcome.travelled.0 = self.left.length();
        if outcome.overrun_mm > 0.0 {
            let lets_go = outcome.fault.is_none()
                || (outcome.fault).is_some_and(|fault| fault.kind.reaction() == Reaction::Coast);
            let in_time = self.in_time;
            outcome.unavoidable_mm =
                in_time.map_or(0.0, |moment| moment.overrun_mm(self.scenario, !lets_go));
        }
        outcome
    }
}

/// What a reaction finds when it begins.
struct Moment {
    tick: u64,
    stage: Stage,
    wiring: [Wiring; AXES],
}

impl Moment {
    /// The deepest overrun, mm, if the bridges brake, or let go, from here on; what is broken stays broken.
    fn overrun_mm(mut self, scenario: &Scenario, awake: bool) -> f64 {
        let told = BridgeState {
            awake,
            ..BridgeState::RESET
        };
        let pins = self.wiring.map(|wiring| wiring.pass(told));
        let mut deepest: f64 = 0.0;
        scenario.injection.let_go(&mut self.stage.plant);
        for tick in self.tick..self.tick + AFTERMATH {
            let plant = &mut self.stage.plant;
            (scenario.injection).push(plant, scenario.axis, tick - scenario.at);
            self.stage.advance_period(pins);
            if tick.is_multiple_of(LOOK_EVERY) {
                deepest = deepest.max(overrun_mm(&self.stage.plant));
                if fastest_rad_s(&self.stage.plant) < AT_REST_RAD_S {
                    break;
                }
            }
        }
        deepest
    }
}
