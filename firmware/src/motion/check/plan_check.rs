//! Holds the pieces of a plan against every limit, interval by interval.

use super::budget::CheckBudget;
use super::interval::{IntervalBounds, IntervalEnd};
use super::pivot_bounds::PivotGain;
use super::platform::greatest;
use super::violation::Violation;
use super::workspace::{StopLimits, Workspace};
use crate::motion::brake::Brake;
use crate::motion::constraints::Constraints;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::cubic_segment::{CubicSegment, MotionState};
use crate::motion::plan::units::TickLimits;
use crate::motion::plan::{MAX_PIECES, Piece};
use crate::number::float::{FloatMinMax, hypot, ticks_to_f32, truncate};
use crate::number::sqrt_f32;
use heapless::Vec;

/// What a plan is held against.
pub(crate) struct PlanCheck {
    /// Of translation, track radii per second (squared, cubed), and of rotation, rad; none for a stop.
    motion_limits: Option<MotionLimits>,
    /// Rate and acceleration, rad/s and rad/s^2.
    pivots: [f32; 2],
    workspace: Workspace,
    hz: f32,
}

/// Limits of translation and rotation.
struct MotionLimits {
    speed: [f32; 2],
    acceleration: [f32; 2],
    jerk: [f32; 2],
    /// With which a stop brakes, and the same for a bound of its way.
    stop: TickLimits,
    braking: StopLimits,
}

/// A piece as it is looked at.
pub(crate) struct CheckedPiece {
    segment: CubicSegment,
    /// Of translation and of rotation.
    jerk: [f32; 2],
    /// How far each axis may go from its start.
    bound_distances: [[f32; 2]; 3],
    ticks: u64,
}

/// The pieces of a plan.
pub(crate) type CheckedPieces = Vec<CheckedPiece, MAX_PIECES>;

/// Slack of single precision.
const PLAN_SLACK: f32 = 1.0 + 1e-4;

/// Pieces up to this many ticks have no middle to sample.
const SHORT: u64 = 200;

/// An interval is not cut shorter than this many ticks: what happens in 0.2 ms is less than the slack.
const SHORTEST: u64 = 4;

impl PlanCheck {
    /// The check of an ordinary motion, or of the state at the start where that lies outside: it may have been planned
    /// with other limits, and can only be left.
    pub fn new(constraints: &Constraints, stop: TickLimits, start: &[AxisState; 3]) -> Self {
        let limits = &constraints.limits;
        let mm = constraints.geometry.radius_mm as f32;
        let pair = |translation: f64, rotation_deg: f64| {
            [
                translation as f32 / mm,
                rotation_deg as f32 * (core::f32::consts::PI / 180.0),
            ]
        };
        let hz = limits.rate_hz as f32;
        let MotionState { v, a, .. } = CubicSegment::new(start, &Piece::default(), hz).start;
        let wider = |limit: [f32; 2], now: [f32; 3]| {
            [
                limit[0].fmax(hypot(now[0], now[1])),
                limit[1].fmax(now[2].abs()),
            ]
        };
        let motion_limits = MotionLimits {
            speed: wider(pair(limits.speed_mm_s, limits.turn_speed_deg_s), v),
            acceleration: wider(
                pair(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2),
                a,
            ),
            jerk: pair(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
            stop,
            braking: StopLimits::new(&stop, hz),
        };
        Self {
            motion_limits: Some(motion_limits),
            ..Self::for_stop(constraints)
        }
    }

    /// The check of a stop: pivots, disk and bounds.
    pub fn for_stop(constraints: &Constraints) -> Self {
        let limits = &constraints.limits;
        Self {
            motion_limits: None,
            pivots: [
                limits.pivot_rate_rad_s as f32,
                limits.pivot_acceleration_rad_s2 as f32,
            ],
            workspace: Workspace::new(constraints),
            hz: limits.rate_hz as f32,
        }
    }

    /// Writes pieces as they are looked at, from `start`; where they lead to. A plan's nudge does not show in them.
    pub fn prepare(
        &self,
        pieces: &[Piece],
        start: &[AxisState; 3],
        checked_pieces: &mut CheckedPieces,
    ) -> [AxisState; 3] {
        let mut axes = *start;
        checked_pieces.clear();
        for piece in pieces {
            let segment = CubicSegment::new(&axes, piece, self.hz);
            // Room for all pieces of a plan.
            let _ = checked_pieces.push(CheckedPiece {
                jerk: [
                    hypot(segment.jerk[0], segment.jerk[1]),
                    segment.jerk[2].abs(),
                ],
                segment,
                bound_distances: self.workspace.bound_distances(&axes),
                ticks: piece.ticks,
            });
            piece.advance(&mut axes, piece.ticks, &[0; 3]);
        }
        axes
    }

    /// Whether these stay inside, from what has been checked of them before.
    pub fn check(
        &self,
        checked_pieces: &[CheckedPiece],
        budget: &mut CheckBudget,
    ) -> Result<(), Violation> {
        let (mut worst, mut pivots_sampled) = (None, false);
        let mut before = budget.checked_ticks;
        for piece in checked_pieces {
            if before >= piece.ticks {
                before -= piece.ticks;
                continue;
            }
            self.check_jerk(piece)?;
            let (mut done, mut ticks) = (core::mem::take(&mut before), piece.ticks);
            let [mut first, mut second] = [IntervalEnd::default(); 2];
            let (mut from, mut to) = (&mut first, &mut second);
            self.evaluate(&piece.segment, done, from);
            while done < piece.ticks {
                ticks = ticks.min(piece.ticks - done);
                budget.take()?;
                self.evaluate(&piece.segment, done + ticks, to);
                match self.check_interval(piece, [from, to], ticks_to_f32(ticks) / self.hz) {
                    Ok(longer) => {
                        core::mem::swap(&mut from, &mut to);
                        done += ticks;
                        budget.checked_ticks += ticks;
                        ticks = truncate(ticks_to_f32(ticks) * longer) as u64;
                    }
                    // In shorter intervals the same instant would be met.
                    Err((Violation::NoRoomToStop, _)) => return Err(Violation::Workspace),
                    Err((broken, shorter)) => {
                        if broken.is_of_pivots() && !pivots_sampled {
                            budget.leave_for_later()?;
                            // Where a limit is passed indeed, sampling the pivots tells by how much.
                            self.sample_pivots(checked_pieces)?;
                            pivots_sampled = true;
                        }
                        // Intervals close in on where a limit is met; how far it is passed was seen before.
                        worst = Some(broken.or_worse(worst));
                        if ticks <= SHORTEST || budget.left == 0 {
                            return worst.map_or(Ok(()), Err);
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

    /// What the pivots do at the ends and in the middle of the pieces; in short ones the ends tell enough.
    fn sample_pivots(&self, checked_pieces: &[CheckedPiece]) -> Result<(), Violation> {
        let [mut rate, mut acceleration] = [0.0_f32; 2];
        for CheckedPiece { segment, ticks, .. } in checked_pieces {
            let seconds = ticks_to_f32(*ticks) / self.hz;
            let spots = [seconds, seconds / 2.0];
            for &t in &spots[..1 + usize::from(*ticks > SHORT)] {
                let [rates, accelerations] = segment
                    .platform(&segment.at(t), self.workspace.centre)
                    .pivots();
                rate = rate.fmax(greatest(&rates));
                acceleration = acceleration.fmax(greatest(&accelerations));
            }
        }
        let [rate_limit, acceleration_limit] = self.pivots;
        within(
            acceleration / acceleration_limit,
            Violation::PivotAcceleration,
        )?;
        within(rate / rate_limit, Violation::PivotRate)
    }

    fn check_jerk(&self, piece: &CheckedPiece) -> Result<(), Violation> {
        let Some(motion_limits) = &self.motion_limits else {
            return Ok(());
        };
        let [way, turn] = piece.jerk;
        within(
            (way / motion_limits.jerk[0]).fmax(turn / motion_limits.jerk[1]),
            Violation::Acceleration,
        )
    }

    /// By how much the next interval may be longer than this; or what is broken, and by how much shorter an interval to
    /// try.
    fn check_interval(
        &self,
        piece: &CheckedPiece,
        [from, to]: [&mut IntervalEnd; 2],
        t: f32,
    ) -> Result<f32, (Violation, f32)> {
        const HALF: f32 = 0.5;
        let sizes = IntervalBounds::new(piece.jerk, from, to, t);
        let moving = sizes.at_offset(self.workspace.arm);
        let radius = self
            .path(piece, [from, to], t, [&sizes, &moving])
            .map_err(|broken| (broken, HALF))?;
        self.check_pivots(&piece.segment, [from, to], t, &moving, radius)
    }

    /// All but the pivots; the greatest distance of the platform's centre from the track's.
    fn path(
        &self,
        piece: &CheckedPiece,
        [from, to]: [&IntervalEnd; 2],
        t: f32,
        [sizes, moving]: [&IntervalBounds; 2],
    ) -> Result<f32, Violation> {
        if let Some(motion_limits) = &self.motion_limits {
            let [v, turn] = sizes.v;
            within(
                (v / motion_limits.speed[0]).fmax(turn / motion_limits.speed[1]),
                Violation::Speed,
            )?;
            let [a, spin] = sizes.a;
            within(
                (a / motion_limits.acceleration[0]).fmax(spin / motion_limits.acceleration[1]),
                Violation::Acceleration,
            )?;
        }
        let eighth = t * t / 8.0;
        let rise = sizes.a.map(|a| a * eighth);
        (self.workspace).check_bounds(&piece.bound_distances, &from.sample, &to.sample, rise)?;
        let furthest = from.centre_distance.fmax(to.centre_distance) + moving.a[0] * eighth;
        let radius = self.workspace.check_disk(furthest)?;
        if let Some(motion_limits) = &self.motion_limits {
            self.check_stop(piece, to, motion_limits)?;
        }
        Ok(radius)
    }

    /// A stop from here.
    fn check_stop(
        &self,
        piece: &CheckedPiece,
        at: &IntervalEnd,
        motion_limits: &MotionLimits,
    ) -> Result<(), Violation> {
        if self
            .workspace
            .stop_is_clear_of_edges(&piece.bound_distances, at, &motion_limits.braking)
        {
            return Ok(());
        }
        let brake = Brake::in_seconds(&at.sample, &motion_limits.stop, self.hz);
        (self.workspace)
            .check_stop(
                &piece.segment,
                &piece.bound_distances,
                &at.sample,
                &brake,
                self.hz,
            )
            .map_err(|_| Violation::NoRoomToStop)
    }

    fn check_pivots(
        &self,
        segment: &CubicSegment,
        ends: [&mut IntervalEnd; 2],
        t: f32,
        moving: &IntervalBounds,
        radius: f32,
    ) -> Result<f32, (Violation, f32)> {
        const ALL: f32 = 4.0;
        const ROUNDS: usize = 3;
        let bound = PivotGain::new(radius);
        let [rate, acceleration] = moving.pivot_bounds(&bound);
        let [rate_limit, acceleration_limit] = self.pivots;
        if rate <= rate_limit && acceleration <= acceleration_limit {
            return Ok(ALL);
        }
        let [mut rates, mut accelerations] = [0.0_f32; 2];
        for end in ends {
            let [rate, acceleration] = end.pivots(segment, self.workspace.centre);
            rates = rates.fmax(rate);
            accelerations = accelerations.fmax(acceleration);
        }
        // The bounds hold for any orientation; what is sure of this one bounds its own rise in turn.
        let mut most = [rate, acceleration];
        for _ in 0..ROUNDS {
            let rises = moving.pivot_rises(most, &bound, t);
            most = [
                most[0].fmin(rates + rises[0]),
                most[1].fmin(accelerations + rises[1]),
            ];
        }
        let once = rise_within(rates, most[0], rate_limit, Violation::PivotRate)?;
        let twice = rise_within(
            accelerations,
            most[1],
            acceleration_limit,
            Violation::PivotAcceleration,
        )?;
        Ok(once.fmin(twice).fmin(ALL))
    }
}

/// The same for a value at the ends of an interval that may rise in between; what is told is what is sure. A rise goes
/// with the square of the time: how much longer an interval may be than this one, or how much shorter it has to be.
fn rise_within(
    value: f32,
    most: f32,
    limit: f32,
    broken: fn(f32) -> Violation,
) -> Result<f32, (Violation, f32)> {
    /// What is used of that, because the value changes too.
    const PART: f32 = 0.75;
    let room = limit * PLAN_SLACK - value;
    let rise = most - value;
    if rise <= room {
        return Ok(PART * sqrt_f32(room / rise.fmax(f32::MIN_POSITIVE)));
    }
    let shorter = PART * sqrt_f32(room.fmax(0.0) / rise);
    Err((
        broken((value / limit).fmax(1.0)),
        shorter.clamp(1.0 / 16.0, 0.7),
    ))
}

/// The part of a limit that is used is not over one.
fn within(part: f32, broken: fn(f32) -> Violation) -> Result<(), Violation> {
    if part <= PLAN_SLACK {
        Ok(())
    } else {
        Err(broken(part))
    }
}
