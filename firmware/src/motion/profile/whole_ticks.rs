//! From an axis profile to jerks over whole ticks, exact in integers.
//!
//! The profile's durations are rounded up to whole ticks. With these fixed, the acceleration is a broken line through
//! the start's, a peak `P` and a brake `Q`, and zero at the end; speed and position at the end are linear in `P` and
//! `Q`: `v + a f0 + P f1 + Q f2 = 0` and `v n + a g0 + P g1 + Q g2 = d`, where `f` are the areas of the hats of the
//! broken line and `g` their moments about the end ([`Hats`]). Two equations, two unknowns, in floats. Where rounding
//! has put an acceleration, a jerk or a speed over its limit, the segment concerned is lengthened.
//!
//! The integers then close what the floats left: the segments are run exactly up to the brake, the brake is the one
//! that comes to rest from there, and the way that is missing is made up by another `P`.

use super::any_state::task::{AxisProfile, SEGMENTS, Task};
use super::hats::Hats;
use super::shape::{Shape, Solution};
use crate::motion::brake::{jerks, stepped};
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::AxisLimits;
use crate::number::float::{
    FloatMinMax, ceil_ticks, i64_to_f32_fast, i128_to_f32_fast, round_i64, ticks_to_f32,
};
use crate::number::sqrt_f32;
use heapless::Vec;

/// Stretches of constant jerk of one axis: ticks, and jerk in 2^-72 units per tick cubed.
pub(crate) type Track = Vec<(u64, i64), SEGMENTS>;

/// How often segments may have to be lengthened.
const MOST_ROUNDS: usize = 24;
/// How often the way that is missing is made up for. Each time it becomes a millionth.
const CLOSINGS: usize = 1;
/// How much of a limit is granted to the roundings of floats.
const FIT_SLACK: f32 = 1.0 + 5e-7;

/// Writes the track of an axis over `way` (2^-72 units) to rest in about `duration` ticks, or as soon as it can; `None`
/// where the state allows none.
pub(crate) fn fit(
    track: &mut Track,
    mut axis: AxisState,
    way: i128,
    limits: &AxisLimits<f32>,
    duration: f32,
) -> Option<()> {
    track.clear();
    if axis.velocity == 0 && axis.acceleration == 0 && way == 0 {
        return Some(());
    }
    let target = axis.position + way;
    let mut task = task(&axis, target);
    let mut profile = AxisProfile::lasting(&task, limits, duration).ok()?;
    let braking = [
        profile.durations[0] as u64,
        ceil_ticks(profile.durations[1]),
    ];
    if braking != [0, 0] {
        let jerk = stepped(round_i64(profile.jerks[0]), 1);
        for (ticks, jerk) in [(braking[0], jerk), (braking[1], 0)] {
            run(track, &mut axis, ticks, jerk)?;
        }
        task = self::task(&axis, target);
        let left = duration - ticks_to_f32(braking[0] + braking[1]);
        profile = AxisProfile::lasting(&task, limits, left).ok()?;
    }
    let mut shape = Shape::new(&profile);
    let mut peak = shape.solve(&rough_task(&axis, target), limits)?;
    let begun = track.len();
    for closing in 0..=CLOSINGS {
        let mut end = axis;
        track.truncate(begun);
        shape.run(track, &mut end, peak)?;
        if closing < CLOSINGS {
            let missing = i128_to_f32_fast(target - end.position);
            peak = peak.wrapping_add(round_i64(missing / Hats::new(&shape).gain));
        }
    }
    Some(())
}

/// What is to be done, in 2^-72 units and ticks.
pub(crate) fn task(axis: &AxisState, target: i128) -> Task {
    Task {
        distance: (target - axis.position) as f64,
        velocity: axis.velocity as f64,
        acceleration: axis.acceleration as f64,
    }
}

/// The same in single precision.
fn rough_task(axis: &AxisState, target: i128) -> Task<f32> {
    Task {
        distance: i128_to_f32_fast(target - axis.position),
        velocity: i64_to_f32_fast(axis.velocity),
        acceleration: i64_to_f32_fast(axis.acceleration),
    }
}

#[inline(never)]
fn run(track: &mut Track, axis: &mut AxisState, ticks: u64, jerk: i64) -> Option<()> {
    if ticks > 0 {
        *axis = axis.after(ticks, jerk, 0);
        track.push((ticks, jerk)).ok()?;
    }
    Some(())
}

impl Shape {
    fn new(profile: &AxisProfile<f32>) -> Self {
        // A duration that is whole but for rounding errors is not rounded up.
        let up = |duration: f32| ceil_ticks(duration - 1e-3_f32.fmin(duration * 1e-6));
        let t = &profile.durations[2..];
        let mut n = [0; 7];
        for k in [0, 2, 4, 6] {
            // Jerks need a tick each to act in.
            n[k] = up(t[k]).max(1);
        }
        if profile.released_in_part {
            n[2] = 0;
        }
        // What the ramps are longer, a peak may be shorter: half of it gains the same speed; and at constant speed, the
        // way.
        let longer = |n: &[u64; 7], k: usize| ticks_to_f32(n[k]) - t[k];
        n[1] = up(t[1] - (longer(&n, 0) + longer(&n, 2)) / 2.0);
        n[5] = up(t[5] - (longer(&n, 4) + longer(&n, 6)) / 2.0);
        let all = [0, 1, 2, 4, 5, 6].map(|k| longer(&n, k));
        n[3] = up(t[3] - all.iter().sum::<f32>() / 2.0);
        if profile.released_in_part {
            n[1..4].fill(0);
        }
        Self {
            n,
            released_in_part: profile.released_in_part,
        }
    }

    /// The peak of acceleration, after lengthening what is over a limit.
    fn solve(&mut self, task: &Task<f32>, limits: &AxisLimits<f32>) -> Option<i64> {
        for _ in 0..MOST_ROUNDS {
            let hats = Hats::new(self);
            let solution = hats.solution(task)?;
            if !self.lengthen(task, limits, &solution) {
                // A brake that is only released in part has no peak to lengthen.
                let most = limits.acceleration.fmax(task.acceleration.abs());
                return (solution.peak.abs() <= most * FIT_SLACK).then(|| round_i64(solution.peak));
            }
        }
        None
    }

    /// Runs the segments with this peak.
    fn run(&self, track: &mut Track, axis: &mut AxisState, peak: i64) -> Option<()> {
        let n = self.n;
        let first = stepped(peak - axis.acceleration, n[0] as i64);
        run(track, axis, n[0], first)?;
        if !self.released_in_part {
            run(track, axis, n[1], 0)?;
            let back = stepped(-axis.acceleration, n[2] as i64);
            run(track, axis, n[2], back)?;
            run(track, axis, n[3], 0)?;
        }
        let [brake, release] = jerks(axis, [n[4], n[5], n[6]]);
        run(track, axis, n[4], brake)?;
        run(track, axis, n[5], 0)?;
        run(track, axis, n[6], release)
    }

    /// A start near its peak goes down to it in the time of the peak: that much longer, the whole would only ask for a
    /// still lower peak. As it does a little even so, by twice the time at once. Whether there was time left to take.
    fn take_from_peak(&mut self, ticks: u64) -> bool {
        let (k, least) = if self.n[1] > 0 { (1, 0) } else { (2, 1) };
        let more = ticks.max(self.n[0]).min(self.n[k].saturating_sub(least));
        self.n[k] -= more;
        self.n[0] += more;
        more > 0
    }

    /// Rounding a long brake up can turn a short peak over: it brakes too, and lengthening it would only add to the way
    /// that it has to make up for. From it the acceleration then goes on to the brake's, not by way of zero.
    fn go_on_to_the_brake(&mut self) {
        self.released_in_part = true;
        self.n[0] += self.n[2] + self.n[3];
        self.n[2..4].fill(0);
    }

    /// Whether something had to be lengthened.
    fn lengthen(
        &mut self,
        task: &Task<f32>,
        limits: &AxisLimits<f32>,
        solution: &Solution,
    ) -> bool {
        let Solution { peak, brake, top } = *solution;
        let start = task.acceleration;
        let part = self.released_in_part;
        let mut longer = false;
        let (release, press) = if part {
            ((4, brake - peak), (4, brake - peak))
        } else {
            ((2, peak), (4, brake))
        };
        for (k, change) in [(0, peak - start), release, press, (6, brake)] {
            if change.abs() > limits.jerk * FIT_SLACK * ticks_to_f32(self.n[k]) {
                let now = self.n[k];
                let enough = change.abs() / limits.jerk;
                let longest = ceil_ticks(sqrt_f32(enough * ticks_to_f32(now))).max(now + 1);
                longer = true;
                let turned = !part && self.n[1] == 0 && peak * brake > 0.0;
                if k < 4 && turned && self.n[3] < longest - now {
                    self.go_on_to_the_brake();
                    return true;
                }
                let down = k == 0 && peak * start > 0.0 && peak.abs() < start.abs();
                if down && self.take_from_peak(longest - now) {
                    continue;
                }
                if k < 4 && top.abs() < limits.velocity {
                    self.n[3] = self.n[3].saturating_sub(longest - now);
                }
                self.n[k] = longest;
            }
        }
        let hardest = limits.acceleration.fmax(start.abs()) * FIT_SLACK;
        for (k, acceleration) in [(1, peak), (5, brake)] {
            if acceleration.abs() > hardest && !(part && k == 1) {
                self.n[k] += 1;
                // Where the peak brakes, another tick of it is more way to be made up for, unless it is one less at
                // speed.
                if k == 1 && peak * brake > 0.0 {
                    self.n[3] = self.n[3].saturating_sub(1);
                }
                longer = true;
            }
        }
        // The brake released in part leads to no speed in between.
        let fastest = limits.velocity.fmax(task.velocity.abs()) * FIT_SLACK;
        if !part && top.abs() > fastest && !longer {
            let whole: u64 = self.n.iter().sum();
            let over = top.abs() / limits.velocity - 1.0;
            self.n[3] += 1 + (over * ticks_to_f32(whole) / 2.0) as u64;
            longer = true;
        }
        longer
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::plan::axis_state::JERK_STEP;
    use crate::motion::profile::whole_ticks::*;
    use std::vec::Vec;

    /// 10 mm/s, 200 mm/s^2 and 20 m/s^3 or so.
    const LIMITS: AxisLimits<f32> = AxisLimits {
        velocity: 2.5e16,
        acceleration: 2.2e13,
        jerk: 2.2e11,
    };

    /// An axis with these parts of the limits, and what it is to go, in ways that a stop from full speed takes.
    fn state(velocity: f64, acceleration: f64, way: f64) -> (AxisState, i128) {
        let [v, a, j] = [LIMITS.velocity, LIMITS.acceleration, LIMITS.jerk].map(f64::from);
        let axis = AxisState {
            position: 5 << 70,
            velocity: (velocity * v) as i64,
            acceleration: (acceleration * a) as i64 / JERK_STEP * JERK_STEP,
        };
        (axis, (way * v * (v / a + a / j) / 2.0) as i128)
    }

    /// The track, its ticks, and those of the fastest profile; limits and end are checked.
    fn fitted(velocity: f64, acceleration: f64, way: f64) -> Option<(u64, f32)> {
        let (axis, way) = state(velocity, acceleration, way);
        let target = axis.position + way;
        let profile = AxisProfile::fastest(&task(&axis, target), &LIMITS).unwrap();
        let mut track = Track::new();
        fit(&mut track, axis, way, &LIMITS, profile.duration())?;
        let mut end = axis;
        for &(ticks, jerk) in &track {
            assert!((jerk as f32).abs() <= LIMITS.jerk * 1.000_01, "{track:?}");
            end = end.after(ticks, jerk, 0);
            assert!(
                (end.acceleration as f32).abs() <= LIMITS.acceleration * 1.000_01,
                "{velocity} {acceleration} {way} {track:?}"
            );
            assert!(
                (end.velocity as f32).abs() <= LIMITS.velocity * 1.000_01,
                "{track:?}"
            );
        }
        // Jerks are multiples of six: what they leave is far below a unit of a position (2^40).
        assert!(end.acceleration.abs() < 1 << 14, "{end:?}");
        assert!(end.velocity.abs() < 1 << 24, "{end:?}");
        let off = (end.position - target).unsigned_abs();
        assert!(off < 1 << 39, "{off} of {way} {track:?}");
        Some((
            track.iter().map(|(ticks, _)| ticks).sum(),
            profile.duration(),
        ))
    }

    /// From -1 to 1, the same every time.
    fn numbers() -> impl FnMut() -> f64 {
        let mut random = 7_u64;
        move || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn nothing_to_do_is_no_track() {
        let axis = AxisState::at_rest(3);
        let mut track = Track::new();
        fit(&mut track, axis, 0, &LIMITS, 100.0).unwrap();
        assert!(track.is_empty());
    }

    #[test]
    fn a_longer_duration_is_kept() {
        let (axis, way) = state(0.3, -0.2, 8.0);
        for duration in [20_000.0, 30_000.0] {
            let mut track = Track::new();
            fit(&mut track, axis, way, &LIMITS, duration).unwrap();
            let ticks: u64 = track.iter().map(|(ticks, _)| ticks).sum();
            assert!(ticks.abs_diff(duration as u64) < 10, "{ticks}");
        }
    }

    /// Braking first, which rounding may put over the limit of acceleration.
    #[test]
    fn a_slower_one_is_found_as_well() {
        let mut next = numbers();
        let mut none = 0;
        for _ in 0..40_000 {
            let (axis, way) = state(next() * 0.9, next() * 0.4, 2.0 * next());
            let fastest = AxisProfile::fastest(&task(&axis, axis.position + way), &LIMITS).unwrap();
            let duration = fastest.duration() * (2.0 + next() as f32);
            none += u32::from(fit(&mut Track::new(), axis, way, &LIMITS, duration).is_none());
        }
        println!("{none} not at all");
        assert!(none < 5);
    }

    #[test]
    fn in_whole_ticks_it_takes_a_few_ticks_more() {
        let mut next = numbers();
        let (mut more, mut none) = (Vec::new(), 0);
        for _ in 0..4_000 {
            let (v, a) = (next(), next());
            // What an acceleration under way leads to is within the limit too.
            let released = v + a * a.abs() / 2.0 * f64::from(LIMITS.acceleration).powi(2)
                / f64::from(LIMITS.jerk * LIMITS.velocity);
            if released.abs() > 1.0 {
                continue;
            }
            match fitted(v, a, next() * 10_f64.powf(2.0 * next())) {
                Some((ticks, least)) => more.push(ticks as f32 - least),
                None => none += 1,
            }
        }
        more.sort_by(f32::total_cmp);
        let [middle, late, last] = [more.len() / 2, more.len() * 99 / 100, more.len() - 1];
        let [middle, late, last] = [middle, late, last].map(|k| more[k]);
        println!("ticks more: median {middle}, 99 % {late}, worst {last}; {none} not at all");
        // Just beyond the fastest stop, out of an acceleration, there is little to choose from.
        assert!(middle < 3.0 && late < 10.0 && last < 150.0 && none < 5);
    }

    /// There the short peak before a long brake has to make up for what rounding adds to the brake.
    #[test]
    fn just_beyond_the_fastest_stop_it_takes_a_few_ticks_more() {
        let [v, a, j] = [LIMITS.velocity, LIMITS.acceleration, LIMITS.jerk].map(f64::from);
        let (mut most, mut none) = (0.0_f32, 0);
        for (speed, beyond) in (1..=20).flat_map(|v| (10..200).map(move |ticks| (v, ticks))) {
            let speed = f64::from(speed) / 20.0;
            let stop = speed * (speed * v / a + a / j) + speed * f64::from(beyond);
            match fitted(speed, 0.0, stop / (v / a + a / j)) {
                Some((ticks, least)) => most = most.max(ticks as f32 - least),
                None => none += 1,
            }
        }
        println!("worst {most} ticks more; {none} not at all");
        assert!(most < 5.0 && none < 5);
    }

    /// At the limit of speed nothing may be added, and a tick too many is much to shed: over two ramps, not in two
    /// ticks.
    #[test]
    fn at_the_limit_of_speed_it_takes_a_few_ticks_more() {
        for (v, a, way) in [(1.0, 0.0, 4.25), (0.999_9, 0.0, 40.1), (0.969, 0.06, 6.2)] {
            let (ticks, least) = fitted(v, a, way).unwrap();
            assert!(ticks as f32 - least < 25.0, "{v} {a}: {ticks} {least}");
        }
    }
}
