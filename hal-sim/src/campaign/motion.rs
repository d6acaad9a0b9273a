//! What the stage is told in a run: its reference, and a motion of some kind.

use core::f64::consts::TAU;

use crate::random::Random;

/// Targets and starts lie within this, mm.
const REACH_MM: f64 = 78.0;
/// Largest turn of a move, deg.
const TURN_DEG: f64 = 200.0;
/// The tick at which the stage is referenced, that of the first motion, and the time in which something breaks.
pub(super) const REFERENCE: u64 = 8;
pub(super) const FIRST_MOTION: u64 = 400;
pub(super) const MOTION_TICKS: u32 = 4_000;
/// The emergency stop before the run proper: pressed, released, acknowledged, referenced again, held.
const PRESSED: [u64; 2] = [60, 100];
const ACKNOWLEDGED: u64 = 120;
const REFERENCED_AGAIN: u64 = 160;
const HELD_AGAIN: u64 = 200;
/// Ticks from one streamed target to the next: 5 ms.
const STREAMED_EVERY: u64 = 100;

/// Lines and the ticks after which they are sent, and what comes with them.
pub(super) struct Motion {
    pub lines: Vec<(u64, String)>,
    /// The ticks in which the emergency stop is pressed.
    pub pressed: Option<[u64; 2]>,
    /// The tick after which it is forgotten.
    pub watched_from: u64,
}

impl Motion {
    /// Perhaps a fault that is acknowledged; then moves, moves with new targets under way, constant velocities, waves, streams, servo off
    /// and on, or nothing; perhaps in a frame, perhaps slow, perhaps stopped.
    pub fn random(random: &mut Random) -> Self {
        let mut lines = vec![(REFERENCE, "FRF".to_owned())];
        let is_after_fault = random.once_in(8);
        if is_after_fault {
            lines.push((ACKNOWLEDGED, "FLC".to_owned()));
            lines.push((REFERENCED_AGAIN, "FRF".to_owned()));
        }
        if random.once_in(3) {
            let speed = random.between(20.0, 200.0);
            lines.push((FIRST_MOTION - 60, format!("VLS {speed:.3}")));
        }
        if random.once_in(8) {
            let [x, y] = [0; 2].map(|_| random.between(-10.0, 10.0));
            let w = random.between(-180.0, 180.0);
            lines.push((
                FIRST_MOTION - 40,
                format!("KSW F1 X {x:.3} Y {y:.3} W {w:.3}"),
            ));
            lines.push((FIRST_MOTION - 20, "KEN F1".to_owned()));
        }
        let at = match random.below(16) {
            0 => FIRST_MOTION,
            1 => wave(&mut lines, random),
            2 => stream(&mut lines, random),
            3 => servo(&mut lines, random),
            kind => motions(&mut lines, kind, random),
        };
        match random.below(6) {
            0 => lines.push((at, "STP".to_owned())),
            1 => lines.push((at, "HLT".to_owned())),
            _ => {}
        }
        Self {
            lines,
            pressed: is_after_fault.then_some(PRESSED),
            watched_from: if is_after_fault { HELD_AGAIN } else { 0 },
        }
    }
}

impl Motion {
    /// Without the fault before.
    pub fn without_fault(&mut self) {
        let is_of_it = |at: u64| (ACKNOWLEDGED..=REFERENCED_AGAIN).contains(&at);
        self.lines.retain(|(at, _)| !is_of_it(*at));
        self.pressed = None;
        self.watched_from = 0;
    }

    /// The tick after which it is referenced for the motion.
    pub const fn referenced_at(&self) -> u64 {
        if self.pressed.is_some() {
            REFERENCED_AGAIN
        } else {
            REFERENCE
        }
    }
}

/// What is told instead where a motor is excited with the servo off, and from when on and how long it is.
pub(super) const EXCITED_AT: u64 = 60;
pub(super) const EXCITED_TICKS: u32 = 4_000;

impl Motion {
    /// A motor that is excited, by sines of 100 Hz and more.
    pub fn excitation(pivot: usize) -> Self {
        let excited_ms = EXCITED_TICKS / 20;
        let line = format!("EXC SINES {} 1.5 {excited_ms} 20 400 8", pivot + 1);
        Self {
            lines: vec![(REFERENCE, "CCL 1 ADVANCED".to_owned()), (EXCITED_AT, line)],
            pressed: None,
            watched_from: 0,
        }
    }
}

/// Somewhere in the disk, mm.
pub(super) fn place_mm(random: &mut Random) -> [f64; 2] {
    loop {
        let place = [0; 2].map(|_| random.between(-REACH_MM, REACH_MM));
        if place[0].hypot(place[1]) < REACH_MM {
            return place;
        }
    }
}

fn motions(lines: &mut Vec<(u64, String)>, kind: u32, random: &mut Random) -> u64 {
    let mut at = FIRST_MOTION;
    for _ in 0..1 + random.below(3) {
        let line = match kind {
            4..=10 => target(random),
            11 => format!("MVR W {:.4}", random.between(-TURN_DEG, TURN_DEG)),
            _ => velocity(random),
        };
        lines.push((at, line));
        at += u64::from(random.below(MOTION_TICKS / 2));
    }
    at
}

/// One axis to and fro, from where it stands.
fn wave(lines: &mut Vec<(u64, String)>, random: &mut Random) -> u64 {
    let generator = [1, 2, 6][random.index(3)];
    let (points, size) = (200 + random.below(800), random.between(0.5, 8.0));
    let wave = [
        format!(
            "WAV 1 X SIN_P {points} {size:.3} 0 {points} 0 {}",
            points / 2
        ),
        format!("WSL {generator} 1"),
        format!("WGC {generator} 3"),
        format!("WTR {generator} 10 1"),
        format!("WGO {generator} 1"),
    ];
    for (at, line) in (FIRST_MOTION..).step_by(10).zip(wave) {
        lines.push((at, line));
    }
    FIRST_MOTION + u64::from(random.below(MOTION_TICKS))
}

/// Targets along a line, one after the other, slowly at first and at last.
fn stream(lines: &mut Vec<(u64, String)>, random: &mut Random) -> u64 {
    lines.push((FIRST_MOTION, "SPA 1 0x19001900 1".to_owned()));
    lines.push((FIRST_MOTION + 10, "SCT T 5".to_owned()));
    let [x, y] = [0; 2].map(|_| random.between(-6.0, 6.0));
    let turn = random.between(-20.0, 20.0);
    let targets = 20 + u64::from(random.below(30));
    for target in 0..targets {
        let at = FIRST_MOTION + 40 + target * STREAMED_EVERY;
        // From rest to rest.
        let part = target as f64 / targets as f64;
        let share = (1.0 - (TAU * part).cos()) / targets as f64;
        let [x, y, turn] = [x, y, turn].map(|size| size * share);
        lines.push((at, format!("MVR X {x:.5} Y {y:.5} W {turn:.5}")));
    }
    FIRST_MOTION + 40 + targets * STREAMED_EVERY
}

/// The servo goes off in a motion, and on again at rest.
fn servo(lines: &mut Vec<(u64, String)>, random: &mut Random) -> u64 {
    let off = FIRST_MOTION + u64::from(random.below(MOTION_TICKS / 2));
    lines.push((FIRST_MOTION, target(random)));
    lines.push((off, "SVO X 0".to_owned()));
    let on = off + 600 + u64::from(random.below(1_000));
    lines.push((on, "SVO X 1".to_owned()));
    let at = on + 100;
    lines.push((at, target(random)));
    at + u64::from(random.below(1_000))
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
