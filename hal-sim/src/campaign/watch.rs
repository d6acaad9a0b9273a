//! Judges a run while it goes on.

use firmware::mode::Mode;

use super::bound::{AFTERMATH, Moment};
use super::effect::{Effect, Effects, Now};
use super::expected::{Cause, MOST_EARLY, RESTART_TICKS};
use super::inputs::{BEFORE, Inputs, Read};
use super::outcome::{End, Outcome, Seen};
use super::pushed::bridge_v;
use super::rest::{AT_REST_RAD_S, LOOK_EVERY, Rests, ToRest};
use super::scenario::Scenario;
use super::truth::{Path, fastest_rad_s, place_mm};
use crate::front::Host;

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
    rests: Rests,
    /// The tick in which the host was heard last.
    pub heard: u64,
    /// The stage was being stopped in the tick before.
    was_stopping: bool,
    /// And was driven.
    was_driven: bool,
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
                cut: None,
                deviation_mm: 0.0,
                reaction: ToRest::default(),
                bound: None,
                inputs: Inputs::default(),
                differs: None,
                end: End::Driven,
                is_torn: false,
            },
            scenario,
            effects: Effects::new(&scenario.parameters),
            passed: vec![None; causes.len()],
            asked: Path::default(),
            been: Vec::new(),
            rests: Rests::default(),
            heard: 0,
            was_stopping: false,
            was_driven: false,
            in_time: None,
        }
    }

    /// After a tick, which has read this.
    pub fn look(&mut self, tick: u64, host: &Host, read: &Read, seen: &Seen) {
        let Some(sample) = seen.sample() else {
            return;
        };
        let is_driven = matches!(sample.mode, Mode::Holding | Mode::Moving | Mode::Stopping);
        let now = Now {
            shown: &read.encoders,
            current_counts: read.current_counts,
            supply_counts: read.supply_counts,
            // The tick that finds a fault drives no more.
            is_driven: is_driven || (self.was_driven && sample.mode == Mode::Fault),
            position: sample.setpoint.position,
            rates_rad_s: sample.pivot_rates,
            duty: sample.duty.map(|duty| duty.0),
            heard: self.heard,
        };
        self.effects.look(&now);
        if tick + BEFORE >= self.scenario.at && self.outcome.fault.is_none() {
            let volts = [0, 1, 2].map(|bridge| {
                let pins = host.bridges[bridge].state();
                let current_counts = read.current_counts[bridge];
                bridge_v(pins, self.scenario, read.supply_counts, current_counts)
            });
            self.outcome.inputs.take(read, volts);
        }
        // What was acknowledged before is the scenario's.
        if tick >= self.scenario.watched_from {
            self.outcome.fault = self.outcome.fault.or(host.fault());
            self.outcome.worse = host.stop_ended_by();
        }
        if host.watchdog.is_cut() {
            self.outcome.cut.get_or_insert(tick);
        }
        if let Some((at, pivot)) = self.effects.second_found(self.scenario)
            && at == tick
            && self.was_stopping
        {
            self.outcome.second = Some((at, pivot));
        }
        self.was_stopping = sample.mode == Mode::Stopping;
        self.was_driven = is_driven;
        self.look_for_effects(tick, &now);
        self.look_at_path(tick, host, is_driven);
    }

    fn look_at_path(&mut self, tick: u64, host: &Host, is_driven: bool) {
        let plant = &host.stage.plant;
        if tick.is_multiple_of(LOOK_EVERY) {
            let radius_mm = self.scenario.parameters.geometry.radius_mm;
            if is_driven || self.outcome.fault.is_some() {
                let setpoint = [0, 1].map(|i| self.effects.position()[i] * radius_mm);
                self.asked.go(setpoint);
            }
            // A servo that is off follows nothing.
            let is_held = is_driven || self.is_left_alone();
            if tick >= self.scenario.at && is_held {
                self.been.push(place_mm(plant));
            }
            self.outcome.is_torn |= plant.broken().is_some();
        }
        if self.has_to_react(tick) && self.in_time.is_none() && !self.outcome.is_control {
            self.in_time = Some(Moment {
                tick,
                stage: host.stage.clone(),
                wiring: host.wiring,
            });
        }
        if self.in_time.is_some() {
            self.rests.look(tick, plant, &self.asked);
        }
    }

    /// A fault has been found, or had to be by now; or the outputs have been cut.
    fn has_to_react(&self, tick: u64) -> bool {
        let is_due = self
            .outcome
            .deadline
            .is_some_and(|deadline| tick >= deadline);
        let is_reaction =
            (self.scenario.injection.expected().causes.iter()).any(|cause| cause.kind.is_some());
        self.outcome.fault.is_some() || self.outcome.cut.is_some() || (is_due && is_reaction)
    }

    /// There is a fault, or the controller has started anew and lets go.
    const fn is_left_alone(&self) -> bool {
        self.outcome.fault.is_some() || self.outcome.cut.is_some()
    }

    fn look_for_effects(&mut self, tick: u64, now: &Now<'_>) {
        // The judge may be behind.
        let is_done = (self.outcome.fault).is_some_and(|fault| tick > fault.tick + MOST_EARLY);
        if self.outcome.is_control {
            // A servo that oscillates without a fault is told rightly; the machine's settings are wrong.
            let swings = Effect::NearlyOscillates;
            self.outcome.is_founded |=
                !is_done && self.effects.has(swings, tick, self.scenario, now);
            return;
        }
        if tick < self.scenario.at || is_done {
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
    }

    pub fn is_over(&self, tick: u64, host: &Host) -> bool {
        if self.outcome.is_torn {
            return true;
        }
        if !self.is_left_alone() {
            return tick >= self.scenario.at + self.scenario.patience();
        }
        let since = (self.outcome.fault).map_or(self.scenario.at, |fault| fault.tick);
        let is_started = self
            .outcome
            .cut
            .is_none_or(|cut| tick > cut + RESTART_TICKS);
        let resting = is_started
            && tick.is_multiple_of(LOOK_EVERY)
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
        outcome.is_founded |= of_it.iter().any(|(cause, passed)| {
            (outcome.fault).is_none_or(|fault| {
                *passed <= fault.tick + cause.early_ticks
                    && fault.tick <= passed.saturating_add(cause.late_ticks)
            })
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
        outcome.reaction = self.rests.to_rest();
        let (scenario, asked) = (self.scenario, &self.asked);
        let bound = |moment: Moment| {
            let faults = [outcome.fault.as_ref(), outcome.worse.as_ref()];
            moment.bound(scenario, faults, asked)
        };
        outcome.bound = self.in_time.map(bound);
        outcome
    }
}
