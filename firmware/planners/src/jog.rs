//! Jogging: from any state to a constant velocity, held until somebody changes it, or up to the workspace's edge.
//!
//! ```text
//! speed    ________________________          The velocity is changed (see `profile/velocity`), held, and given up in time: a
//!         /                        \         plan that ends at rest like any other, exactly where it can stop. Theta alone
//!       _/                          \_       never meets an edge: its plan ends at a thousand million turns, 30 years
//!                                            away at a turn a second.
//! ```
//!
//! All axes stop together, at the first edge or bound that one of them meets.
//!
//! The edge is that of the disk in which the pivots can follow this velocity at any orientation (`check/pivots`):
//! the faster the jog, the smaller it may be. Who jogs outwards stops there; who stands outside of it is told that it
//! is too fast. Bounds of the moved point and of theta end a jog in the same way. When the platform turns about a point
//! beside its centre, its centre goes in circles.
//!
//! Near an edge there may be no room to reach the velocity and to stop again: from rest a lower one is taken, and where the
//! point has no way left at all, theta turns alone.

use crate::steady_motion::SteadyMotion;
use motion::check::pivots::PivotBound;
use motion::check::workspace::MAX_TURNS;
use motion::check::{BUDGET, PlanCheck, is_over};
use motion::constraints::{Constraints, MotionLimits, Speeds};
use motion::plan::axis_state::{AXIS_UNITS, AxisState, PER_POSITION_UNIT, SUB_BITS};
use motion::plan::cubic_segment::{MotionState, per_second};
use motion::plan::quantise::{velocity_pieces, write_velocity_pieces};
use motion::plan::{Piece, Pieces, Plan, PlanStart, push_piece, state_after_pieces};
use motion::profile::velocity::VelocityProfile;
use motion::refusal::{Refusal, RetargetError};
use motion::tolerances::{JOG_RADII, JOG_WAY};
use number::float::{FloatMinMax, hypot, i64_to_f32_fast, ticks_to_f32, truncate, truncate_f64};

/// Plans the way to `velocity` (mm/s, mm/s and deg/s of x, y and theta), and on with it, from `state`, which is where
/// `start` says. Zero is a velocity as any other: that axis stops smoothly.
///
/// # Errors
/// [`RetargetError::Refused`] when there is no such jog, with the reason; [`RetargetError::NeedsStop`] when there is,
/// but not without a stop before.
#[inline(never)]
pub fn plan_jog(
    id: u32,
    start: PlanStart,
    state: &[AxisState; 3],
    velocity: &[f64; 3],
    constraints: &Constraints,
) -> Result<Plan, RetargetError> {
    let mut plan = Plan::new(id, start, [0; 3]);
    let request = JogRequest::new(velocity, constraints).map_err(RetargetError::Refused)?;
    let now = MotionState::new(state, request.hz);
    let from_rest = now.is_at_rest();
    // Out of an urgent stop only once it is over: its acceleration is more than a jog may have.
    let acceleration = Speeds::of(&now.a);
    if is_over(acceleration, request.limits.acceleration) {
        return Err(RetargetError::NeedsStop);
    }
    let mut wanted = request.velocity;
    for _ in 0..ATTEMPTS {
        let jog = Jog::new(state, &now, wanted, &request, &mut plan.pieces)?;
        match jog.hold(state, &request) {
            Ok(hold) => {
                // From rest the way there is the first part of the way on, which was looked at for the time that it is
                // held.
                if !from_rest {
                    PlanCheck::new(constraints, state)
                        .check(&plan.pieces, state, &mut { BUDGET })
                        .map_err(|_| RetargetError::NeedsStop)?;
                }
                jog.finish(&mut plan, state, hold);
                return Ok(plan);
            }
            Err(_) if !from_rest => return Err(RetargetError::NeedsStop),
            Err(short) => wanted = jog.slower(short, &request),
        }
        if wanted == [0; 3] {
            wanted[2] = request.velocity[2];
            if wanted[2] == 0 || jog.wanted == wanted {
                break;
            }
        }
    }
    Err(RetargetError::Refused(Refusal::NoRoom))
}

/// The point may be too near to an edge, theta to a bound, and once more for what a lower velocity changes.
const ATTEMPTS: usize = 4;

/// Least part of the ordinary acceleration with which a jog is begun.
const LEAST_FORCE: f32 = 0.05;

/// Everything that does not depend on the state.
struct JogRequest<'a> {
    constraints: &'a Constraints,
    hz: f32,
    pivot_bound: PivotBound,
    /// Wanted, 2^-72 units a tick.
    velocity: [i64; 3],
    limits: MotionLimits,
}

impl<'a> JogRequest<'a> {
    fn new(velocity: &[f64; 3], constraints: &'a Constraints) -> Result<Self, Refusal> {
        let limits = &constraints.limits;
        if !limits.all_positive() {
            return Err(Refusal::InvalidLimits);
        }
        let [x, y, turning] = *velocity;
        let speed = limits.speed_mm_s;
        if !(x * x + y * y <= speed * speed && turning.abs() <= limits.turn_speed_deg_s) {
            return Err(Refusal::Velocity);
        }
        let mm = constraints.geometry.radius_mm;
        // One division of an f64 costs as much as many products.
        let per_mm = f64::from(AXIS_UNITS) / (limits.rate_hz * mm);
        let per_deg = per_mm * (mm * (1.0 / 360.0));
        Ok(Self {
            constraints,
            hz: limits.rate_hz as f32,
            pivot_bound: PivotBound::new(constraints),
            velocity: [x * per_mm, y * per_mm, turning * per_deg].map(truncate_f64),
            limits: constraints.motion_limits(),
        })
    }

    /// How far out the jog to `target` may go, and how hard it may be begun and ended there.
    fn limits_towards(
        &self,
        state: &[AxisState; 3],
        now: &MotionState,
        target: &[f32; 3],
    ) -> Result<(f32, MotionLimits), RetargetError> {
        let pivot_bound = &self.pivot_bound;
        let speeds = Speeds::of(target);
        let usable = self.constraints.usable_radius as f32;
        let too_fast = |radius_mm| RetargetError::Refused(Refusal::PivotRate { radius_mm });
        let most = (pivot_bound.max_radius(speeds, usable)).ok_or(too_fast(0.0))?;
        let [x, y] = self.steady(state, &[0.0; 3]).platform(0.0);
        let out = hypot(x, y);
        if out > most + JOG_RADII {
            let mm = self.constraints.geometry.radius_mm;
            return Err(too_fast(f64::from(most) * mm));
        }
        let MotionState { v, a, .. } = now;
        let (speed, acceleration) = (Speeds::of(v), Speeds::of(a));
        let any = speeds.max(speed).max(acceleration);
        let travels = any.linear > 0.0 || any.angular * pivot_bound.arm > 0.0;
        let radius = if travels { most } else { out };
        // An acceleration under way adds to the velocity while it is released: straight from the one to this.
        let jerk = self.limits.jerk;
        let release_s =
            (acceleration.linear / jerk.linear).fmax(acceleration.angular / jerk.angular);
        let released = each!(i => v[i] + a[i] * release_s / 2.0);
        let gained = speed.max(Speeds::of(&released));
        let part = pivot_bound.part_within(radius, speeds.max(gained), self.limits.acceleration);
        if part < LEAST_FORCE {
            return Err(RetargetError::NeedsStop);
        }
        let part = part.fmin(1.0);
        Ok((radius, self.limits.scaled(part, 1.0)))
    }

    /// Seconds until steady motion with these rates of the axes meets a bound.
    fn time_to_bounds(&self, axes: &[AxisState; 3], rates: &[i64; 3]) -> f32 {
        const PER_UNIT: f32 = 1.0 / (1_i64 << SUB_BITS) as f32;
        let mut seconds = f32::INFINITY;
        for ((axis, &rate), [low, high]) in axes.iter().zip(rates).zip(self.constraints.bounds) {
            let now = axis.rounded();
            let way = match rate {
                0 => continue,
                1.. => high.min(MAX_TURNS).saturating_sub(now),
                _ => now.saturating_sub(low.max(-MAX_TURNS)),
            };
            let way = i64_to_f32_fast(way) * JOG_WAY;
            let per_second = i64_to_f32_fast(rate).abs() * PER_UNIT * self.hz;
            seconds = seconds.fmin((way / per_second).fmax(0.0));
        }
        seconds
    }

    /// The steady motion at `velocity` from a position.
    #[inline(never)]
    fn steady(&self, axes: &[AxisState; 3], velocity: &[f32; 3]) -> SteadyMotion {
        let [x, y, turning] = *velocity;
        SteadyMotion {
            point: both!(i => i64_to_f32_fast(axes[i].rounded()) * PER_POSITION_UNIT),
            theta: axes[2].rounded(),
            velocity: [x, y],
            turning,
            centre: self.constraints.centre(),
        }
    }
}

/// A jog from the state on in which its velocity is reached.
struct Jog {
    /// 2^-72 units a tick.
    wanted: [i64; 3],
    /// Where the velocity is reached.
    steady: [AxisState; 3],
    /// Seconds at the velocity wanted in which the way to it is gone from rest, and the way back; ticks of the way back.
    ramp_s: f32,
    brake_s: f32,
    brake: [u64; 3],
    from_rest: bool,
    limits: MotionLimits,
    radius: f32,
}

/// Longest that a velocity is held, ticks: two million years.
const LONGEST: f32 = 1_152_921_504_606_846_976.0;

/// A velocity of which less than this share can be reached is none.
const LEAST_SHARE: f32 = 1e-3;

impl Jog {
    /// Writes the pieces of the way there, too.
    fn new(
        state: &[AxisState; 3],
        now: &MotionState,
        wanted: [i64; 3],
        request: &JogRequest,
        pieces: &mut Pieces,
    ) -> Result<Self, RetargetError> {
        let hz = request.hz;
        let target = per_second(&wanted, hz);
        let (radius, limits) = request.limits_towards(state, now, &target)?;
        let ramp = VelocityProfile::new(now, &target, &limits).ticks(hz);
        let brake = change(&target, &limits).ticks(hz);
        write_velocity_pieces(pieces, state, &wanted, ramp);
        let half = |ticks: [u64; 3]| ticks_to_f32(ticks.iter().sum()) / (2.0 * hz);
        Ok(Self {
            wanted,
            steady: state_after_pieces(state, pieces, &[0; 3]),
            ramp_s: half(ramp),
            brake_s: half(brake),
            brake,
            from_rest: now.is_at_rest(),
            limits,
            radius,
        })
    }

    /// For how many ticks the velocity is kept before the axes have to brake; an error is in how many seconds at that
    /// velocity they would be over, too soon to reach it and to stop.
    fn hold(&self, state: &[AxisState; 3], request: &JogRequest) -> Result<u64, f32> {
        if self.wanted == [0; 3] {
            return Ok(0);
        }
        let target = per_second(&self.wanted, request.hz);
        // From rest the ramp goes the same way, at half the speed.
        let (from, done) = if self.from_rest {
            (state, self.ramp_s)
        } else {
            (&self.steady, 0.0)
        };
        let edge = request.steady(from, &target).time_to_edge(self.radius);
        let seconds = (edge - done).fmin(request.time_to_bounds(&self.steady, &self.wanted));
        if seconds < self.brake_s {
            return Err(seconds + self.ramp_s);
        }
        let hold = (seconds - self.brake_s) * request.hz;
        Ok(truncate(hold.fmin(LONGEST)) as u64)
    }

    /// Adds pieces for the velocity held for `hold` ticks and given up.
    fn finish(&self, plan: &mut Plan, state: &[AxisState; 3], hold: u64) {
        // What rounding leaves of a velocity is not given up: the nudge takes it.
        let axes = each!(i => match self.wanted[i] {
            0 => AxisState::default(),
            _ => self.steady[i],
        });
        let brake = velocity_pieces(&axes, &[0; 3], self.brake);
        for piece in [Piece::coast(hold)].into_iter().chain(brake) {
            // Nine of many.
            let _ = push_piece(&mut plan.pieces, piece);
        }
        let (rest, ticks) = (
            state_after_pieces(state, &plan.pieces, &[0; 3]),
            plan.ticks(),
        );
        plan.nudge = each!(i => -rest[i].velocity);
        plan.end = each!(i => rest[i].rest_position(ticks, plan.nudge[i]));
    }

    /// A velocity that can be reached and given up again in what way there is; zero where there is none.
    fn slower(&self, seconds: f32, request: &JogRequest) -> [i64; 3] {
        let slower = |share: f32| {
            let share = (share * 65_536.0) as i64;
            self.wanted.map(|velocity| (velocity >> 16) * share)
        };
        let (mut low, mut high) = (0.0, 1.0);
        // To a thousandth.
        for _ in 0..10 {
            let share = (low + high) / 2.0;
            let velocity = per_second(&slower(share), request.hz);
            let brake = change(&velocity, &self.limits);
            if share * brake.times_s().iter().sum::<f32>() <= seconds {
                low = share;
            } else {
                high = share;
            }
        }
        // A little less, for what a slower motion has besides: a larger disk, and in it less acceleration.
        slower(if low < LEAST_SHARE { 0.0 } else { low * 0.95 })
    }
}

/// The change of velocity by `velocity`, to it or back.
fn change(velocity: &[f32; 3], limits: &MotionLimits) -> VelocityProfile {
    VelocityProfile::new(&MotionState::default(), velocity, limits)
}
