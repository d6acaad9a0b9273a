//! Holds the pieces of a plan against every limit, interval by interval.

use super::interval::{IntervalBounds, IntervalEnd, Violation};
use super::pivots::{PivotGain, greatest};
use super::workspace::{StopLimits, Workspace};
use crate::constraints::{Constraints, MotionLimits, Speeds};
use crate::plan::Piece;
use crate::plan::axis_state::AxisState;
use crate::plan::cubic_segment::{CubicSegment, MotionState};
use crate::tolerances::{JERK_TOLERANCE, PLAN_SLACK, STREAM_SLACK};
use number::float::{FloatMinMax, hypot, ticks_to_f32, truncate};
use number::sqrt_f32;

/// What a plan is held against.
pub struct PlanCheck {
    /// Of translation, track radii per second (squared, cubed), and of rotation, rad; none for a stop.
    motion_limits: Option<MotionLimits>,
    /// What a stop from anywhere brakes with, where there has to be room for one.
    stop: Option<StopLimits>,
    /// What is granted over a limit.
    slack: f32,
    /// Rate and acceleration, rad/s and rad/s^2.
    pivots: [f32; 2],
    workspace: Workspace,
    hz: f32,
}

/// An interval of a piece.
struct Interval<'a> {
    segment: &'a CubicSegment,
    /// Of translation and of rotation.
    jerk: [f32; 2],
    /// How far each axis may go from where the motion began.
    bound_distances: &'a [[f32; 2]; 3],
    seconds: f32,
}

/// What a check may take.
pub struct Budget {
    /// Intervals that may be looked at, failed ones included, before the next failure counts.
    pub intervals: usize,
    /// When the pivots are over a limit, they are sampled all along the plan, which tells by how much.
    pub samples_pivots: bool,
}

impl Budget {
    /// For a stop, which is made anew with what was found.
    pub const FOR_STOP: Self = Self {
        intervals: 60,
        samples_pivots: true,
    };
    /// For a plan that is taken or not.
    pub const FOR_ANSWER: Self = Self {
        intervals: 60,
        samples_pivots: false,
    };
}

/// Intervals of one plan at most: a way of many turns that asks for more is not worth the time. A stop waits meanwhile.
const MOST_INTERVALS: usize = 1_000;

/// Pieces up to this many ticks have no middle to sample.
const SHORT: u64 = 200;

/// An interval is not cut shorter than this many ticks: what happens in 0.2 ms is less than the slack.
const SHORTEST: u64 = 4;

impl PlanCheck {
    /// The check of an ordinary motion, or of the state at the start where that lies outside: it may have been planned
    /// with other limits, and can only be left.
    pub fn new(constraints: &Constraints, start: &[AxisState; 3]) -> Self {
        let stop = constraints.motion_limits();
        let now = MotionState::new(start, constraints.limits.rate_hz as f32);
        // What is granted over a limit is not granted over a state again: it would add up from plan to plan.
        let kept = |state: &[f32; 3]| Speeds::of(state).scaled(1.0 / PLAN_SLACK);
        let motion_limits = MotionLimits {
            speed: stop.speed.max(kept(&now.v)),
            acceleration: stop.acceleration.max(kept(&now.a)),
            jerk: stop.jerk,
        };
        Self {
            motion_limits: Some(motion_limits),
            stop: Some(StopLimits::new(stop)),
            ..Self::for_stop(constraints)
        }
    }

    /// The check of a motion that others shape, and of the stop that ends it.
    pub fn for_stream(constraints: &Constraints) -> Self {
        Self {
            motion_limits: Some(constraints.motion_limits().scaled(1.0, JERK_TOLERANCE)),
            slack: STREAM_SLACK,
            ..Self::for_stop(constraints)
        }
    }

    /// The check of a stop: pivots, disk and bounds.
    pub fn for_stop(constraints: &Constraints) -> Self {
        let limits = &constraints.limits;
        Self {
            motion_limits: None,
            stop: None,
            slack: PLAN_SLACK,
            pivots: [
                limits.pivot_rate_rad_s as f32,
                limits.pivot_acceleration_rad_s2 as f32,
            ],
            workspace: Workspace::new(constraints),
            hz: limits.rate_hz as f32,
        }
    }

    /// Whether a motion by the pieces of a plan from `start` keeps to everything. The plan's nudge does not show in it.
    /// What is taken is taken off the budget.
    #[inline(never)]
    pub fn check(
        &self,
        pieces: &[Piece],
        start: &[AxisState; 3],
        budget: &mut Budget,
    ) -> Result<(), Violation> {
        let (mut looked_at, mut worst) = (0, None);
        let mut samples_pivots = budget.samples_pivots;
        let bound_distances = self.workspace.bound_distances(start);
        let mut segment = CubicSegment::new(start, self.hz);
        let [mut first, mut second] = [IntervalEnd::default(); 2];
        let (mut from, mut to) = (&mut first, &mut second);
        self.evaluate(&segment, 0, from);
        for piece in pieces {
            segment.start = from.sample;
            segment.jerk = CubicSegment::jerk(piece, self.hz);
            let [x, y, theta] = segment.jerk;
            let jerk = [hypot(x, y), theta.abs()];
            if let Some(limits) = &self.motion_limits {
                self.within_limit(jerk, &limits.jerk, Violation::Jerk)?;
            }
            if piece.ticks == 1 {
                // What a tick changes does not show, nor what some of them do, one after the other.
                self.evaluate(&segment, piece.ticks, to);
                core::mem::swap(&mut from, &mut to);
                continue;
            }
            let (mut done, mut ticks) = (0, piece.ticks);
            while done < piece.ticks {
                ticks = ticks.min(piece.ticks - done);
                budget.intervals = budget.intervals.saturating_sub(1);
                looked_at += 1;
                if looked_at > MOST_INTERVALS {
                    return Err(worst.unwrap_or(Violation::NoRoomToStop));
                }
                self.evaluate(&segment, done + ticks, to);
                let interval = Interval {
                    segment: &segment,
                    jerk,
                    bound_distances: &bound_distances,
                    seconds: ticks_to_f32(ticks) / self.hz,
                };
                match self.check_interval(&interval, [from, to]) {
                    Ok(longer) => {
                        core::mem::swap(&mut from, &mut to);
                        done += ticks;
                        ticks = truncate(ticks_to_f32(ticks) * longer) as u64;
                    }
                    Err((broken, shorter)) => {
                        // Where a limit is passed indeed, sampling the pivots tells by how much.
                        if broken.is_of_pivots() && core::mem::take(&mut samples_pivots) {
                            self.sample_pivots(pieces, start)?;
                        }
                        // Intervals close in on where a limit is met; how far it is passed was seen before.
                        let broken = broken.or_worse(worst);
                        worst = Some(broken);
                        if shorter == 0.0 || ticks <= SHORTEST || budget.intervals == 0 {
                            return Err(broken);
                        }
                        ticks = truncate(ticks_to_f32(ticks) * shorter) as u64;
                    }
                }
                ticks = ticks.max(SHORTEST);
            }
        }
        Ok(())
    }

    fn evaluate(&self, segment: &CubicSegment, ticks: u64, end: &mut IntervalEnd) {
        let sample = segment.at(ticks_to_f32(ticks) / self.hz);
        let [x, y] = segment.point(&sample);
        let point_distance = hypot(x, y);
        let MotionState { v, a, .. } = sample;
        *end = IntervalEnd {
            point_distance,
            centre_distance: if self.workspace.arm > 0.0 {
                self.workspace.centre_distance(segment, &sample)
            } else {
                point_distance
            },
            v: [hypot(v[0], v[1]), v[2].abs()],
            a: [hypot(a[0], a[1]), a[2].abs()],
            sample,
            pivots: None,
        };
    }

    /// Rates and accelerations of the pivots at a state of a segment.
    pub fn pivots(&self, segment: &CubicSegment, sample: &MotionState) -> [[f32; 3]; 2] {
        segment.platform(sample, self.workspace.centre).pivots()
    }

    /// The pivots' limit of acceleration.
    pub fn pivot_acceleration(&self) -> f32 {
        self.pivots[1]
    }

    /// The largest part of a limit of theirs that the pivots reach at the start of a segment.
    pub fn pivot_part(&self, segment: &CubicSegment) -> f32 {
        let [rates, accelerations] = self.pivots(segment, &segment.start);
        (greatest(&rates) / self.pivots[0]).fmax(greatest(&accelerations) / self.pivots[1])
    }

    /// What the pivots do at the ends and in the middle of the pieces; in short ones the ends tell enough.
    fn sample_pivots(&self, pieces: &[Piece], start: &[AxisState; 3]) -> Result<(), Violation> {
        let [mut rate, mut acceleration] = [0.0_f32; 2];
        let mut segment = CubicSegment::new(start, self.hz);
        for piece in pieces {
            segment.jerk = CubicSegment::jerk(piece, self.hz);
            let seconds = ticks_to_f32(piece.ticks) / self.hz;
            let spots = [seconds, seconds / 2.0];
            for &t in &spots[..1 + usize::from(piece.ticks > SHORT)] {
                let [rates, accelerations] = self.pivots(&segment, &segment.at(t));
                rate = rate.fmax(greatest(&rates));
                acceleration = acceleration.fmax(greatest(&accelerations));
            }
            segment.start = segment.at(seconds);
        }
        let [rate_limit, acceleration_limit] = self.pivots;
        self.within(
            acceleration / acceleration_limit,
            Violation::PivotAcceleration,
        )?;
        self.within(rate / rate_limit, Violation::PivotRate)
    }

    /// By how much the next interval may be longer than this; or what is broken, and by how much shorter an interval to
    /// try: zero where it is broken at an end.
    fn check_interval(
        &self,
        interval: &Interval<'_>,
        [from, to]: [&mut IntervalEnd; 2],
    ) -> Result<f32, (Violation, f32)> {
        const HALF: f32 = 0.5;
        let sizes = IntervalBounds::new(interval.jerk, from, to, interval.seconds);
        let moving = sizes.at_offset(self.workspace.arm);
        let radius = self
            .path(interval, [from, to], [&sizes, &moving])
            .map_err(|broken| match broken {
                Violation::NoRoomToStop => (broken, 0.0),
                broken => (broken, HALF),
            })?;
        self.check_pivots(interval, [from, to], &moving, radius)
    }

    /// All but the pivots; the greatest distance of the platform's centre from the track's.
    fn path(
        &self,
        interval: &Interval<'_>,
        [from, to]: [&IntervalEnd; 2],
        [sizes, moving]: [&IntervalBounds; 2],
    ) -> Result<f32, Violation> {
        if let Some(limits) = &self.motion_limits {
            self.within_limit(sizes.v, &limits.speed, Violation::Speed)?;
            self.within_limit(sizes.a, &limits.acceleration, Violation::Acceleration)?;
        }
        let eighth = interval.seconds * interval.seconds / 8.0;
        let rise = both!(k => sizes.a[k] * eighth);
        (self.workspace).check_bounds(interval.bound_distances, &from.sample, &to.sample, rise)?;
        let furthest = from.centre_distance.fmax(to.centre_distance) + moving.a[0] * eighth;
        let radius = self.workspace.check_disk(furthest)?;
        if let Some(stop) = &self.stop {
            (self.workspace)
                .check_stop(interval.segment, interval.bound_distances, to, stop)
                .map_err(|_| Violation::NoRoomToStop)?;
        }
        Ok(radius)
    }

    fn check_pivots(
        &self,
        interval: &Interval<'_>,
        ends: [&mut IntervalEnd; 2],
        moving: &IntervalBounds,
        radius: f32,
    ) -> Result<f32, (Violation, f32)> {
        const ALL: f32 = 4.0;
        let bound = PivotGain::new(radius);
        let [rate, acceleration] = moving.pivot_bounds(&bound);
        let [rate_limit, acceleration_limit] = self.pivots;
        if rate <= rate_limit && acceleration <= acceleration_limit {
            return Ok(ALL);
        }
        let [mut rates, mut accelerations] = [0.0_f32; 2];
        for end in ends {
            let [rate, acceleration] = end.pivots(interval.segment, self.workspace.centre);
            rates = rates.fmax(rate);
            accelerations = accelerations.fmax(acceleration);
        }
        let rises = moving.pivot_rises(&bound, interval.seconds);
        let most = [
            rate.fmin(rates + rises[0]),
            acceleration.fmin(accelerations + rises[1]),
        ];
        let once = self.rise_within(rates, most[0], rate_limit, Violation::PivotRate)?;
        let twice = self.rise_within(
            accelerations,
            most[1],
            acceleration_limit,
            Violation::PivotAcceleration,
        )?;
        Ok(once.fmin(twice).fmin(ALL))
    }
    /// Whether a value keeps to its limit that is so large at the ends of an interval and may rise in between; what is told is what is sure. A rise goes
    /// with the square of the time: how much longer an interval may be than this one, or how much shorter it has to be.
    fn rise_within(
        &self,
        value: f32,
        most: f32,
        limit: f32,
        broken: fn(f32) -> Violation,
    ) -> Result<f32, (Violation, f32)> {
        /// What is used of that, because the value changes too.
        const PART: f32 = 0.75;
        let room = limit * self.slack - value;
        let rise = most - value;
        if rise <= room {
            return Ok(PART * sqrt_f32(room / rise.fmax(f32::MIN_POSITIVE)));
        }
        // What is not a number is no room.
        let shorter = if room > 0.0 {
            (PART * sqrt_f32(room / rise)).clamp(1.0 / 16.0, 0.7)
        } else {
            0.0
        };
        Err((broken((value / limit).fmax(1.0)), shorter))
    }
    /// Whether translation and rotation keep to a limit.
    fn within_limit(
        &self,
        [linear, angular]: [f32; 2],
        limit: &Speeds,
        broken: fn(f32) -> Violation,
    ) -> Result<(), Violation> {
        self.within(part(linear, angular, limit), broken)
    }

    /// The part of a limit that is used is not over one.
    fn within(&self, part: f32, broken: fn(f32) -> Violation) -> Result<(), Violation> {
        if part <= self.slack {
            Ok(())
        } else {
            Err(broken(part))
        }
    }
}

/// The part of its limit that translation or rotation reaches, the greater.
fn part(linear: f32, angular: f32, limit: &Speeds) -> f32 {
    (linear / limit.linear).fmax(angular / limit.angular)
}

/// Whether speeds or accelerations are over a limit of ordinary motion by more than what is granted.
pub fn is_over(value: Speeds, limit: Speeds) -> bool {
    const MORE: f32 = 1.0 + 2.0 * (PLAN_SLACK - 1.0);
    part(value.linear, value.angular, &limit) > MORE
}
