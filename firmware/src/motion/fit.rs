//! From an axis profile to jerks over whole ticks, exact in integers.
//!
//! The profile's durations are rounded up to whole ticks. With these fixed, the acceleration is a broken line through the
//! start's, a peak `P` and a brake `Q`, and zero at the end; speed and position at the end are linear in `P` and `Q`:
//! `v + a f0 + P f1 + Q f2 = 0` and `v n + a g0 + P g1 + Q g2 = d`, where `f` are the areas of the hats of the broken line and
//! `g` their moments about the end. Two equations, two unknowns. Where rounding has put an acceleration, a jerk or a speed
//! over its limit, the segment concerned is lengthened.

use super::axis::{Axis, JERK_STEP};
use super::axis_profile::{AxisLimits, AxisProfile, SEGMENTS, Task};
use super::stop::jerks;
use heapless::Vec;

/// Stretches of constant jerk of one axis: ticks, and jerk in 2^-72 units per tick cubed.
pub(super) type Track = Vec<(u64, i64), SEGMENTS>;

/// Durations of the main segments in ticks.
struct Shape {
    n: [u64; 7],
    released_in_part: bool,
}

/// Peak, brake, and the speed between.
struct Solution {
    peak: f64,
    brake: f64,
    top: f64,
}

/// How often a segment may have to be lengthened.
const MOST_ROUNDS: usize = 40;
/// How much of a limit is granted to roundings.
const SLACK: f64 = 1.0 + 1e-4;

/// The track of an axis over `way` (2^-72 units) to rest in about `duration` ticks; `None` where the state allows none.
pub(super) fn fit(mut axis: Axis, way: i128, limits: &AxisLimits, duration: f64) -> Option<Track> {
    let mut track = Track::new();
    if axis.velocity == 0 && axis.acceleration == 0 && way == 0 {
        return Some(track);
    }
    let target = axis.position + way;
    let mut task = task(&axis, target);
    let mut profile = AxisProfile::lasting(&task, limits, duration).ok()?;
    let braking = [
        profile.durations[0] as u64,
        libm::ceil(profile.durations[1]) as u64,
    ];
    if braking != [0, 0] {
        let jerk = whole(profile.jerks[0]);
        for (ticks, jerk) in [(braking[0], jerk), (braking[1], 0)] {
            run(&mut track, &mut axis, ticks, jerk)?;
        }
        task = self::task(&axis, target);
        let left = duration - (braking[0] + braking[1]) as f64;
        profile = AxisProfile::lasting(&task, limits, left).ok()?;
    }
    let mut shape = Shape::new(&profile);
    let solution = shape.solve(&task, limits)?;
    let Shape {
        n,
        released_in_part,
    } = shape;
    let first = whole((solution.peak - task.acceleration) / n[0] as f64);
    run(&mut track, &mut axis, n[0], first)?;
    if !released_in_part {
        run(&mut track, &mut axis, n[1], 0)?;
        let back = whole(-(axis.acceleration as f64) / n[2] as f64);
        run(&mut track, &mut axis, n[2], back)?;
        run(&mut track, &mut axis, n[3], 0)?;
    }
    let [brake, release] = jerks(&axis, [n[4], n[5], n[6]]);
    run(&mut track, &mut axis, n[4], brake)?;
    run(&mut track, &mut axis, n[5], 0)?;
    run(&mut track, &mut axis, n[6], release)?;
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

/// The nearest jerk that the integers follow exactly.
fn whole(jerk: f64) -> i64 {
    libm::rint(jerk / JERK_STEP as f64) as i64 * JERK_STEP
}

fn run(track: &mut Track, axis: &mut Axis, ticks: u64, jerk: i64) -> Option<()> {
    if ticks > 0 {
        *axis = axis.after(ticks, jerk, 0);
        track.push((ticks, jerk)).ok()?;
    }
    Some(())
}

impl Shape {
    fn new(profile: &AxisProfile) -> Self {
        let mut n = [0; 7];
        for (k, (ticks, duration)) in n.iter_mut().zip(&profile.durations[2..]).enumerate() {
            // A duration that is whole but for rounding errors is not rounded up. Jerks need a tick each to act in.
            let least = if k % 2 == 0 { 1.0 } else { 0.0 };
            *ticks = libm::ceil(duration - 1e-6).max(least) as u64;
        }
        if profile.released_in_part {
            n[1..4].fill(0);
        }
        Self {
            n,
            released_in_part: profile.released_in_part,
        }
    }

    /// Solves, lengthening what is over a limit.
    fn solve(&mut self, task: &Task, limits: &AxisLimits) -> Option<Solution> {
        for _ in 0..MOST_ROUNDS {
            let solution = self.solution(task)?;
            if !self.lengthen(task, limits, &solution) {
                return Some(solution);
            }
        }
        None
    }

    fn solution(&self, task: &Task) -> Option<Solution> {
        let n = self.n.map(|ticks| ticks as f64);
        let whole: f64 = n.iter().sum();
        let [start_v, start_a] = [task.velocity, task.acceleration];
        // Area and moment about the end of a triangle or an oblong that begins at `at`; `lean` is where its centroid lies.
        let (mut f, mut g) = ([0.0; 3], [0.0; 3]);
        let mut add = |hat: usize, at: f64, ticks: f64, part: f64, lean: f64| {
            f[hat] += part * ticks;
            g[hat] += part * ticks * (whole - at - lean * ticks);
        };
        let (falling, rising) = (1.0 / 3.0, 2.0 / 3.0);
        add(0, 0.0, n[0], 0.5, falling);
        add(1, 0.0, n[0], 0.5, rising);
        let brake = n[0] + n[1] + n[2] + n[3];
        if self.released_in_part {
            add(1, brake, n[4], 0.5, falling);
        } else {
            add(1, n[0], n[1], 1.0, 0.5);
            add(1, n[0] + n[1], n[2], 0.5, falling);
        }
        add(2, brake, n[4], 0.5, rising);
        add(2, brake + n[4], n[5], 1.0, 0.5);
        add(2, brake + n[4] + n[5], n[6], 0.5, falling);
        let speed = -(start_v + start_a * f[0]);
        let way = task.distance - start_v * whole - start_a * g[0];
        let det = f[1] * g[2] - f[2] * g[1];
        let peak = (speed * g[2] - way * f[2]) / det;
        let brake = (way * f[1] - speed * g[1]) / det;
        let top = start_v + start_a * f[0] + peak * f[1];
        (peak.is_finite() && brake.is_finite()).then_some(Solution { peak, brake, top })
    }

    /// Whether something had to be lengthened.
    fn lengthen(&mut self, task: &Task, limits: &AxisLimits, solution: &Solution) -> bool {
        let Solution { peak, brake, top } = *solution;
        let part = self.released_in_part;
        let mut longer = false;
        let mut jerks = [
            (0, peak - task.acceleration),
            (2, peak),
            (4, brake),
            (6, brake),
        ];
        if part {
            jerks[1] = (4, brake - peak);
            jerks[2] = jerks[1];
        }
        for (k, change) in jerks {
            if change.abs() > limits.jerk * SLACK * self.n[k] as f64 {
                self.n[k] = (libm::ceil(change.abs() / limits.jerk) as u64).max(self.n[k] + 1);
                longer = true;
            }
        }
        let hardest = limits.acceleration.max(task.acceleration.abs()) * SLACK;
        for (k, acceleration) in [(1, peak), (5, brake)] {
            if acceleration.abs() > hardest && !(part && k == 1) {
                self.n[k] += 1;
                longer = true;
            }
        }
        // The brake released in part leads to no speed in between.
        if !part && top.abs() > limits.velocity * (1.0 + 1e-3) && !longer {
            let whole: u64 = self.n.iter().sum();
            let over = top.abs() / limits.velocity - 1.0;
            self.n[3] += 1 + (over * whole as f64 / 2.0) as u64;
            longer = true;
        }
        longer
    }
}
