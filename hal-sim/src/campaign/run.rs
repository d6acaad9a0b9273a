//! One run of the campaign.

use super::injection::Injection;
use super::inputs::Read;
use super::outcome::{End, Outcome, Seen};
use super::rest::AT_REST_RAD_S;
use super::scenario::Scenario;
use super::settings::{damaged, newer};
use super::truth::fastest_rad_s;
use super::watch::Watch;
use crate::front::Host;
use crate::machine::devices::{SettingsFlash, Watchdog};
use crate::random::Random;
use crate::rig::{ControllerMemory, Rig};
use firmware::gcs::Session;
use firmware::mode::Mode;
use firmware::queues::Command;

/// Ticks from one sign of life of the host to the next.
const HEARTBEAT_EVERY: u64 = 200;
/// Ticks between two turns of the command side.
const SERVICE_EVERY: u64 = 5;
/// Ticks in which the queue is kept full until a line is refused: one on its way makes the others wait.
const FLOOD_TICKS: u64 = 20;

/// What no event tells of a sound machine.
const WRONG: [&str; 8] = [
    "encoder warns",
    "bad encoder frames bridged",
    "encoder stepped",
    "motor constant",
    "current sensor",
    "friction",
    "knocks",
    "no host heard",
];

/// Runs a scenario, or the same without its injection.
#[must_use]
pub fn run(scenario: Scenario, is_control: bool) -> Outcome {
    let mut random = Random::new(!scenario.seed);
    let flash = match scenario.injection {
        Injection::DamagedSettings if !is_control => damaged(&mut random),
        Injection::NewerSettings if !is_control => newer(&mut random),
        _ => SettingsFlash::in_memory(),
    };
    let mut memory = ControllerMemory::new();
    let mut rig = Rig::simulated(&mut memory, &scenario.stage, &scenario.parameters, flash);
    rig.front.stage.set_pose_at_rest(scenario.start);
    let mut session = Session::new();
    let mut flooding = Session::new();
    let mut seen = Seen::default();
    let mut answers = Vec::new();
    let mut lines = scenario.lines.iter().peekable();
    let mut watch = Watch::new(&scenario, is_control);
    rig.front.watchdog = Watchdog::new(random.between(0.0, 1.0));
    // What the controller's own count of ticks is behind.
    let mut restarted_at = 0;
    let mut is_over = false;

    for tick in 1_u64.. {
        let age = tick.checked_sub(scenario.at).filter(|_| !is_control);
        rig.front.emergency_stop = scenario.presses(tick);
        let is_let_go = is_over && scenario.injection.lets_go();
        if let Some(age) = age.filter(|_| !is_let_go) {
            (scenario.injection).apply(&mut rig.front, scenario.axis, age, &mut random);
        }
        let hangs = age.is_some() && restarted_at == 0 && scenario.injection.ends_program();
        if let (Some(0), Some(line)) = (age, scenario.injection.line(&scenario.parameters)) {
            session.receive(format!("{line}\n").as_bytes());
        }
        if let (Injection::QueueFull, Some(0..FLOOD_TICKS)) = (scenario.injection, age)
            && watch.outcome.told.is_none()
        {
            let refused = flood(&mut rig, &mut flooding);
            watch.outcome.told = refused.then_some(tick);
        }
        let read = Read::next(&mut rig.front.stage);
        let mut awake = false;
        if !hangs {
            awake = rig.tick(&mut seen).awake;
        } else if let Some(reset) = rig.front.stand_still() {
            rig.reset(reset.cause());
            session = Session::new();
            restarted_at = tick;
        }
        watch.look(tick, &rig.front, &read, &seen);
        is_over = tick >= scenario.watched_from
            && (seen.sample()).is_some_and(|sample| sample.mode == Mode::Fault);
        if is_over {
            scenario.injection.let_go(&mut rig.front.stage.plant);
        }
        if watch.is_over(tick, &rig.front) {
            watch.outcome.end = end(&rig.front, awake);
            break;
        }
        if hangs {
            continue;
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
    if scenario.injection == Injection::ExchangedLines && !is_control {
        watch.outcome.told = is_refused(&mut rig, &mut seen).then_some(scenario.at);
    }
    let told_by =
        (scenario.injection.expected().told).filter(|_| scenario.injection != Injection::QueueFull);
    let looked_for = if is_control {
        &WRONG
    } else {
        told_by.as_slice()
    };
    if !looked_for.is_empty() {
        session.receive(b"EVT?\n");
        answers.clear();
        for _ in 0..SERVICE_EVERY {
            rig.tick(&mut seen);
            let _ = rig.service(&mut session, &mut answers);
        }
        let events = String::from_utf8_lossy(&answers);
        watch.outcome.told = told(&events, looked_for).map(|tick| tick + restarted_at);
    }
    watch.finish()
}

/// Whether the stage has not been referenced, though it was told to.
fn is_refused(rig: &mut Rig<'_>, seen: &mut Seen) -> bool {
    let mut session = Session::new();
    let mut answers = Vec::new();
    session.receive(b"FRF? X\n");
    for _ in 0..SERVICE_EVERY {
        rig.tick(seen);
        // Writing to a vector does not fail.
        let _ = rig.service(&mut session, &mut answers);
    }
    answers.ends_with(b"0\n")
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

/// The tick of the first of some events in the answer to `EVT?`, whose lines are number, tick and text.
fn told(events: &str, looked_for: &[&str]) -> Option<u64> {
    let is_one = |line: &&str| looked_for.iter().any(|event| line.contains(event));
    let line = events.lines().find(is_one)?;
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
