//! From an axis profile to jerks over whole ticks, exact in integers.
//!
//! The profile's durations are rounded up to whole ticks. With these fixed, the acceleration is a broken line through the
//! start's, a peak `P` and a brake `Q`, and zero at the end; speed and position at the end are linear in `P` and `Q`:
//! `v + a f0 + P f1 + Q f2 = 0` and `v n + a g0 + P g1 + Q g2 = d`, where `f` are the areas of the hats of the broken line and
//! `g` their moments about the end ([`Hats`]). Two equations, two unknowns, in floats. Where rounding has put an acceleration,
//! a jerk or a speed over its limit, the segment concerned is lengthened.
//!
//! The integers then close what the floats left: the segments are run exactly up to the brake, the brake is the one that
//! comes to rest from there, and the way that is missing is made up by another `P`.

use super::axis::Axis;
use super::axis_profile::{AxisLimits, AxisProfile, SEGMENTS, Task};
use super::brake::{jerks, stepped};
use super::float::{Order, float, nearest, ticks_up};
use super::hats::Hats;
use heapless::Vec;

/// Stretches of constant jerk of one axis: ticks, and jerk in 2^-72 units per tick cubed.
pub(super) type Track = Vec<(u64, i64), SEGMENTS>;

/// Durations of the main segments in ticks.
pub(super) struct Shape {
    pub n: [u64; 7],
    pub released_in_part: bool,
}

/// How often segments may have to be lengthened.
const MOST_ROUNDS: usize = 24;
/// How often the way that is missing is made up for. Each time it becomes a millionth.
const CLOSINGS: usize = 1;
/// How much of a limit is granted to the roundings of floats.
const SLACK: f32 = 1.0 + 5e-7;

/// The track of an axis over `way` (2^-72 units) to rest in about `duration` ticks, or as soon as it can; `None` where the
/// state allows none.
pub(super) fn fit(
    mut axis: Axis,
    way: i128,
    limits: &AxisLimits<f32>,
    duration: f32,
) -> Option<Track> {
    let mut track = Track::new();
    if axis.velocity == 0 && axis.acceleration == 0 && way == 0 {
        return Some(track);
    }
    let target = axis.position + way;
    let mut task = task(&axis, target);
    let mut profile = AxisProfile::lasting(&task, limits, duration).ok()?;
    let braking = [profile.durations[0] as u64, ticks_up(profile.durations[1])];
    if braking != [0, 0] {
        let jerk = stepped(nearest(profile.jerks[0]), 1);
        for (ticks, jerk) in [(braking[0], jerk), (braking[1], 0)] {
            run(&mut track, &mut axis, ticks, jerk)?;
        }
        task = self::task(&axis, target);
        let left = duration - float(braking[0] + braking[1]);
        profile = AxisProfile::lasting(&task, limits, left).ok()?;
    }
    let mut shape = Shape::new(&profile);
    let mut peak = shape.solve(&task, limits)?;
    let begun = track.len();
    for closing in 0..=CLOSINGS {
        let mut end = axis;
        track.truncate(begun);
        shape.run(&mut track, &mut end, peak)?;
        if closing < CLOSINGS {
            let missing = (target - end.position) as f32;
            peak = peak.wrapping_add(nearest(missing / Hats::new(&shape).gain));
        }
    }
    Some(track)
}

/// What is to be done, in 2^-72 units and ticks.
pub(super) fn task(axis: &Axis, target: i128) -> Task {
    Task {
        distance: (target - axis.position) as f64,
        velocity: axis.velocity as f64,
        acceleration: axis.acceleration as f64,
    }
}

pub(super) fn run(track: &mut Track, axis: &mut Axis, ticks: u64, jerk: i64) -> Option<()> {
    if ticks > 0 {
        *axis = axis.after(ticks, jerk, 0);
        track.push((ticks, jerk)).ok()?;
    }
    Some(())
}

impl Shape {
    fn new(profile: &AxisProfile<f32>) -> Self {
        let mut n = [0; 7];
        for (k, (ticks, duration)) in n.iter_mut().zip(&profile.durations[2..]).enumerate() {
            // A duration that is whole but for rounding errors is not rounded up. Jerks need a tick each to act in.
            let least = if k % 2 == 0 { 1 } else { 0 };
            *ticks = ticks_up(duration - 1e-3_f32.smaller(duration * 1e-6)).max(least);
        }
        if profile.released_in_part {
            n[1..4].fill(0);
        }
        Self {
            n,
            released_in_part: profile.released_in_part,
        }
    }

    /// The peak of acceleration, after lengthening what is over a limit.
    fn solve(&mut self, task: &Task, limits: &AxisLimits<f32>) -> Option<i64> {
        for _ in 0..MOST_ROUNDS {
            let hats = Hats::new(self);
            let solution = hats.solution(task)?;
            if !self.lengthen(task, limits, &solution) {
                return Some(nearest(solution.peak));
            }
        }
        None
    }

    /// Runs the segments with this peak.
    fn run(&self, track: &mut Track, axis: &mut Axis, peak: i64) -> Option<()> {
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

    /// A start near its peak goes down to it in the time of the peak: that much longer, the whole would only ask for a still
    /// lower peak.
    fn take_from_peak(&mut self, ticks: u64) {
        for (k, least) in [(1, 0), (2, 1)] {
            if self.n[k] >= ticks + least {
                self.n[k] -= ticks;
                return;
            }
        }
    }

    /// Whether something had to be lengthened.
    fn lengthen(&mut self, task: &Task, limits: &AxisLimits<f32>, solution: &Solution) -> bool {
        let Solution { peak, brake, top } = *solution;
        let start = task.acceleration as f32;
        let part = self.released_in_part;
        let mut longer = false;
        let (release, press) = if part {
            ((4, brake - peak), (4, brake - peak))
        } else {
            ((2, peak), (4, brake))
        };
        for (k, change) in [(0, peak - start), release, press, (6, brake)] {
            if change.abs() > limits.jerk * SLACK * float(self.n[k]) {
                let longest = ticks_up(change.abs() / limits.jerk).max(self.n[k] + 1);
                if k == 0 && peak * start > 0.0 && peak.abs() < start.abs() {
                    self.take_from_peak(longest - self.n[k]);
                }
                self.n[k] = longest;
                longer = true;
            }
        }
        let hardest = limits.acceleration.larger(start.abs()) * SLACK;
        for (k, acceleration) in [(1, peak), (5, brake)] {
            if acceleration.abs() > hardest && !(part && k == 1) {
                self.n[k] += 1;
                longer = true;
            }
        }
        // The brake released in part leads to no speed in between.
        let fastest = limits.velocity.larger((task.velocity as f32).abs()) * SLACK;
        if !part && top.abs() > fastest && !longer {
            let whole: u64 = self.n.iter().sum();
            let over = top.abs() / limits.velocity - 1.0;
            self.n[3] += 1 + (over * float(whole) / 2.0) as u64;
            longer = true;
        }
        longer
    }
}

/// Peak, brake, and the speed between.
pub(super) struct Solution {
    pub peak: f32,
    pub brake: f32,
    pub top: f32,
}
