//! One run of the campaign.

use super::injection::Injection;
use super::scenario::Scenario;
use super::settings::damaged;
use super::truth::fastest_rad_s;
use super::watch::{AT_REST_RAD_S, Watch};
use crate::front::Host;
use crate::machine::devices::{BridgeState, SettingsFlash};
use crate::machine::plant::AXES;
use crate::random::Random;
use crate::rig::{ControllerMemory, Rig};
use firmware::fault::Fault;
use firmware::gcs::{START_CAUSES, Session};
use firmware::mode::Mode;
use firmware::queues::Command;
use firmware::recorder::{Sample, TickObserver};

/// Ticks from one sign of life of the host to the next.
const HEARTBEAT_EVERY: u64 = 200;
/// Ticks between two turns of the command side.
const SERVICE_EVERY: u64 = 5;
/// Ticks in which the queue is kept full until a line is refused: one on its way makes the others wait.
const FLOOD_TICKS: u64 = 20;
/// Periods from a reset to the first tick, in which the bridges sleep.
const START_TICKS: u64 = 20;

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was run.
    pub scenario: Scenario,
    /// Whether it was run without the injection.
    pub is_control: bool,
    /// The tick in which what has to be latched, or has been, passed its threshold.
    pub effect: Option<u64>,
    /// Whether what was latched had a reason.
    pub is_founded: bool,
    /// The tick in which it has to be told at the latest.
    pub deadline: Option<u64>,
    /// What was latched first.
    pub fault: Option<Fault>,
    /// What ended the controlled stop of that.
    pub worse: Option<Fault>,
    /// The tick in which a second encoder was to be found lost, and the pivot, where the stage was still being stopped then.
    pub second: Option<(u64, usize)>,
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
    /// No fault, and the servo is on.
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
pub(super) struct Seen(Option<Sample>);

impl Seen {
    pub fn sample(&self) -> Option<&Sample> {
        self.0.as_ref()
    }
}

impl TickObserver for Seen {
    fn observe(&mut self, sample: &Sample) {
        // A fault leaves no rates: those that were asked for last count.
        let last = self
            .0
            .take()
            .map_or(sample.pivot_rates, |last| last.pivot_rates);
        let mut sample = sample.clone();
        if !matches!(sample.mode, Mode::Holding | Mode::Moving | Mode::Stopping) {
            sample.pivot_rates = last;
        }
        self.0 = Some(sample);
    }
}

/// Runs a scenario, or the same without its injection.
#[must_use]
pub fn run(scenario: Scenario, is_control: bool) -> Outcome {
    let mut random = Random::new(!scenario.seed);
    let flash = if scenario.injection == Injection::DamagedSettings && !is_control {
        damaged(&mut random)
    } else {
        SettingsFlash::in_memory()
    };
    let mut queues = ControllerMemory::new();
    let mut rig = Rig::simulated(&mut queues, &scenario.stage, &scenario.parameters, flash);
    rig.front.stage.set_pose_at_rest(scenario.start);
    let mut session = Session::new();
    let mut flooding = Session::new();
    let mut seen = Seen::default();
    let mut answers = Vec::new();
    let mut lines = scenario.lines.iter().peekable();
    let mut watch = Watch::new(&scenario, is_control);
    // What the controller's own count of ticks is behind.
    let mut restarted_at = 0;

    for tick in 1_u64.. {
        let age = tick.checked_sub(scenario.at).filter(|_| !is_control);
        if let Some(age) = age {
            (scenario.injection).apply(&mut rig.front, scenario.axis, age, &mut random);
        }
        if let (Injection::Watchdog(_), Some(0)) = (scenario.injection, age) {
            for _ in 0..START_TICKS {
                (rig.front.stage).advance_period([BridgeState::RESET; AXES]);
            }
            rig.reset(START_CAUSES[0]);
            session = Session::new();
            restarted_at = tick;
        }
        if let (Injection::QueueFull, Some(0..FLOOD_TICKS)) = (scenario.injection, age)
            && watch.outcome.told.is_none()
        {
            let refused = flood(&mut rig, &mut flooding);
            watch.outcome.told = refused.then_some(tick);
        }
        let shown = rig.front.stage.encoders.clone();
        let (current_counts, _) = rig.front.stage.analog();
        let outputs = rig.tick(&mut seen);
        watch.look(tick, &rig.front, (&shown, current_counts), &seen);
        if seen
            .sample()
            .is_some_and(|sample| sample.mode == Mode::Fault)
        {
            scenario.injection.let_go(&mut rig.front.stage.plant);
        }
        if watch.is_over(tick, &rig.front) {
            watch.outcome.end = end(&rig.front, outputs.awake);
            break;
        }
        // A host that is there says so, if only by an empty line.
        let is_silent = scenario.injection == Injection::HostSilent && age.is_some();
        if tick.is_multiple_of(HEARTBEAT_EVERY) && !is_silent {
            session.receive(b"\n");
            watch.heard = tick;
        }
        while let Some((_, line)) = lines.next_if(|(at, _)| *at <= tick) {
            if !is_silent {
                session.receive(line.as_bytes());
                session.receive(b"\n");
                watch.heard = tick;
            }
        }
        if tick.is_multiple_of(SERVICE_EVERY) {
            // Writing to a vector does not fail.
            let _ = rig.service(&mut session, &mut answers);
        }
    }
    if let Some(event) = scenario.injection.expected().told
        && scenario.injection != Injection::QueueFull
    {
        session.receive(b"EVT?\n");
        answers.clear();
        for _ in 0..SERVICE_EVERY {
            rig.tick(&mut seen);
            let _ = rig.service(&mut session, &mut answers);
        }
        let events = String::from_utf8_lossy(&answers);
        watch.outcome.told = told(&events, event).map(|tick| tick + restarted_at);
    }
    watch.finish()
}

/// Fills the queue of the tick, and sends a line that needs a place in it; whether that is refused.
fn flood(rig: &mut Rig<'_>, session: &mut Session) -> bool {
    // In no state but a fault does it do anything.
    while rig.command_queues.send(Command::Acknowledge).is_ok() {}
    let mut answers = Vec::new();
    if session.is_idle() {
        session.receive(b"ERR?\nSVO X 0\nERR?\n");
    }
    // Writing to a vector does not fail.
    let _ = rig.service(session, &mut answers);
    answers.ends_with(b"1005\n")
}

/// The tick of an event in the answer to `EVT?`, whose lines are number, tick and text.
fn told(events: &str, event: &str) -> Option<u64> {
    let line = events.lines().find(|line| line.contains(event))?;
    line.split(' ').nth(1)?.parse().ok()
}

fn end(host: &Host, awake: bool) -> End {
    let is_resting = fastest_rad_s(&host.stage.plant) < AT_REST_RAD_S;
    match (host.fault(), is_resting, awake) {
        (None, _, true) => End::Driven,
        (_, false, _) => End::Moving,
        (Some(_), _, true) => End::Braked,
        (_, _, false) => End::Released,
    }
}
