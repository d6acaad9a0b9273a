//! What a plan may do, by what it is for: the speed that was in force when it was made, and how it may brake.

use super::quantities::{Pair, accelerations, speeds};
use crate::gcs_bench::axes::Course;
use crate::motion_bench::LIMITS;

/// What a plan is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Purpose {
    /// A target, a velocity, a smooth stop: within the ordinary limits.
    #[default]
    Ordinary,
    /// Streamed targets, running waveforms: the jerk is the sender's own business.
    Stream,
    /// As hard as the pivots can follow.
    UrgentStop,
}

impl Purpose {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "in an ordinary plan",
            Self::Stream => "in a plan of a stream",
            Self::UrgentStop => "in an urgent stop",
        }
    }
}

/// What a plan may do.
#[derive(Clone, Debug, Default)]
pub struct Allowance {
    pub purpose: Purpose,
    /// Speed limits.
    pub speeds: Pair,
    /// The limits that hold as soon as the motion is inside, where it began above them.
    pub lowered: [Option<f64>; 2],
    /// Speed limits of x and y.
    pub axis_speeds: [f64; 2],
    /// How long the plan lasts.
    pub ticks: u64,
    /// Largest acceleration of the plan from its start to its end.
    pub peaks: Pair,
}

impl Allowance {
    /// A plan that takes over from one with a higher limit of speed may keep to that one until it has slowed down.
    pub fn begin_above(&mut self, before: &Pair, speeds: &Pair, accelerations: &Pair) {
        for i in 0..2 {
            let limit = self.speeds[i];
            let reached = inevitable_speed(speeds[i], accelerations[i], JERKS[i]);
            if limit < before[i] && reached > limit {
                self.lowered[i] = Some(limit);
                self.speeds[i] = before[i];
            }
        }
    }

    /// Takes the limits back that the motion was above, where it is inside by now and stays inside.
    pub fn narrow(&mut self, speeds: &Pair, accelerations: &Pair) {
        for i in 0..2 {
            let reached = inevitable_speed(speeds[i], accelerations[i], JERKS[i]);
            if let Some(limit) = self.lowered[i].take_if(|limit| reached <= *limit) {
                self.speeds[i] = limit;
            }
        }
    }
}

/// Limits of jerk.
pub const JERKS: Pair = [LIMITS.jerk_mm_s3, LIMITS.turn_jerk_deg_s3];

/// The speed that is reached when an acceleration is taken back by the ordinary jerk.
fn inevitable_speed(speed: f64, acceleration: f64, jerk: f64) -> f64 {
    speed + acceleration * acceleration / (2.0 * jerk)
}

/// No stop takes as many ticks; a constant velocity has a plan for years.
const LONGEST_STOP: u64 = 100_000;

/// Whether a plan does what a stop does: translation and rotation get little faster than what their start leads to. One of
/// them may have to wait for the other.
pub fn only_brakes(course: &Course) -> bool {
    if course.plan.ticks() > LONGEST_STOP {
        return false;
    }
    let (v, a) = (speeds(&course.start), accelerations(&course.start));
    let highest = [0, 1].map(|i| inevitable_speed(v[i], 2.0 * a[i], JERKS[i]) + 1e-3);
    let mut all = states(course);
    all.all(|axes| {
        let speeds = speeds(&axes);
        speeds[0] <= highest[0] && speeds[1] <= highest[1]
    })
}

/// Largest acceleration of a plan.
pub fn peaks(course: &Course) -> Pair {
    states(course).fold([0.0; 2], |peaks, axes| {
        let now = accelerations(&axes);
        [peaks[0].max(now[0]), peaks[1].max(now[1])]
    })
}

/// A plan tick by tick.
fn states(course: &Course) -> impl Iterator<Item = [firmware::motion::AxisState; 3]> + '_ {
    let ticks = course.plan.ticks();
    (0..=ticks).map(|tick| course.plan.state_after(&course.start, tick))
}
