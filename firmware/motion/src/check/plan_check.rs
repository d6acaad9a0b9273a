//! Holds the pieces of a plan against every limit, interval by interval.

use super::interval::{IntervalBounds, IntervalEnd, Violation};
use super::pivots::PivotGain;
use crate::constraints::{Bounds, Constraints, MotionLimits, Speeds};
use crate::plan::Piece;
use crate::plan::axis_state::AxisState;
use crate::plan::cubic_segment::{CubicSegment, MotionState};
use crate::tolerances::{JERK_TOLERANCE, PLAN_SLACK, STATE_SLACK, STREAM_SLACK, WORKSPACE_RADII};
use number::float::{FloatMinMax, hypot, ticks_to_f32, truncate};
use number::sqrt_f32;

/// What a plan is held against.
pub struct PlanCheck {
    /// Of translation, track radii per second (squared, cubed), and of rotation, rad.
    motion_limits: MotionLimits,
    /// What is granted over a limit.
    slack: f32,
    /// Rate and acceleration, rad/s and rad/s^2.
    pivots: [f32; 2],
    /// Of the disk for the platform's centre; bounds of the moved point.
    radius: f32,
    bounds: Bounds,
    /// The moved point in the platform's axes, and its distance from the platform's centre.
    centre: [f32; 2],
    arm: f32,
    hz: f32,
}

/// Intervals of one plan that may be looked at before the next failure counts.
pub const BUDGET: usize = 60;

/// Intervals of one plan at most: a way of many turns that asks for more is not worth the time. A stop waits meanwhile.
const MOST_INTERVALS: usize = 1_000;

/// Pieces up to this many ticks have no middle to sample.
const SHORT: u64 = 200;

/// An interval is not cut shorter than this many ticks: what happens in 0.2 ms is less than the slack.
const SHORTEST: u64 = 4;

/// By how much an interval is longer than the one before, at most; how much shorter where a path's limit is not kept; what
/// is used of a rise, because the value changes too.
const LONGER: f32 = 4.0;
const SHORTER: f32 = 0.5;
const PART_OF_RISE: f32 = 0.75;

impl PlanCheck {
    /// The check of an ordinary motion, or of the state at the start where that lies outside: it may have been planned
    /// with other limits, and can only be left.
    pub fn new(constraints: &Constraints, start: &[AxisState; 3]) -> Self {
        let limits = constraints.motion_limits();
        let now = MotionState::new(start, constraints.limits.rate_hz as f32);
        // What is granted over a limit is not granted over a state again: it would add up from plan to plan.
        let kept = |state: &[f32; 3]| Speeds::of(state).scaled(1.0 / PLAN_SLACK);
        let limits = MotionLimits {
            speed: limits.speed.max(kept(&now.v)),
            acceleration: limits.acceleration.max(kept(&now.a)),
            jerk: limits.jerk,
        };
        Self::with(constraints, limits, PLAN_SLACK)
    }

    /// The check of a stop: of what an ordinary motion keeps to, acceleration and jerk are its own; of an urgent one speed
    /// too.
    pub fn for_stop(constraints: &Constraints, start: &[AxisState; 3], urgent: bool) -> Self {
        const ANY: Speeds = Speeds {
            linear: f32::INFINITY,
            angular: f32::INFINITY,
        };
        let mut plan_check = Self::new(constraints, start);
        let limits = &mut plan_check.motion_limits;
        (limits.acceleration, limits.jerk) = (ANY, ANY);
        if urgent {
            limits.speed = ANY;
        }
        plan_check
    }

    /// The check of a motion that others shape, and of the stop that ends it.
    pub fn for_stream(constraints: &Constraints) -> Self {
        let limits = constraints.motion_limits().scaled(1.0, JERK_TOLERANCE);
        Self::with(constraints, limits, STREAM_SLACK)
    }

    fn with(constraints: &Constraints, motion_limits: MotionLimits, slack: f32) -> Self {
        let limits = &constraints.limits;
        let centre = constraints.centre();
        Self {
            motion_limits,
            slack,
            pivots: [
                limits.pivot_rate_rad_s as f32,
                limits.pivot_acceleration_rad_s2 as f32,
            ],
            radius: constraints.usable_radius as f32,
            bounds: constraints.bounds,
            centre,
            arm: hypot(centre[0], centre[1]),
            hz: limits.rate_hz as f32,
        }
    }

    /// Whether a motion by the pieces of a plan from `start` keeps to everything. The plan's nudge does not show in it.
    /// What is taken is taken off the budget of intervals.
    #[inline(never)]
    pub fn check(
        &self,
        pieces: &[Piece],
        start: &[AxisState; 3],
        budget: &mut usize,
    ) -> Result<(), Violation> {
        let mut looked_at = 0;
        // How far each axis may go down and up.
        let room = each!(i => {
            self.bounds[i].map(|bound| MotionState::way(i, bound.saturating_sub(start[i].rounded())))
        });
        let mut segment = CubicSegment::new(start, self.hz);
        let mut from = self.evaluate(&segment, 0);
        for piece in pieces {
            segment.start = from.sample;
            segment.jerk = CubicSegment::jerk(piece, self.hz);
            let [x, y, theta] = segment.jerk;
            let jerk = [hypot(x, y), theta.abs()];
            self.within(jerk, &self.motion_limits.jerk, Violation::Jerk)?;
            if piece.ticks == 1 {
                // What a tick changes does not show, nor what some of them do, one after the other.
                from = self.evaluate(&segment, 1);
                continue;
            }
            let (mut done, mut ticks) = (0, piece.ticks);
            while done < piece.ticks {
                ticks = ticks.min(piece.ticks - done);
                *budget = budget.saturating_sub(1);
                looked_at += 1;
                if looked_at > MOST_INTERVALS {
                    return Err(Violation::TooLong);
                }
                let mut to = self.evaluate(&segment, done + ticks);
                let seconds = ticks_to_f32(ticks) / self.hz;
                let change =
                    match self.interval(&segment, jerk, &room, [&mut from, &mut to], seconds) {
                        Ok(longer) => {
                            from = to;
                            done += ticks;
                            longer
                        }
                        Err((_, shorter)) if shorter > 0.0 && ticks > SHORTEST && *budget > 0 => {
                            shorter
                        }
                        Err((broken, _)) => return Err(broken),
                    };
                ticks = (truncate(ticks_to_f32(ticks) * change) as u64).max(SHORTEST);
            }
        }
        Ok(())
    }

    fn evaluate(&self, segment: &CubicSegment, ticks: u64) -> IntervalEnd {
        let sample = segment.at(ticks_to_f32(ticks) / self.hz);
        let MotionState { v, a, .. } = sample;
        IntervalEnd {
            centre_distance: if self.arm > 0.0 {
                segment.platform(&sample, self.centre).radius()
            } else {
                let [x, y] = segment.point(&sample);
                hypot(x, y)
            },
            v: [hypot(v[0], v[1]), v[2].abs()],
            a: [hypot(a[0], a[1]), a[2].abs()],
            sample,
            pivots: None,
        }
    }

    /// The largest parts of their limits of rate and of acceleration that the pivots reach: at the start, and at the ends
    /// and in the middle of the pieces; in short ones the ends tell enough.
    pub fn pivot_parts(&self, pieces: &[Piece], start: &[AxisState; 3]) -> [f32; 2] {
        let mut segment = CubicSegment::new(start, self.hz);
        let mut parts = [0.0; 2];
        self.look(&segment, 0.0, &mut parts);
        for piece in pieces {
            segment.jerk = CubicSegment::jerk(piece, self.hz);
            let seconds = ticks_to_f32(piece.ticks) / self.hz;
            if piece.ticks > SHORT {
                self.look(&segment, seconds / 2.0, &mut parts);
            }
            segment.start = segment.at(seconds);
            self.look(&segment, 0.0, &mut parts);
        }
        parts
    }

    #[inline(never)]
    fn look(&self, segment: &CubicSegment, t: f32, parts: &mut [f32; 2]) {
        let most = segment.platform(&segment.at(t), self.centre).most();
        *parts = both!(k => f32::fmax(parts[k], most[k] / self.pivots[k]));
    }

    /// By how much the next interval may be longer than this; or what is broken, and by how much shorter an interval to
    /// try: zero where it is broken at an end.
    fn interval(
        &self,
        segment: &CubicSegment,
        jerk: [f32; 2],
        room: &[[f32; 2]; 3],
        [from, to]: [&mut IntervalEnd; 2],
        seconds: f32,
    ) -> Result<f32, (Violation, f32)> {
        let sizes = IntervalBounds::new(jerk, from, to, seconds);
        let moving = sizes.at_offset(self.arm);
        let eighth = seconds * seconds / 8.0;
        let furthest = from.centre_distance.fmax(to.centre_distance) + moving.a[0] * eighth;
        (self.path(&sizes, furthest))
            .and_then(|()| {
                within_bounds(room, &from.sample, &to.sample, sizes.a.map(|a| a * eighth))
            })
            .map_err(|broken| (broken, SHORTER))?;
        let bound = PivotGain::new(furthest, 0.0);
        let most = moving.pivot_bounds(&bound);
        if most[0] <= self.pivots[0] && most[1] <= self.pivots[1] {
            return Ok(LONGER);
        }
        let ends = [from, to].map(|end| end.pivots(segment, self.centre));
        let rises = moving.pivot_rises(&bound, seconds);
        let mut longer = LONGER;
        for k in 0..2 {
            let value = ends[0][k].fmax(ends[1][k]);
            // A rise goes with the square of the time.
            let (room, rise) = (
                self.pivots[k] * self.slack - value,
                rises[k].fmin(most[k] - value),
            );
            let change = PART_OF_RISE * sqrt_f32(room.fmax(0.0) / rise.fmax(f32::MIN_POSITIVE));
            // What is not a number is no room.
            if !(room > 0.0) {
                return Err((Violation::Pivots, 0.0));
            } else if rise > room {
                return Err((Violation::Pivots, change.clamp(1.0 / 16.0, 0.7)));
            }
            longer = longer.fmin(change);
        }
        Ok(longer)
    }

    /// Path and disk.
    fn path(&self, sizes: &IntervalBounds, furthest: f32) -> Result<(), Violation> {
        let limits = &self.motion_limits;
        self.within(sizes.v, &limits.speed, Violation::Speed)?;
        self.within(sizes.a, &limits.acceleration, Violation::Acceleration)?;
        let is_inside = furthest <= self.radius + WORKSPACE_RADII;
        is_inside.then_some(()).ok_or(Violation::Disk)
    }

    /// Whether translation and rotation keep to a limit.
    fn within(
        &self,
        [linear, angular]: [f32; 2],
        limit: &Speeds,
        broken: Violation,
    ) -> Result<(), Violation> {
        let is_kept = part(linear, angular, limit) <= self.slack;
        is_kept.then_some(()).ok_or(broken)
    }
}

/// Holds an interval against the bounds; `rise` is how far translation and rotation can rise between its ends.
fn within_bounds(
    room: &[[f32; 2]; 3],
    from: &MotionState,
    to: &MotionState,
    rise: [f32; 2],
) -> Result<(), Violation> {
    for (i, [low, high]) in room.iter().enumerate() {
        let (a, b, rise) = (
            from.displacement[i],
            to.displacement[i],
            rise[i / 2] - WORKSPACE_RADII,
        );
        if !(*low <= a.fmin(b) - rise && a.fmax(b) + rise <= *high) {
            return Err(Violation::Bounds(i));
        }
    }
    Ok(())
}

/// The part of its limit that translation or rotation reaches, the greater.
fn part(linear: f32, angular: f32, limit: &Speeds) -> f32 {
    (linear / limit.linear).fmax(angular / limit.angular)
}

/// Whether speeds or accelerations are over a limit of ordinary motion by more than what is granted.
pub fn is_over(value: Speeds, limit: Speeds) -> bool {
    part(value.linear, value.angular, &limit) > STATE_SLACK
}
