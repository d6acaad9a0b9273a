//! What a seed stands for: a stage, where it stands, what it is told, what breaks and when.

use core::f64::consts::TAU;

use firmware::parameters::Parameters;

use super::injection::{HEARTBEAT_MS, Injection};
use crate::machine::devices::StageParameters;
use crate::machine::plant::{AXES, FrictionParameters, Payload, PlantParameters};
use crate::random::Random;

/// How far a plant's parameter is off, as a share of it.
const SPREAD: f64 = 0.3;
/// Largest payload, kg, and the distance of its centre from the platform's, m.
const PAYLOAD_KG: f64 = 5.0;
const OFF_CENTRE_M: f64 = 0.03;
/// Targets and starts lie within this, mm.
const REACH_MM: f64 = 78.0;
/// Largest turn of a move, deg.
const TURN_DEG: f64 = 200.0;
/// The tick at which the stage is referenced, that of the first motion, and the time in which something breaks.
const REFERENCE: u64 = 8;
const FIRST_MOTION: u64 = 400;
const MOTION_TICKS: u32 = 4_000;

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
    /// What breaks.
    pub injection: Injection,
    /// The pivot at which it breaks.
    pub axis: usize,
    /// The tick before which it breaks.
    pub at: u64,
}

impl Scenario {
    /// The scenario of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let stage = StageParameters {
            plant: plant(&mut random),
            seed,
            ..StageParameters::REFERENCE
        };
        let [x_mm, y_mm] = place_mm(&mut random);
        let start = [x_mm * 1e-3, y_mm * 1e-3, random.between(-0.49, 0.49) * TAU];
        let mut lines = motion(&mut random);
        let injection = Injection::random(
            &mut random,
            Parameters::REFERENCE.supervision.bridged_frames,
        );
        if injection == Injection::HostSilent {
            lines.insert(0, (REFERENCE, format!("HBT {HEARTBEAT_MS}")));
        }
        let mut parameters = Parameters::REFERENCE;
        injection.set_up(&mut parameters.supervision);
        let axis = random.below(AXES as u32) as usize;
        let in_motion = FIRST_MOTION + u64::from(random.below(MOTION_TICKS));
        let at = match injection {
            Injection::DamagedSettings => 0,
            // At rest: in motion what needs a place in the queue waits for one.
            Injection::QueueFull => between_lines(FIRST_MOTION / 2, &lines),
            _ => in_motion,
        };
        Self {
            seed,
            stage,
            parameters,
            start,
            lines,
            injection,
            axis,
            at,
        }
    }
}

/// The first tick from `at` on in which no line is on its way: others would wait for it instead of being refused.
fn between_lines(at: u64, lines: &[(u64, String)]) -> u64 {
    const ON_ITS_WAY: u64 = 100;
    let is_free = |tick: &u64| {
        (lines.iter()).all(|(sent, _)| !(tick.saturating_sub(ON_ITS_WAY)..=*tick).contains(sent))
    };
    (at..).find(is_free).unwrap_or(at)
}

/// Every number of the machine off by its own share.
fn plant(random: &mut Random) -> PlantParameters {
    let reference = PlantParameters::REFERENCE;
    let mut vary = |value: f64| value * random.between(1.0 - SPREAD, 1.0 + SPREAD);
    let mut plant = PlantParameters {
        platform_mass_kg: vary(reference.platform_mass_kg),
        platform_inertia_kg_m2: vary(reference.platform_inertia_kg_m2),
        ring_inertia_kg_m2: vary(reference.ring_inertia_kg_m2),
        motor_inertia_kg_m2: vary(reference.motor_inertia_kg_m2),
        torque_constant_n_m_a: vary(reference.torque_constant_n_m_a),
        resistance_ohm: vary(reference.resistance_ohm),
        inductance_h: vary(reference.inductance_h),
        transmission_stiffness_n_m_rad: vary(reference.transmission_stiffness_n_m_rad),
        transmission_damping_n_m_s_rad: vary(reference.transmission_damping_n_m_s_rad),
        backlash_rad: vary(reference.backlash_rad),
        ring_friction: FrictionParameters {
            coulomb: vary(reference.ring_friction.coulomb),
            presliding: vary(reference.ring_friction.presliding),
            viscous: vary(reference.ring_friction.viscous),
            ..reference.ring_friction
        },
        ripple_n_m: vary(reference.ripple_n_m),
        ..reference
    };
    let mass_kg = random.between(0.0, PAYLOAD_KG);
    plant.payload = Payload {
        mass_kg,
        // A cylinder of 50 mm radius.
        inertia_kg_m2: mass_kg * 0.05 * 0.05 / 2.0,
        eccentricity_m: random.between(0.0, OFF_CENTRE_M),
        direction_rad: random.between(0.0, TAU),
    };
    plant
}

fn place_mm(random: &mut Random) -> [f64; 2] {
    loop {
        let place = [0; 2].map(|_| random.between(-REACH_MM, REACH_MM));
        if place[0].hypot(place[1]) < REACH_MM {
            return place;
        }
    }
}

/// A reference, then a motion of some kind: moves, moves with new targets under way, constant velocities, stops, or none.
fn motion(random: &mut Random) -> Vec<(u64, String)> {
    let mut lines = vec![(REFERENCE, "FRF".to_owned())];
    let slow = random.below(3) == 0;
    if slow {
        let speed = random.between(20.0, 200.0);
        lines.push((FIRST_MOTION - 1, format!("VLS {speed:.3}")));
    }
    let mut at = FIRST_MOTION;
    let kind = random.below(12);
    let motions = if kind == 0 { 0 } else { 1 + random.below(3) };
    for _ in 0..motions {
        let line = match kind {
            1..=7 => target(random),
            8 => format!("MVR W {:.4}", random.between(-TURN_DEG, TURN_DEG)),
            _ => velocity(random),
        };
        lines.push((at, line));
        at += u64::from(random.below(MOTION_TICKS / 2));
    }
    match random.below(8) {
        0 => lines.push((at, "STP".to_owned())),
        1 => lines.push((at, "HLT".to_owned())),
        _ => {}
    }
    lines
}

fn target(random: &mut Random) -> String {
    let [x, y] = place_mm(random);
    let w = random.between(-TURN_DEG, TURN_DEG);
    format!("MOV X {x:.4} Y {y:.4} W {w:.4}")
}

fn velocity(random: &mut Random) -> String {
    let [x, y] = [0; 2].map(|_| random.between(-100.0, 100.0));
    match random.below(3) {
        0 => format!("JOG X {x:.3} Y {y:.3}"),
        1 => format!("JOG W {:.3}", random.between(-300.0, 300.0)),
        _ => format!("JOG X {x:.3} W {:.3}", random.between(-300.0, 300.0)),
    }
}
