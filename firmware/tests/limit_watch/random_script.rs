//! Random scripts: targets, constant velocities, stops and other speed limits, at any instants and many a few ticks after
//! a stop; about the platform's centre and another one; streamed targets and waveforms, and what interrupts them.

use super::script::{SETTLE, Script};
use crate::motion_bench::random::Random;
use std::f64::consts::TAU;

/// Radius in which targets lie, mm: the usable disk and some that are refused. Many lie just inside the rim.
const REACH_MM: f64 = 81.0;
const RIM_MM: f64 = 79.9999;

/// What a script is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Targets, constant velocities and stops.
    Motions,
    /// Streamed targets, waveforms, and what interrupts them.
    Streams,
}

/// The script of this number.
pub fn random_script(theme: Theme, seed: u64, number: u64) -> Script {
    // Neighbouring seeds of the generator have nothing in common.
    let mut random = Random::new(seed ^ number.wrapping_mul(0xD134_2543_DE82_EF95));
    let mut script = Script::default();
    set_up(&mut random, &mut script);
    match theme {
        Theme::Motions => motions(&mut random, &mut script),
        Theme::Streams if is_chance(&mut random, 0.5) => stream(&mut random, &mut script),
        Theme::Streams => wave(&mut random, &mut script),
    }
    if is_chance(&mut random, 0.6) {
        script.send("HLT");
    }
    // Nothing goes on for ever.
    if script.0.iter().any(|line| line.starts_with("JOG")) {
        script.pause(100);
        script.send("HLT");
    }
    script
}

/// At rest: a centre of rotation, limits of speed, weak drives.
fn set_up(random: &mut Random, script: &mut Script) {
    if is_chance(random, 0.3) {
        let [r, s] = [0, 1].map(|_| between(random, -40.0, 40.0));
        script.send(format!("SPI R {r:.3} S {s:.3}"));
    }
    if is_chance(random, 0.2) {
        let speed = between(random, 30.0, 200.0);
        script.send(format!("VLS {speed:.3}"));
    }
    if is_chance(random, 0.15) {
        let [x, y] = [0, 1].map(|_| between(random, 20.0, 200.0));
        let w = between(random, 40.0, 360.0);
        script.send(format!("VEL X {x:.3} Y {y:.3} W {w:.3}"));
    }
    if is_chance(random, 0.15) {
        let [rate, acceleration] = [between(random, 4.0, 10.0), between(random, 60.0, 300.0)];
        script.send(format!("SPA 1 0x54500106 {rate:.3}"));
        script.send(format!("SPA 1 0x54500107 {acceleration:.3}"));
    }
}

/// Two to eight lines that move or stop, with pauses.
fn motions(random: &mut Random, script: &mut Script) {
    let mut after_stop = false;
    script.send(target(random));
    script.pause(between(random, 200.0, 8_000.0) as u64);
    let mut line = if is_chance(random, 0.3) {
        "STP".into()
    } else {
        motion(random, after_stop)
    };
    for _ in 0..2 + (6.0 * random.unit()) as usize {
        after_stop = line == "STP" || line == "HLT";
        script.send(line.clone());
        script.pause(pause(random, after_stop));
        if line.starts_with("JOG") && is_chance(random, 0.3) {
            // To the edge, as a rule.
            script.pause(10_000);
        }
        line = motion(random, after_stop);
    }
}

fn motion(random: &mut Random, after_stop: bool) -> String {
    let kind = random.unit();
    match kind {
        _ if after_stop && kind < 0.6 => target(random),
        ..0.35 => target(random),
        ..0.45 => distance(random),
        ..0.72 => "STP".into(),
        ..0.8 => "HLT".into(),
        ..0.93 => velocity(random),
        _ => format!("VLS {:.3}", between(random, 30.0, 200.0)),
    }
}

/// Ticks until the next line: after a stop it comes while the stop lasts, as a rule.
fn pause(random: &mut Random, after_stop: bool) -> u64 {
    match random.unit() {
        ..0.8 if after_stop => between(random, 0.0, 500.0) as u64,
        ..0.1 => 0,
        ..0.4 => ticks(random, 1, 300),
        _ => ticks(random, 200, 8_000),
    }
}

/// Targets of one, two or three axes, anywhere.
fn target(random: &mut Random) -> String {
    let r = if is_chance(random, 0.2) {
        RIM_MM
    } else {
        REACH_MM * random.unit().sqrt()
    };
    let direction = TAU * random.unit();
    let far = if is_chance(random, 0.3) { 720.0 } else { 90.0 };
    let w = between(random, -far, far);
    some_axes("MOV", random, [r * direction.cos(), r * direction.sin(), w])
}

/// Distances of every size.
fn distance(random: &mut Random) -> String {
    let values = [60.0, 60.0, 180.0].map(|most| {
        let size = most * 10_f64.powf(-5.0 * random.unit() * random.unit());
        if is_chance(random, 0.5) { size } else { -size }
    });
    some_axes("MVR", random, values)
}

/// Velocities, some at the limit and some over it.
fn velocity(random: &mut Random) -> String {
    let values = [200.0, 200.0, 360.0].map(|most| most * between(random, -0.8, 0.8));
    some_axes("JOG", random, values)
}

fn some_axes(command: &str, random: &mut Random, values: [f64; 3]) -> String {
    let [x, y, w] = values.map(|value| format!("{value:.4}"));
    match random.unit() {
        ..0.25 => format!("{command} X {x}"),
        ..0.35 => format!("{command} W {w}"),
        ..0.6 => format!("{command} X {x} Y {y}"),
        _ => format!("{command} X {x} Y {y} W {w}"),
    }
}

/// Of a motion to and fro: how long it takes, ms, and how far it goes, about as far as the limits let it.
fn swing(random: &mut Random) -> (f64, f64) {
    let ms = ticks(random, 150, 1_000) as f64;
    let rate = TAU / (ms * 1e-3);
    let most = (200.0 / rate)
        .min(4_000.0 / rate.powi(2))
        .min(400_000.0 / rate.powi(3));
    // Half of the way there and back, and as far from the centre.
    (ms, 2.0 * most.min(30.0) * between(random, 0.05, 1.05))
}

/// Targets at a steady rate on a part of a swing of x and of w; then a stop, or nothing, and something else.
fn stream(random: &mut Random, script: &mut Script) {
    let period = ticks(random, 20, 200);
    script.send("SPA 1 0x19001900 1");
    script.send(format!("SCT T {}", period as f64 / 20.0));
    let (ms, way) = swing(random);
    let w = way * between(random, -1.0, 1.0);
    let count = (between(random, 0.2, 1.5) * ms * 20.0 / period as f64) as u64;
    for i in 0..count.min(300) {
        let phase = TAU * (i * period) as f64 / (ms * 20.0);
        // The jerk at the beginning is the sender's business too.
        let share = 0.5 - 0.5 * phase.cos();
        script.send(format!("MOV X {:.9} W {:.9}", way * share, w * share));
        script.pause(period);
    }
    interrupt(random, script, ["HLT", "STP"]);
    script.send("SPA 1 0x19001900 0");
    script.send(target(random));
    script.pause(ticks(random, 200, 8_000));
}

/// Waveforms of two axes; then a stop, or nothing, and something else.
fn wave(random: &mut Random, script: &mut Script) {
    let (ms, way) = swing(random);
    let period = ticks(random, 10, 40);
    let points = ((ms * 20.0) as u64 / period).max(8);
    let w = way * between(random, 0.0, 1.0);
    let curve = |way: f64| format!("SIN_P {points} {way:.6} 0 {points} 0 {}", points / 2);
    script.send(format!("WAV 1 X {}", curve(way)));
    script.send(format!("WAV 2 X {}", curve(w)));
    script.send("WSL 1 1 6 2");
    script.send("WGC 1 2 6 2");
    script.send(format!("WTR 1 {period} 1"));
    script.send("WGO 1 1 6 1");
    script.pause(ticks(random, 20, 12_000));
    interrupt(random, script, ["WGO 1 0", "STP"]);
}

/// A stop of a stream and targets while it lasts; or its end.
fn interrupt(random: &mut Random, script: &mut Script, stops: [&str; 2]) {
    match (4.0 * random.unit()) as u32 {
        0 => return script.send(SETTLE),
        1 => script.send(stops[0]),
        _ => script.send(stops[1]),
    }
    script.pause(between(random, 0.0, 150.0) as u64);
    script.send(target(random));
    script.pause(ticks(random, 200, 4_000));
    script.send(SETTLE);
}

fn is_chance(random: &mut Random, chance: f64) -> bool {
    random.unit() < chance
}

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

/// Ticks from `low` to `high`, short ones as often as long ones.
fn ticks(random: &mut Random, low: u64, high: u64) -> u64 {
    let (low, high) = (low as f64, high as f64);
    (low * (high / low).powf(random.unit())).round() as u64
}
