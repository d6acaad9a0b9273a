//! What the motion tests share: random positions and moves, and the limits that every tick is held against.
#![allow(
    dead_code,
    unused_imports,
    reason = "every test file uses its own part"
)]

pub mod constraints;
pub mod exact;
pub mod random;
pub mod reference;
pub mod setting;
pub mod streaming;

#[path = "../proptest_settings/mod.rs"]
mod proptest_settings;
pub use proptest_settings::settings;

use firmware::motion::plan::axis_state::TickIncrement;
use firmware::motion::{
    AxisState, Constraints, Limits, LoneFollower, Plan, PlanSlots, Position, plan_line,
};
use firmware::parameters::Parameters;
use kinematics::Geometry;
use proptest::prelude::*;
use std::f64::consts::PI;

/// 2^32: units of a position in a track radius or a turn.
pub const UNIT: f64 = 4_294_967_296.0;
/// 2^72: units of an [`AxisState`].
pub const AXIS_UNIT: f64 = 4_722_366_482_869_645_213_696.0;
/// Room for the roundings of f64 when a limit is checked.
pub const SLACK: f64 = 1.0 + 1e-6;

pub const GEOMETRY: Geometry = Geometry::REFERENCE;
pub const LIMITS: Limits = Parameters::REFERENCE.limits;
pub const CONSTRAINTS: Constraints = Constraints::new(LIMITS, GEOMETRY);

/// Position of a pose in mm and turns.
pub fn at(x_mm: f64, y_mm: f64, turns: f64) -> Position {
    let length = |mm: f64| (mm / GEOMETRY.radius_mm * UNIT).round() as i64;
    [length(x_mm), length(y_mm), (turns * UNIT).round() as i64]
}

/// Positions in the usable disk, theta within `turns` turns.
pub fn positions(turns: f64) -> impl Strategy<Value = Position> {
    (0.0..=80.0_f64, -PI..PI, -turns..=turns)
        .prop_map(|(r, direction, turns)| at(r * direction.cos(), r * direction.sin(), turns))
}

/// Moves of every size, from units to the whole disk and a few turns: an end, and a share of the way back to it.
pub fn moves() -> impl Strategy<Value = (Position, Position)> {
    (positions(2.0), positions(2.0), -9.0..=0.0_f64).prop_map(|(from, to, exponent)| {
        let share = 10_f64.powf(exponent);
        let part = |a: i64, b: i64| a + ((b - a) as f64 * share) as i64;
        let to = [
            part(from[0], to[0]),
            part(from[1], to[1]),
            part(from[2], to[2]),
        ];
        (from, to)
    })
}

pub fn line(from: Position, to: Position) -> Plan {
    plan_line(7, from, to, &CONSTRAINTS).expect("a move inside the disk")
}

/// At rest at the origin. Its slots stay as long as the test runs: some kilobytes.
pub fn follower() -> LoneFollower<'static> {
    LoneFollower::new(Box::leak(Box::new(PlanSlots::new())))
}

pub fn at_rest(position: Position) -> [AxisState; 3] {
    position.map(AxisState::at_rest)
}

/// Every state of a plan from its start to the end of its last piece, as the integers give it: without the rest that
/// the tick drops at the end.
pub fn states(plan: &Plan, start: [AxisState; 3]) -> Vec<[AxisState; 3]> {
    let mut axes = start;
    let mut all = vec![axes];
    for piece in &plan.pieces {
        for _ in 0..piece.ticks {
            for (i, axis) in axes.iter_mut().enumerate() {
                axis.advance(&TickIncrement::new(piece.jerk[i], plan.nudge[i]));
            }
            all.push(axes);
        }
    }
    all
}

/// The states where pieces meet, and in the middle of each; enough for what is monotonic or linear in a piece.
pub fn corners(plan: &Plan, start: [AxisState; 3]) -> Vec<[AxisState; 3]> {
    let mut axes = start;
    let mut all = vec![axes];
    for piece in &plan.pieces {
        let after = |ticks| [0, 1, 2].map(|i| axes[i].after(ticks, piece.jerk[i], plan.nudge[i]));
        all.push(after(piece.ticks / 2));
        let end = after(piece.ticks);
        all.push(end);
        axes = end;
    }
    all
}

/// Velocity in track radii and turns per second.
pub fn velocity(axes: &[AxisState; 3]) -> [f64; 3] {
    axes.map(|axis| axis.velocity as f64 / AXIS_UNIT * LIMITS.rate_hz)
}

/// Distance of a state from the line `from` -> `to`, units: how far its axes disagree on how much of the way is done.
pub fn off_line(axes: &[AxisState; 3], from: &Position, to: &Position) -> f64 {
    let way = [0, 1, 2].map(|i| (to[i] - from[i]) as f64);
    // Units with their fraction, relative to the start: small enough for f64.
    let done = [0, 1, 2]
        .map(|i| (axes[i].position - (i128::from(from[i]) << 40)) as f64 / (AXIS_UNIT / UNIT));
    let longest = (0..3).fold(0, |best, i| {
        if way[i].abs() > way[best].abs() {
            i
        } else {
            best
        }
    });
    if way[longest] == 0.0 {
        return done.iter().fold(0.0, |worst, d| worst.max(d.abs()));
    }
    let share = done[longest] / way[longest];
    (0..3).fold(0.0, |worst, i| worst.max((done[i] - share * way[i]).abs()))
}

/// Duration in ticks of the fastest motion over a path parameter of 1, in continuous time, after the textbook's cases
/// (Biagiotti and Melchiorri, 2008, section 3.4: `tj` is the time of constant jerk, `ta` that of the whole
/// acceleration).
pub fn optimum_ticks(rate: f64, acceleration: f64, jerk: f64) -> f64 {
    let (tj, ta) = if rate * jerk >= acceleration * acceleration {
        let tj = acceleration / jerk;
        (tj, tj + rate / acceleration)
    } else {
        let tj = (rate / jerk).sqrt();
        (tj, 2.0 * tj)
    };
    let cruise = 1.0 / rate - ta;
    if cruise >= 0.0 {
        return 2.0 * ta + cruise;
    }
    let tj_full = acceleration / jerk;
    let root = (acceleration.powi(4) / jerk.powi(2) + 4.0 * acceleration).sqrt();
    let ta = (acceleration * acceleration / jerk + root) / (2.0 * acceleration);
    if ta >= 2.0 * tj_full && tj == tj_full {
        2.0 * ta
    } else {
        4.0 * (0.5 / jerk).cbrt()
    }
}
