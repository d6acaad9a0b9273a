//! One run of the campaign.

use core::f64::consts::TAU;

use firmware::blackbox::BlackBox;
use firmware::fault::{Fault, Reaction};
use firmware::link::{Link, Mode};
use firmware::motion::Position;
use firmware::panel::{Panel, Session};
use firmware::parameters::Parameters;
use firmware::recorder::{Record, Sample};

use super::injection::{Effect, HEARTBEAT_TICKS, Injection, MISSED_EVERY};
use super::random::Random;
use super::scenario::Scenario;
use super::truth::{Path, fastest_rad_s, overrun_mm, setpoint_turns, shown_errors_rad};
use crate::devices::{BridgeState, Encoder, Stage};
use crate::host::{Host, Wiring};
use crate::plant::AXES;
use crate::run::IDENTITY;

/// Ticks after the injection in which an effect is waited for.
const PATIENCE: u64 = 3_000;
/// Most ticks that a stage is watched after a fault, until it rests.
const AFTERMATH: u64 = 20_000;
/// Slower than this a pivot is at rest, rad/s.
const AT_REST_RAD_S: f64 = 0.01;
/// Ticks between two looks at path and limits: 0.2 mm at full speed.
const LOOK_EVERY: u64 = 20;
/// Ticks in a row in which a low supply is one.
const LOW_SUPPLY_TICKS: u64 = 4;
/// Ticks from one sign of life of the host to the next.
const HEARTBEAT_EVERY: u64 = 200;
/// Ticks between two turns of the command side.
const SERVICE_EVERY: u64 = 5;

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was run.
    pub scenario: Scenario,
    /// Whether it was run without the injection.
    pub is_control: bool,
    /// The tick in which the effect passed its threshold.
    pub effect: Option<u64>,
    /// What was latched first.
    pub fault: Option<Fault>,
    /// The tick of the event that tells of it where it is no fault.
    pub told: Option<u64>,
    /// Largest distance of the platform's centre from the path of its setpoint after the injection, mm.
    pub deviation_mm: f64,
    /// Way of the centre (mm) and angle of the platform (deg) from the fault to the end.
    pub travelled: (f64, f64),
    /// Deepest that a guide was pressed into its end, mm.
    pub overrun_mm: f64,
    /// The same where the documented reaction begins in time, on the same machine; only told for a run that has an overrun.
    pub unavoidable_mm: f64,
    /// How it ended.
    pub end: End,
    /// What the plant says of its own equations, which end where the platform is torn out of its guides.
    pub is_torn: bool,
}

/// State at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// No fault: the servo is on.
    Driven,
    /// At rest, the bridges brake.
    Braked,
    /// At rest, the bridges let go.
    Released,
    /// Still turning when it was looked at last.
    Moving,
}

impl End {
    /// In a word.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Driven => "driven",
            Self::Braked => "braked",
            Self::Released => "released",
            Self::Moving => "moving",
        }
    }
}

/// What the tick has computed that the judgement needs.
#[derive(Default)]
struct Seen {
    position: Position,
    /// Of the pivots' setpoints, from the last tick in which there were any.
    rates_rad_s: [f32; AXES],
    is_on: bool,
}

impl Record for Seen {
    fn record(&mut self, sample: &Sample) {
        self.position = sample.setpoint.position;
        self.is_on = matches!(sample.mode, Mode::Holding | Mode::Moving | Mode::Stopping);
        if self.is_on {
            self.rates_rad_s = sample.pivot_rates;
        }
    }
}

/// Runs a scenario, or the same without its injection.
#[must_use]
pub fn run(scenario: Scenario, is_control: bool) -> Outcome {
    let parameters = Parameters::REFERENCE;
    let mut host = Host::new(&scenario.stage, &parameters);
    host.stage.set_pose_at_rest(scenario.start);
    let mut link = Box::new(Link::new());
    let black_box = Box::new(BlackBox::new());
    let (mut tick_link, mut panel_link) = link.split_keeping(&black_box);
    let mut panel = Box::new(Panel::new(&parameters, IDENTITY));
    let mut session = Session::new();
    let mut seen = Seen::default();
    let mut answers = Vec::new();
    let mut lines = scenario.lines.iter().peekable();
    let mut random = Random::new(!scenario.seed);
    let mut watch = Watch::new(&scenario, &parameters, is_control);

    for tick in 1.. {
        if tick >= scenario.at && !is_control {
            let age = tick - scenario.at;
            (scenario.injection).apply(&mut host, scenario.axis, age, &mut random);
        }
        let shown = host.stage.encoders.clone();
        let outputs = host.tick(&mut tick_link, &mut seen);
        watch.look(tick, &host, &shown, &seen);
        if watch.is_over(tick, &host) {
            watch.outcome.end = end(&host, outputs.awake);
            break;
        }
        // A host that is there says so, if only by an empty line.
        if tick.is_multiple_of(HEARTBEAT_EVERY) && (is_control || tick < scenario.at) {
            session.receive(b"\n");
            watch.heard = tick;
        }
        let is_silent = scenario.injection == Injection::HostSilent && tick >= scenario.at;
        while let Some((_, line)) = lines.next_if(|(at, _)| *at <= tick) {
            if is_control || !is_silent {
                session.receive(line.as_bytes());
                session.receive(b"\n");
                watch.heard = tick;
            }
        }
        if tick.is_multiple_of(SERVICE_EVERY) {
            // Writing to a vector does not fail.
            let _ = panel.service(&mut session, &mut panel_link, &mut answers);
        }
    }
    if let Some(event) = scenario.injection.expected().event {
        session.receive(b"EVT?\n");
        answers.clear();
        for _ in 0..SERVICE_EVERY {
            host.tick(&mut tick_link, &mut seen);
            let _ = panel.service(&mut session, &mut panel_link, &mut answers);
        }
        watch.outcome.told = told(&String::from_utf8_lossy(&answers), event);
    }
    watch.finish()
}

/// The tick of an event in the answer to `EVT?`, whose lines are number, tick and text.
fn told(events: &str, event: &str) -> Option<u64> {
    let line = events.lines().find(|line| line.contains(event))?;
    line.split(' ').nth(1)?.parse().ok()
}

fn end(host: &Host, awake: bool) -> End {
    let is_resting = fastest_rad_s(&host.stage.plant) < AT_REST_RAD_S;
    match (host.fault(), is_resting, awake) {
        (None, _, _) => End::Driven,
        (_, false, _) => End::Moving,
        (_, _, true) => End::Braked,
        (_, _, false) => End::Released,
    }
}

/// Judges a run while it goes on.
struct Watch<'a> {
    parameters: &'a Parameters,
    outcome: Outcome,
    /// Setpoints of the centre, and where it was after the injection and after the fault.
    asked: Path,
    been: Vec<[f64; 2]>,
    left: Path,
    turned_from: f64,
    /// The tick in which the host was heard last.
    heard: u64,
    /// Setpoint of the pivot when it broke, turns.
    broke_at: Option<f64>,
    /// The stage when the reaction had to begin.
    in_time: Option<Moment>,
}

impl<'a> Watch<'a> {
    fn new(scenario: &Scenario, parameters: &'a Parameters, is_control: bool) -> Self {
        Self {
            parameters,
            outcome: Outcome {
                scenario: scenario.clone(),
                is_control,
                effect: None,
                fault: None,
                told: None,
                deviation_mm: 0.0,
                travelled: (0.0, 0.0),
                overrun_mm: 0.0,
                unavoidable_mm: 0.0,
                end: End::Driven,
                is_torn: false,
            },
            asked: Path::default(),
            been: Vec::new(),
            left: Path::default(),
            turned_from: 0.0,
            heard: 0,
            broke_at: None,
            in_time: None,
        }
    }

    /// After a tick; `shown` are the encoders as it read them.
    fn look(&mut self, tick: u64, host: &Host, shown: &[Encoder; 3], seen: &Seen) {
        if self.outcome.fault.is_none() && host.fault().is_some() {
            self.outcome.fault = host.fault();
            self.turned_from = host.stage.plant.pose()[2];
        }
        self.look_for_effect(tick, shown, seen);
        self.keep_moment(tick, host);
        if !tick.is_multiple_of(LOOK_EVERY) {
            return;
        }
        let plant = &host.stage.plant;
        let [x, y, theta] = plant.pose();
        let place = [x * 1e3, y * 1e3];
        let radius_mm = self.parameters.geometry.radius_mm;
        if seen.is_on || self.outcome.fault.is_some() {
            let setpoint = [0, 1].map(|i| seen.position[i] as f64 / 4_294_967_296.0 * radius_mm);
            self.asked.go(setpoint);
        }
        if tick >= self.outcome.scenario.at {
            self.been.push(place);
        }
        if self.outcome.fault.is_some() {
            self.left.go(place);
            self.outcome.travelled.1 = (theta - self.turned_from).abs().to_degrees();
        }
        self.outcome.overrun_mm = self.outcome.overrun_mm.max(overrun_mm(plant));
        self.outcome.is_torn |= plant.broken().is_some();
    }

    fn look_for_effect(&mut self, tick: u64, shown: &[Encoder; 3], seen: &Seen) {
        let scenario = &self.outcome.scenario;
        if self.outcome.is_control || tick < scenario.at || self.outcome.effect.is_some() {
            return;
        }
        let first = scenario.at + u64::from(scenario.injection.is_of_encoder());
        let supervision = &self.parameters.supervision;
        let passed = match scenario.injection.expected().effect {
            Effect::AtOnce => tick >= first,
            Effect::BadFrames => tick >= first + u64::from(supervision.bridged_frames),
            Effect::LowSupply => tick >= first + LOW_SUPPLY_TICKS - 1,
            Effect::LateTicks => tick >= first + MISSED_EVERY * u64::from(supervision.late_ticks),
            Effect::FollowingError => {
                let errors = shown_errors_rad(shown, self.parameters, seen.position);
                errors
                    .iter()
                    .zip(seen.rates_rad_s)
                    .any(|(error, rate_rad_s)| {
                        let lag_rad = supervision.following_error_s * f64::from(rate_rad_s.abs());
                        *error > supervision.following_error_rad + lag_rad
                    })
            }
            Effect::Frozen => {
                let turns = setpoint_turns(seen.position)[scenario.axis];
                let way = turns - *self.broke_at.get_or_insert(turns);
                (way - way.round()).abs() * TAU > supervision.frozen_rad
            }
            Effect::Silence => tick > self.heard + HEARTBEAT_TICKS,
            Effect::Never => false,
        };
        if passed {
            self.outcome.effect = Some(tick);
        }
    }

    /// Keeps the stage as it is when the fault has to be latched at the latest.
    fn keep_moment(&mut self, tick: u64, host: &Host) {
        let within = self.outcome.scenario.injection.expected().within_ticks;
        if self
            .outcome
            .effect
            .is_some_and(|effect| tick == effect + within)
        {
            self.in_time = Some(Moment {
                tick,
                stage: host.stage.clone(),
                wiring: host.wiring,
            });
        }
    }

    fn is_over(&self, tick: u64, host: &Host) -> bool {
        if self.outcome.is_torn {
            return true;
        }
        match &self.outcome.fault {
            None => tick >= self.outcome.scenario.at + PATIENCE,
            Some(fault) => {
                let resting = tick.is_multiple_of(LOOK_EVERY)
                    && fastest_rad_s(&host.stage.plant) < AT_REST_RAD_S
                    && tick > fault.tick + LOOK_EVERY;
                resting || tick >= fault.tick + AFTERMATH
            }
        }
    }

    fn finish(self) -> Outcome {
        let mut outcome = self.outcome;
        outcome.deviation_mm = (self.been.iter())
            .map(|&place| self.asked.distance(place))
            .fold(0.0, f64::max);
        outcome.travelled.0 = self.left.length();
        if outcome.overrun_mm > 0.0 {
            let awake = !outcome
                .fault
                .is_some_and(|fault| fault.kind.reaction() == Reaction::Coast);
            let in_time = self.in_time;
            outcome.unavoidable_mm =
                in_time.map_or(0.0, |moment| moment.overrun_mm(&outcome.scenario, awake));
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
