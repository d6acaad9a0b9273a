//! Straight lines against the numerical optimum, and every tick of them against every limit.
//!
//! `LINES=1000 cargo test -p firmware --release --test motion_optimum -- --nocapture` prints the distribution over 1,000
//! moves; without it there are 200. `SEED` in the environment takes other moves.

mod motion_bench;
mod optimum;

use firmware::motion::{Axis, Ground, Plan, Position, plan_line};
use kinematics::{Acceleration, Pose, Twist, inverse, pivot_motion};
use motion_bench::*;
use optimum::{Optimum, Random};
use std::f64::consts::TAU;

fn setting(name: &str, otherwise: u64) -> u64 {
    let set = std::env::var(name).ok().and_then(|text| text.parse().ok());
    set.unwrap_or(otherwise)
}

/// Parts of their limits that a plan uses, and how far out the platform centre gets.
#[derive(Default)]
struct Used {
    /// Speed, acceleration, jerk, pivot rate, pivot acceleration.
    shares: [f64; 5],
    /// Track radii.
    radius: f64,
}

impl Used {
    /// Every tick of a plan, as the integers give it.
    fn by(plan: &Plan, from: Position, ground: &Ground) -> Self {
        let limits = &ground.limits;
        let hz = limits.rate_hz;
        let mut used = Self::default();
        let mut axes = from.map(Axis::at_rest);
        for piece in &plan.pieces {
            let jerk = piece.jerk.map(|jerk| jerk as f64 / AXIS_UNIT * hz.powi(3));
            used.count(2, share(jerk, limits.jerk_mm_s3, limits.turn_jerk_deg_s3));
            for _ in 0..piece.ticks {
                for (i, axis) in axes.iter_mut().enumerate() {
                    axis.advance(piece.jerk[i], plan.nudge[i]);
                }
                used.look(&axes, ground);
            }
        }
        used
    }

    fn look(&mut self, axes: &[Axis; 3], ground: &Ground) {
        let limits = &ground.limits;
        let speed = share(velocity(axes), limits.speed_mm_s, limits.turn_speed_deg_s);
        let force = share(
            acceleration(axes),
            limits.acceleration_mm_s2,
            limits.turn_acceleration_deg_s2,
        );
        let [rate, push, radius] = pivots(axes, ground.centre);
        self.count(0, speed);
        self.count(1, force);
        self.count(3, rate / limits.pivot_rate_rad_s);
        self.count(4, push / limits.pivot_acceleration_rad_s2);
        self.radius = self.radius.max(radius);
    }

    fn count(&mut self, which: usize, share: f64) {
        self.shares[which] = self.shares[which].max(share);
    }
}

/// Largest pivot rate and acceleration, and the platform centre's distance from the track's, when the moved point is fixed at
/// (p, q) in the platform: C = P - R p.
fn pivots(axes: &[Axis; 3], [p, q]: [f64; 2]) -> [f64; 3] {
    let position = axes.map(|axis| axis.position as f64 / AXIS_UNIT);
    let (v, a) = (velocity(axes), acceleration(axes));
    let (rate, force) = (v[2] * TAU, a[2] * TAU);
    let theta = position[2].fract() * TAU;
    let (sin, cos) = theta.sin_cos();
    let arm = [cos * p - sin * q, sin * p + cos * q];
    let pose = Pose {
        x: position[0] - arm[0],
        y: position[1] - arm[1],
        theta,
    };
    let twist = Twist {
        x: v[0] + rate * arm[1],
        y: v[1] - rate * arm[0],
        theta: rate,
    };
    let acceleration = Acceleration {
        x: a[0] + force * arm[1] + rate * rate * arm[0],
        y: a[1] - force * arm[0] + rate * rate * arm[1],
        theta: force,
    };
    let guides = inverse(&pose).expect("inside the track").guides;
    let motion = pivot_motion(&guides, &twist, &acceleration);
    let most = |values: [f64; 3]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    [
        most(motion.rates),
        most(motion.accelerations),
        pose.x.hypot(pose.y),
    ]
}

/// A random move that is not refused: x and y over the disk, theta up to a turn, one in five up to three turns; half of them
/// of any size from 0.1 mm up; one in four about another point than the platform centre.
fn random_move(random: &mut Random) -> (Position, Position, Ground) {
    let mut ground = GROUND;
    if random.unit() < 0.25 {
        let (r, direction) = (0.6 * random.unit().sqrt(), TAU * random.unit());
        ground.centre = [r * direction.cos(), r * direction.sin()];
    }
    let turns = if random.unit() < 0.2 { 3.0 } else { 1.0 };
    loop {
        let from = random.place(&ground);
        let mut to = random.place(&ground);
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
        if way[0].hypot(way[1]) >= 0.1 && plan_line(1, from, to, &ground).is_ok() {
            return (from, to, ground);
        }
    }
}

/// Every limit, and the disk; what a failure needs to be found again.
fn check(used: &Used, from: &Position, to: &Position, ground: &Ground) {
    assert!(
        used.shares.iter().all(|&share| share <= SLACK),
        "{from:?} -> {to:?} about {:?}: {:?}",
        ground.centre,
        used.shares
    );
    // An f32's roundings on the way; 0.1 um.
    let most = ground.geometry.usable_radius() + 1e-6;
    assert!(
        used.radius <= most,
        "{from:?} -> {to:?} about {:?}: {} track radii out",
        ground.centre,
        used.radius
    );
}

#[test]
fn lines_keep_every_limit_and_are_within_a_tenth_of_the_optimum() {
    let (seed, lines) = (setting("SEED", 20_260_301), setting("LINES", 200));
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let mut ratios = Vec::new();
    let mut most = [0.0_f64; 5];
    for _ in 0..lines {
        let (from, to, ground) = random_move(&mut random);
        let plan = plan_line(1, from, to, &ground).expect("taken before");
        let used = Used::by(&plan, from, &ground);
        check(&used, &from, &to, &ground);
        for (most, share) in most.iter_mut().zip(used.shares) {
            *most = most.max(share);
        }
        let optimum = Optimum::new(&from, &to, &ground).seconds();
        let ratio = plan.ticks() as f64 / ground.limits.rate_hz / optimum;
        assert!(
            ratio > 1.0 - 1e-4,
            "{from:?} -> {to:?} about {:?}: {ratio}",
            ground.centre
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
        most[0], most[1], most[2], most[3], most[4]
    );
    assert!(at(0.5) < 1.005 && at(0.99) < 1.07, "slower than it was");
    assert_eq!(within, ratios.len());
    // Lines slow down no more than the pivots ask for.
    assert!(most[3] > 0.99 && most[4] > 0.8, "{most:?}");
}

#[test]
fn low_limits_of_the_pivots_are_kept_as_well() {
    let mut random = Random::new(setting("SEED", 20_260_302));
    for _ in 0..60 {
        let (from, to, mut ground) = random_move(&mut random);
        ground.limits.pivot_acceleration_rad_s2 = 20.0 + 200.0 * random.unit();
        ground.limits.pivot_rate_rad_s = 1.0 + 9.0 * random.unit();
        let plan = plan_line(1, from, to, &ground).expect("the same line");
        check(&Used::by(&plan, from, &ground), &from, &to, &ground);
    }
}

/// Any limits, far from the reference's and from each other.
#[test]
fn odd_limits_are_kept() {
    let mut random = Random::new(setting("SEED", 20_260_303));
    for _ in 0..60 {
        let (from, to, mut ground) = random_move(&mut random);
        let limits = &mut ground.limits;
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
        let plan = plan_line(1, from, to, &ground).expect("the same line");
        let used = Used::by(&plan, from, &ground);
        check(&used, &from, &to, &ground);
    }
}
