//! The sets of cases: where a motion is left, and for which target.
//!
//! There is no set for frames: they are coordinates only. The commander turns a target into a position of the base
//! frame before it asks for a way, and nothing below it knows of them. What a tool adds, another centre of rotation, is
//! set d4.

use crate::case::Case;
use crate::motion_bench::random::Random;
use crate::motion_bench::{CONSTRAINTS, UNIT};
use crate::motions::{either, jog, line, retarget, stop, tick};
use crate::phases::{ramp, speeding_up};
use crate::planner::Motion;
use firmware::motion::{Constraints, RotationCentre, check_target};
use std::f64::consts::TAU;

/// Median, 99 % and worst of the duration over rsruckig's.
pub type Goal = [f64; 3];

pub struct Set {
    pub name: &'static str,
    pub what: &'static str,
    pub goal: Option<Goal>,
    draw: fn(&mut Random) -> Option<Case>,
}

pub const SETS: [Set; 7] = [
    Set {
        name: "a",
        what: "anywhere on a line",
        goal: Some([0.95, 1.20, 1.45]),
        draw: anywhere,
    },
    Set {
        name: "b",
        what: "early, near the centre",
        goal: Some([1.00, 1.20, 1.45]),
        draw: early,
    },
    Set {
        name: "c",
        what: "corrected by 0.1 to 3 mm",
        goal: Some([1.00, 1.30, 1.75]),
        draw: corrected,
    },
    Set {
        name: "d1",
        what: "in a stop",
        goal: None,
        draw: in_a_stop,
    },
    Set {
        name: "d2",
        what: "in a jog",
        goal: None,
        draw: in_a_jog,
    },
    Set {
        name: "d3",
        what: "in another retarget",
        goal: None,
        draw: in_a_retarget,
    },
    Set {
        name: "d4",
        what: "as a, rotation off centre",
        goal: None,
        draw: off_centre,
    },
];

impl Set {
    /// Case `number` of a run: the same whatever the others are.
    pub fn case(&self, seed: u64, number: u64) -> Case {
        let name = (self.name.bytes()).fold(0, |all, byte| all << 8 | u64::from(byte));
        let mut random = Random::new((seed << 48) ^ (name << 32) ^ number);
        loop {
            if let Some(case) = (self.draw)(&mut random) {
                return case;
            }
        }
    }
}

/// Left at a tick for a target anywhere in the disk, at any orientation.
fn left(random: &mut Random, of: Motion, at: u64, constraints: &Constraints) -> Case {
    Case {
        of,
        at,
        to: random.place(constraints),
        constraints: *constraints,
    }
}

/// The same, at any tick of it.
fn left_at_any_tick(random: &mut Random, of: Motion, constraints: &Constraints) -> Case {
    let at = tick(random, of.plan.ticks());
    left(random, of, at, constraints)
}

fn anywhere(random: &mut Random) -> Option<Case> {
    let line = line(random, &CONSTRAINTS)?;
    Some(left_at_any_tick(random, line, &CONSTRAINTS))
}

fn early(random: &mut Random) -> Option<Case> {
    const NEAR_MM: f64 = 25.0;
    let line = line(random, &CONSTRAINTS)?;
    let at = tick(random, speeding_up(&line));
    let [x, y, _] = line.state_after(at).map(|axis| axis.rounded() as f64);
    (x.hypot(y) <= NEAR_MM * unit_per_mm()).then(|| left(random, line, at, &CONSTRAINTS))
}

/// Sizes are even from the smallest to the largest; theta stays one time in two, or changes by up to a degree.
fn corrected(random: &mut Random) -> Option<Case> {
    const SIZES_MM: [f64; 2] = [0.1, 3.0];
    const MOST_DEG: f64 = 1.0;
    let of = line(random, &CONSTRAINTS)?;
    let at = tick(random, of.plan.ticks());
    let size = SIZES_MM[0] + random.unit() * (SIZES_MM[1] - SIZES_MM[0]);
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    let turned = MOST_DEG / 360.0 * (2.0 * random.unit() - 1.0);
    let turned = if either(random) { turned } else { 0.0 };
    let [x, y, theta] = of.plan.end;
    let [dx, dy] = [cos, sin].map(|part| (part * size * unit_per_mm()) as i64);
    let to = [x + dx, y + dy, theta + (turned * UNIT) as i64];
    check_target(&to, &CONSTRAINTS).ok()?;
    Some(Case {
        of,
        at,
        to,
        constraints: CONSTRAINTS,
    })
}

fn in_a_stop(random: &mut Random) -> Option<Case> {
    let stop = stop(random, &CONSTRAINTS)?;
    Some(left_at_any_tick(random, stop, &CONSTRAINTS))
}

/// As often in the ramp as anywhere up to a second after it: theta alone would turn for years.
fn in_a_jog(random: &mut Random) -> Option<Case> {
    let jog = jog(random, &CONSTRAINTS)?;
    let ramp = ramp(&jog);
    let second = CONSTRAINTS.limits.rate_hz as u64;
    let ticks = if either(random) { ramp } else { ramp + second };
    let at = tick(random, ticks.min(jog.plan.ticks()));
    Some(left(random, jog, at, &CONSTRAINTS))
}

/// As often one deep as two.
fn in_a_retarget(random: &mut Random) -> Option<Case> {
    let line = line(random, &CONSTRAINTS)?;
    let mut motion = retarget(random, &line, &CONSTRAINTS)?;
    if either(random) {
        motion = retarget(random, &motion, &CONSTRAINTS)?;
    }
    Some(left_at_any_tick(random, motion, &CONSTRAINTS))
}

fn off_centre(random: &mut Random) -> Option<Case> {
    const MOST_RADII: f64 = 0.8;
    let radius = MOST_RADII * random.unit();
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    let centre = RotationCentre::new([radius * cos, radius * sin])?;
    let constraints = Constraints {
        rotation_centre: centre.point(),
        ..CONSTRAINTS
    };
    let line = line(random, &constraints)?;
    Some(left_at_any_tick(random, line, &constraints))
}

fn unit_per_mm() -> f64 {
    UNIT / CONSTRAINTS.geometry.radius_mm
}
