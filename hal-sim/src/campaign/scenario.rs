//! What a seed stands for: a stage, where it stands, what it is told, what breaks and when.

use core::f64::consts::TAU;

use firmware::parameters::Parameters;

use super::commissioned::Commissioned;
use super::injection::{HEARTBEAT_MS, Injection};
use super::motion::{
    EXCITED_AT, EXCITED_TICKS, FIRST_MOTION, MOTION_TICKS, Motion, REFERENCE, place_mm,
};
use crate::machine::devices::{StageParameters, WiringParameters};
use crate::machine::plant::{AXES, Imperfections};
use crate::machine::unknown;
use crate::random::Random;
use crate::rig::{Told, with_gains_fitted, with_motion_fitted, with_wiring_told};

/// The tick from which on the stage is held, after `FRF`, and the ticks in which something may break meanwhile.
const HELD: u64 = 16;
const REFERENCING: u32 = 12;
/// Ticks after which a stage that rests under its servo has tested its brake resistor: 2.3 s.
const RESTED: u64 = 46_000;

/// A run before it is run.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// All of it comes from this.
    pub seed: u64,
    /// The stage.
    pub stage: StageParameters,
    /// The controller's parameters.
    pub parameters: Parameters,
    /// Where it stands at first (m, m, rad).
    pub start: [f64; 3],
    /// Lines for the controller and the tick after which they are sent, in order.
    pub lines: Vec<(u64, String)>,
    /// The ticks in which the emergency stop is pressed, as a part of what the stage is told.
    pub pressed: Option<[u64; 2]>,
    /// The tick from which on faults are the injection's.
    pub watched_from: u64,
    /// What breaks.
    pub injection: Injection,
    /// The pivot at which it breaks.
    pub axis: usize,
    /// The tick before which it breaks.
    pub at: u64,
}

impl Scenario {
    /// The scenario of a seed, on a machine that is drawn and told.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self::on(seed, &[])
    }

    /// The same on one of these machines, where there are some.
    #[must_use]
    pub fn on(seed: u64, machines: &[Commissioned]) -> Self {
        let mut random = Random::new(seed);
        let drawn = random.bits();
        let commissioned =
            (!machines.is_empty()).then(|| &machines[(drawn % machines.len() as u64) as usize]);
        let (stage, mut parameters) = match commissioned {
            Some(known) => (machine(known.machine, seed), known.parameters.clone()),
            None => {
                let stage = machine(drawn, seed);
                (stage, told(&stage))
            }
        };
        let [x_mm, y_mm] = place_mm(&mut random);
        let start = [x_mm * 1e-3, y_mm * 1e-3, random.between(-0.49, 0.49) * TAU];
        let mut motion = Motion::random(&mut random);
        let bridged = parameters.supervision.bridged_frames;
        let injection = Injection::random(&mut random, bridged, &stage);
        if injection == Injection::HostSilent {
            motion
                .lines
                .insert(0, (REFERENCE, format!("HBT {HEARTBEAT_MS}")));
        }
        if injection.is_before_start() {
            motion.without_fault();
        }
        injection.set_up(&mut parameters.supervision);
        let axis = random.below(AXES as u32) as usize;
        if matches!(injection, Injection::PushedExcited(_)) {
            motion = Motion::excitation(axis);
        }
        let at = at(&injection, &motion, &mut random);
        Self {
            seed,
            stage,
            parameters,
            start,
            lines: motion.lines,
            pressed: motion.pressed,
            watched_from: motion.watched_from,
            injection,
            axis,
            at,
        }
    }

    /// Ticks after the fault in which it is waited for: in a fourth of the runs long enough for a test of the brake resistor at rest.
    #[must_use]
    pub const fn patience(&self) -> u64 {
        match self.injection {
            Injection::ResistorOpen | Injection::ResistorStuckOn | Injection::SupplyStuck
                if self.seed.is_multiple_of(4) =>
            {
                RESTED
            }
            _ => self.injection.patience(),
        }
    }

    /// Whether the emergency stop is pressed in a tick, fault or not.
    #[must_use]
    pub fn presses(&self, tick: u64) -> bool {
        (self.pressed).is_some_and(|[from, to]| (from..to).contains(&tick))
    }
}

/// When it breaks: somewhere in the motion, while the stage is being referenced, as it has just been, or in a stop.
fn at(injection: &Injection, motion: &Motion, random: &mut Random) -> u64 {
    let in_motion = FIRST_MOTION + u64::from(random.below(MOTION_TICKS));
    let just_held = motion.watched_from.max(HELD) + u64::from(random.below(60));
    // From the line to the stage that is held. Before it an encoder that is lost is no fault: the line is refused.
    let in_reference = motion.referenced_at() + u64::from(random.below(REFERENCING));
    let mut stops = motion
        .lines
        .iter()
        .filter(|(_, line)| line == "STP" || line == "HLT");
    let in_stop = stops
        .next_back()
        .map(|(sent, _)| sent + u64::from(random.below(600)));
    match injection {
        Injection::DamagedSettings | Injection::NewerSettings => 0,
        Injection::ExchangedLines => 1,
        Injection::PushedExcited(_) => EXCITED_AT + u64::from(random.below(EXCITED_TICKS)),
        // Found before anything drives; in motion mostly not.
        Injection::ResistorOpen | Injection::ResistorStuckOn if random.below(2) == 0 => 1,
        // At rest: in motion what needs a place in the queue waits for one.
        Injection::QueueFull => between_lines(FIRST_MOTION / 2, &motion.lines),
        _ => match random.below(16) {
            0 | 1 => just_held,
            2..=5 => in_stop.unwrap_or(in_motion),
            // A host that has promised nothing yet may be silent.
            6 if *injection != Injection::HostSilent => in_reference,
            _ => in_motion,
        },
    }
}

/// A machine as a workshop builds it, with every imperfection, plugged in as it belongs. `seed` is that of its noise.
#[must_use]
pub fn machine(drawn: u64, seed: u64) -> StageParameters {
    let mut machine = unknown(drawn);
    machine.plant.imperfections = Imperfections::ALL;
    StageParameters {
        wiring: WiringParameters::REFERENCE,
        seed,
        ..machine
    }
}

/// What a controller is told that was put into service on this machine: zeros and directions of the encoders, drives, platform, load, and
/// gains that its resonances bear.
#[must_use]
pub fn told(stage: &StageParameters) -> Parameters {
    let machine = Told::Machine.parameters(&Parameters::REFERENCE, stage);
    let fitted = with_motion_fitted(&with_gains_fitted(&machine, stage));
    with_wiring_told(&fitted, stage)
}

/// The first tick from `at` on in which no line is on its way: others would wait for it instead of being refused.
fn between_lines(at: u64, lines: &[(u64, String)]) -> u64 {
    const ON_ITS_WAY: u64 = 100;
    let is_free = |tick: &u64| {
        (lines.iter()).all(|(sent, _)| !(tick.saturating_sub(ON_ITS_WAY)..=*tick).contains(sent))
    };
    (at..).find(is_free).unwrap_or(at)
}
