//! Shares, heading and speeds of a transition: a few are tried in floats, the soonest is planned.

use super::heading::{Heading, Plane, SMALLER, target};
use super::slower::Slower;
use crate::motion::brake::axis_brake::AxisBrake;
use crate::motion::brake::{Brake, gains};
use crate::motion::plan::Position;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::{AxisLimits, TickLimits};
use crate::motion::profile::any_state::task::{AxisProfile, Task};
use crate::number::float::{FloatMinMax, hypot, i64_to_f32_fast, i128_to_f32_fast};
use crate::number::sqrt_f32;

/// Heading, limits along, across and of theta, and what durations they allow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub heading: Heading,
    /// Limits along and of theta.
    pub limits: [AxisLimits<f32>; 2],
    /// Ticks in which the axis across is braked, whole ones.
    pub across: [f32; 3],
    /// Ticks in which each axis can arrive.
    shortest: [f32; 3],
    /// Acceleration across over that along.
    pub ratio: f32,
}

/// Distance to the limits, for what rounding to ticks costs.
const MARGIN: f32 = 0.999;
/// Shares across over along, besides the one of the straight way of the velocity.
const RATIOS: [f32; 3] = [0.5, 1.0, 2.0];
/// Shares may be as uneven as this: what is left of acceleration has to be released by them too.
const MOST_UNEVEN: f32 = 6.0;
/// Rounds for the heading and the brake across, which depend on each other.
const TURNS: usize = 3;
/// Part of the speed limit that is worth trying as the speed along.
const LEAST_SPEED: f32 = 0.3;
/// Ticks by which a stop and a line have to be sooner: what it takes to command them.
const COMMANDING: f32 = 40.0;

impl Choice {
    /// The soonest of some; or the one with these shares across over along, as for a second try at what differs little.
    pub fn new(
        state: &[AxisState; 3],
        to: &Position,
        plane: &Plane,
        limits: &TickLimits,
        slower: &Slower,
        like: Option<f32>,
    ) -> Option<Self> {
        let translation = limits.translation.scaled(
            MARGIN * slower.path * slower.speed,
            MARGIN * slower.force,
            MARGIN,
        );
        let rotation =
            (limits.rotation).scaled(MARGIN * slower.speed, MARGIN * slower.force, MARGIN);
        let turn = Task {
            distance: i128_to_f32_fast(target(to[2]) - state[2].position),
            velocity: i64_to_f32_fast(state[2].velocity),
            acceleration: i64_to_f32_fast(state[2].acceleration),
        };
        let turning = shortest(&turn, &rotation)?;
        let mut best: Option<Self> = None;
        let released = plane.released(translation.jerk);
        let ahead = Heading::new(
            plane.way[0] - released[0] * translation.acceleration / translation.jerk,
            plane.way[1] - released[1] * translation.acceleration / translation.jerk,
        );
        let chord = chord(&ahead.seen(&released), translation.velocity);
        let [a, b, c] = RATIOS;
        let all = [chord, a, b, c];
        for &ratio in like.as_ref().map_or(&all[..], core::slice::from_ref) {
            let Some(mut choice) = turned(plane, &released, ahead, &translation, ratio) else {
                continue;
            };
            choice.limits[1] = rotation;
            choice.shortest[2] = turning;
            if best.is_none_or(|best| choice.duration() < best.duration()) {
                best = Some(choice);
            }
        }
        best
    }

    /// Ticks of the whole.
    pub fn duration(&self) -> f32 {
        self.shortest.into_iter().fold(0.0, FloatMinMax::fmax)
    }

    /// Whether this arrives before a stop and a straight line would. A line is slowed down for the pivots only where
    /// they ask for it: by half as much as this, as a rule.
    pub fn is_sooner_than_a_stop(
        &self,
        state: &[AxisState; 3],
        to: &Position,
        limits: &TickLimits,
        slower: &Slower,
    ) -> bool {
        let brake = Brake::new(state, limits, 1.0, 1.0);
        let times = brake.about();
        let [by_velocity, by_acceleration] = gains(times);
        let left = [0, 1, 2].map(|i| {
            let (v, a) = (
                i64_to_f32_fast(state[i].velocity),
                i64_to_f32_fast(state[i].acceleration),
            );
            i128_to_f32_fast(target(to[i]) - state[i].position)
                - by_velocity * v
                - by_acceleration * a
        });
        let line = [
            (
                hypot(left[0] * SMALLER, left[1] * SMALLER) / SMALLER,
                &limits.translation,
            ),
            (left[2].abs(), &limits.rotation),
        ]
        .into_iter()
        .map(|(way, limits)| {
            let task = Task {
                distance: way,
                ..Task::default()
            };
            shortest(&task, limits).unwrap_or(0.0)
        })
        .fold(0.0, FloatMinMax::fmax);
        let line = line * (1.0 + 1.0 / slower.speed) / 2.0;
        self.duration() <= times[0] + times[1] + times[2] + line + COMMANDING
    }
}

/// Shares in proportion to what is to change: the velocity across to nothing, that along to the limit.
fn chord([along, across]: &[f32; 2], limit: f32) -> f32 {
    (across.abs() / (limit - along).fmax(limit * 1e-3)).clamp(1.0 / MOST_UNEVEN, MOST_UNEVEN)
}

/// The choice with acceleration across `ratio` times that along.
fn turned(
    plane: &Plane,
    released: &[f32; 2],
    heading: Heading,
    limits: &AxisLimits<f32>,
    ratio: f32,
) -> Option<Choice> {
    let along = 1.0 / sqrt_f32(1.0 + ratio * ratio);
    let [mut along, mut aside] =
        [along, along * ratio].map(|share| limits.scaled(1.0, share, share));
    give_way(
        heading.seen(&plane.a),
        limits.acceleration,
        &mut along,
        &mut aside,
    );
    let (heading, across) = ahead_of(plane, heading, &aside);
    let [ahead, sideways] = heading.seen(released).map(|v| v / limits.velocity);
    let top = top_speed(ahead, sideways.abs(), ratio);
    if top < LEAST_SPEED {
        return None;
    }
    along.velocity *= top;
    let seen = |vector: &[f32; 2]| heading.seen(vector)[0];
    let task = Task {
        distance: seen(&plane.way),
        velocity: seen(&plane.v),
        acceleration: seen(&plane.a),
    };
    Some(Choice {
        heading,
        limits: [along, along],
        across,
        shortest: [shortest(&task, &along)?, across.into_iter().sum(), 0.0],
        ratio,
    })
}

/// Where the acceleration now is over the share of one axis, it takes some time to come down to it: so long the other
/// gets what is left of the whole.
fn give_way(now: [f32; 2], whole: f32, along: &mut AxisLimits<f32>, aside: &mut AxisLimits<f32>) {
    let left = |other: f32| sqrt_f32((whole * whole - other * other).fmax(0.0)).fmax(0.2 * whole);
    let [ahead, across] = now.map(f32::abs);
    if across > aside.acceleration {
        along.acceleration = along.acceleration.fmin(left(across));
    }
    // Across starts from nothing or from less than it may: by then this much of the acceleration along is gone.
    let later = ahead - along.jerk * aside.acceleration / aside.jerk;
    if later > along.acceleration {
        aside.acceleration = aside.acceleration.fmin(left(later));
    }
}

/// The heading at which the target is straight ahead after a brake across, and the ticks of that brake. Ticks that
/// serve for all that is under way have a heading at once; shorter ones are taken while they are long enough for what
/// is across then.
fn ahead_of(plane: &Plane, guess: Heading, limits: &AxisLimits<f32>) -> (Heading, [f32; 3]) {
    let [v, a] = [&plane.v, &plane.a].map(|vector| hypot(vector[0], vector[1]));
    let of = |ticks: [f32; 3]| (Heading::after(plane, gains(ticks)), ticks);
    let brake = |heading: &Heading| {
        AxisBrake::new(heading.seen(&plane.v)[1], heading.seen(&plane.a)[1], limits)
    };
    let mut best = of(AxisBrake::new(v, a, limits).ticks());
    let (mut heading, mut last) = (guess, [0.0; 3]);
    for _ in 0..TURNS {
        let ticks = brake(&heading).ticks();
        // They lead to the same heading again.
        if ticks == last {
            break;
        }
        last = ticks;
        let next = of(ticks);
        let total = |[a, b, c]: [f32; 3]| a + b + c;
        if total(next.1) < total(best.1) && brake(&next.0).over(next.1) == [false; 3] {
            best = next;
        }
        heading = next.0;
    }
    best
}

/// Speed along that keeps the path within a limit of 1. Velocity goes from `(ahead, aside)` straight, `ratio` aside for
/// 1 ahead: to the axis, when that is met within the limit; else ahead is held where the limit is met, while aside goes
/// on to zero.
fn top_speed(ahead: f32, aside: f32, ratio: f32) -> f32 {
    if ahead * ratio + aside <= ratio {
        return 1.0;
    }
    let square = 1.0 + ratio * ratio;
    let half = ahead - ratio * aside;
    let room = (1.0 - ahead * ahead - aside * aside).fmax(0.0);
    let gained = (sqrt_f32(half * half + square * room) - half) / square;
    (ahead + gained).fmin(1.0)
}

fn shortest(task: &Task<f32>, limits: &AxisLimits<f32>) -> Option<f32> {
    if task.distance == 0.0 && task.velocity == 0.0 && task.acceleration == 0.0 {
        return Some(0.0);
    }
    AxisProfile::shortest(task, limits).ok()
}
