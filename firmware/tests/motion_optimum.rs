//! Straight lines against the numerical optimum, and every tick of them against every limit.
//!
//! `LINES=1000 cargo test -p firmware --release --test motion_optimum -- --nocapture` prints the distribution over
//! 1,000 moves; without it there are 200. `SEED` in the environment takes other moves.

mod motion_bench;
mod optimum;

use firmware::motion::{Constraints, Plan, Position, plan_line};
use motion_bench::exact::Worst;
use motion_bench::random::Random;
use motion_bench::setting::setting;
use motion_bench::*;
use optimum::Optimum;
use std::f64::consts::TAU;

/// A random move that is not refused: x and y over the disk, theta up to a turn, one in five up to three turns; half of
/// them of any size from 0.1 mm up; one in four about another point than the platform centre.
fn random_move(random: &mut Random) -> (Position, Position, Constraints) {
    let mut constraints = CONSTRAINTS;
    if random.unit() < 0.25 {
        let (r, direction) = (0.6 * random.unit().sqrt(), TAU * random.unit());
        constraints.rotation_centre = [r * direction.cos(), r * direction.sin()];
    }
    let turns = if random.unit() < 0.2 { 3.0 } else { 1.0 };
    loop {
        let from = random.place(&constraints);
        let mut to = random.place(&constraints);
        to[2] = from[2] + (turns * (2.0 * random.unit() - 1.0) * UNIT) as i64;
        let size = if random.unit() < 0.5 {
            1.0
        } else {
            10_f64.powf(-3.0 * random.unit())
        };
        for i in 0..3 {
            to[i] = from[i] + ((to[i] - from[i]) as f64 * size) as i64;
        }
        let way = [0, 1].map(|i| (to[i] - from[i]) as f64 / UNIT * GEOMETRY.radius_mm);
        if way[0].hypot(way[1]) >= 0.1 && plan_line(1, from, to, &constraints).is_ok() {
            return (from, to, constraints);
        }
    }
}

/// Every limit, and the disk; what a failure needs to be found again.
fn check(plan: &Plan, from: &Position, to: &Position, constraints: &Constraints) -> Worst {
    let mut worst = Worst::default();
    worst.walk(plan, &at_rest(*from), constraints);
    // Of the disk an f32's roundings on the way; 0.1 um.
    assert!(
        worst.shares().iter().all(|&share| share <= SLACK) && worst.outside <= 1e-6,
        "{from:?} -> {to:?} about {:?}: {worst:?}",
        constraints.rotation_centre
    );
    worst
}

#[test]
fn lines_keep_every_limit_and_are_within_a_tenth_of_the_optimum() {
    let (seed, lines) = (setting("SEED", 20_260_301), setting("LINES", 200));
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let mut ratios = Vec::new();
    let mut most = Worst::default();
    for _ in 0..lines {
        let (from, to, constraints) = random_move(&mut random);
        let plan = plan_line(1, from, to, &constraints).expect("taken before");
        most = most.max(check(&plan, &from, &to, &constraints));
        let optimum = Optimum::new(&from, &to, &constraints).seconds();
        let ratio = plan.ticks() as f64 / constraints.limits.rate_hz / optimum;
        assert!(
            ratio > 1.0 - 1e-4,
            "{from:?} -> {to:?} about {:?}: {ratio}",
            constraints.rotation_centre
        );
        ratios.push(ratio);
    }
    ratios.sort_by(f64::total_cmp);
    let at = |part: f64| ratios[((ratios.len() - 1) as f64 * part) as usize];
    let within = ratios.iter().filter(|&&ratio| ratio <= 1.1).count();
    println!("duration over the optimum's (a lower bound of it), {lines} moves:");
    println!(
        "median {:.4}, 90 % {:.4}, 99 % {:.4}, worst {:.4}; {within} within 10 %",
        at(0.5),
        at(0.9),
        at(0.99),
        at(1.0)
    );
    println!(
        "largest part of a limit used: speed {:.5}, acceleration {:.5}, jerk {:.5}, pivot rate {:.5}, pivot acceleration {:.5}",
        most.speed, most.acceleration, most.jerk, most.pivot_rate, most.pivot_acceleration
    );
    assert!(at(0.5) < 1.005 && at(0.99) < 1.07, "slower than it was");
    assert_eq!(within, ratios.len());
    // Lines slow down no more than the pivots ask for.
    assert!(
        most.pivot_rate > 0.99 && most.pivot_acceleration > 0.8,
        "{most:?}"
    );
}

#[test]
fn low_limits_of_the_pivots_are_kept_as_well() {
    let mut random = Random::new(setting("SEED", 20_260_302));
    for _ in 0..60 {
        let (from, to, mut constraints) = random_move(&mut random);
        constraints.limits.pivot_acceleration_rad_s2 = 20.0 + 200.0 * random.unit();
        constraints.limits.pivot_rate_rad_s = 1.0 + 9.0 * random.unit();
        let plan = plan_line(1, from, to, &constraints).expect("the same line");
        check(&plan, &from, &to, &constraints);
    }
}

/// Any limits, far from the reference's and from each other.
#[test]
fn odd_limits_are_kept() {
    let mut random = Random::new(setting("SEED", 20_260_303));
    for _ in 0..60 {
        let (from, to, mut constraints) = random_move(&mut random);
        let limits = &mut constraints.limits;
        for limit in [
            &mut limits.speed_mm_s,
            &mut limits.acceleration_mm_s2,
            &mut limits.jerk_mm_s3,
            &mut limits.turn_speed_deg_s,
            &mut limits.turn_acceleration_deg_s2,
            &mut limits.turn_jerk_deg_s3,
            &mut limits.pivot_rate_rad_s,
            &mut limits.pivot_acceleration_rad_s2,
        ] {
            *limit *= 10_f64.powf(2.0 * random.unit() - 1.0);
        }
        let plan = plan_line(1, from, to, &constraints).expect("the same line");
        check(&plan, &from, &to, &constraints);
    }
}

/// Many turns on the way from the middle out: slow only where the pivots ask for it, which is far out, and straight.
#[test]
fn a_line_of_a_minute_is_slowed_where_it_has_to_be() {
    for (turns, to_mm) in [(12.0, 79.0), (50.0, 79.0), (90.0, 70.0)] {
        let (from, to) = (at(0.0, 0.0, 0.0), at(to_mm, 0.0, turns));
        let plan = plan_line(1, from, to, &CONSTRAINTS).expect("a line");
        check(&plan, &from, &to, &CONSTRAINTS);
        let ratio =
            plan.ticks() as f64 / LIMITS.rate_hz / Optimum::new(&from, &to, &CONSTRAINTS).seconds();
        let off = corners(&plan, at_rest(from))
            .iter()
            .map(|axes| off_line(axes, &from, &to))
            .fold(0.0, f64::max);
        println!("{turns} turns: {ratio:.4} of the bound, {off:.1} units off the line");
        assert!(ratio < 1.1 && off < 0.54);
    }
}
