//! Planning from motion: a new target, or a stop, without coming to rest before.
//!
//! Position, velocity and acceleration of a stage in motion point anywhere, so there is no line to plan on: each axis gets
//! the fastest profile of its own ([`AxisProfile`]), and those of the faster axes are slowed down to the duration of the
//! slowest. The axes of translation are turned to the way to go ([`Heading`]); limits along the path become theirs by shares
//! whose squares add up to 1: no diagonal is faster than a straight. Speed along needs no share as long as speed across is
//! being lost; where that would make the path too fast, as in a sharp turn, less speed along is tried. What couples the axes otherwise (usable disk, pivots' rate, a start over the shares) is checked on the plan
//! that comes of it ([`Envelope`]); where it fails, also with speeds that keep the pivots' rate anywhere on the way, the stage
//! has to stop first.

use super::axis::{Axis, JERK_STEP, SUB_BITS};
use super::axis_profile::{AxisLimits, AxisProfile, stop_distance, stop_durations};
use super::envelope::{Bounds, Envelope};
use super::fit::{Track, fit, task};
use super::heading::Heading;
use super::limits::{Limits, centre};
use super::line::{Refusal, check_target};
use super::plan::{MAX_PIECES, Piece, Plan, Position, Start};
use super::stop::{Stop, jerks};
use heapless::Vec;
use kinematics::{Geometry, worst_rate_per_rotation, worst_rate_per_speed};

/// Why there is no transition. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoTransition {
    /// The target can not be moved to at all.
    Refused(Refusal),
    /// It can, but not without a stop before.
    NeedsStop,
}

/// Plans the way to rest at `to` that leaves plan `of`, which started from `from`, at its tick `at`. x and y stay within `bounds`.
#[allow(clippy::too_many_arguments)]
pub fn plan_transition(
    id: u32,
    of: &Plan,
    from: &[Axis; 3],
    at: u64,
    to: Position,
    limits: &Limits,
    geometry: &Geometry,
    bounds: &Bounds,
) -> Result<Plan, NoTransition> {
    check_target(&to, geometry).map_err(NoTransition::Refused)?;
    if !limits.all_positive() {
        return Err(NoTransition::Refused(Refusal::Limits));
    }
    if at >= of.ticks() {
        return Err(NoTransition::NeedsStop);
    }
    let state = of.state_after(from, at);
    let heading = Heading::new(&state, &to, limits, geometry);
    let view = heading.view(&state, &to);
    let shares = shares(&view, limits);
    let envelope = Envelope::new(limits, geometry, bounds, &state);
    let slow = pivot_scales(&state, &to, limits, geometry);
    let even = [DIAGONAL; 2];
    let kept = kept(&view, limits, geometry);
    for (shares, [along, across, turning]) in [
        (Some(shares), [1.0, 1.0, 1.0]),
        (kept.and(Some(even)), [kept.unwrap_or(1.0), 1.0, 1.0]),
        (Some(shares), [slow[0], slow[0], slow[1]]),
        (
            kept.and(Some(even)),
            [kept.unwrap_or(1.0) * slow[0], slow[0], slow[1]],
        ),
    ] {
        let Some(shares) = shares else { continue };
        let axis_limits = axis_limits(limits, geometry, shares, [along, across, turning]);
        let Some(mut pieces) = pieces(&view, &axis_limits) else {
            continue;
        };
        heading.turn_back(&mut pieces, &state);
        let Some(nudge) = nudge(&pieces, &state, &to) else {
            continue;
        };
        let plan = Plan {
            id,
            start: Start::Splice {
                plan: of.id,
                tick: at,
            },
            pieces,
            nudge,
            end: to,
        };
        if envelope.holds(&plan, &state) && can_stop(&plan, &state, limits, geometry) {
            return Ok(plan);
        }
    }
    Err(NoTransition::NeedsStop)
}

/// Plans the stop that leaves a plan whose velocity and acceleration are not parallel; see
/// [`plan_stop`](super::plan_stop). Each axis stops as fast as its share of the limits allows.
pub fn plan_curved_stop(
    id: u32,
    of: &Plan,
    axes: &[Axis; 3],
    at: u64,
    limits: &Limits,
    geometry: &Geometry,
    stop: Stop,
) -> Option<Plan> {
    if at >= of.ticks() {
        return None;
    }
    let state = of.state_after(axes, at);
    let factor = match stop {
        Stop::Smooth => 1.0,
        Stop::Urgent => limits.stop_factor,
    };
    let axis_limits = stop_limits(limits, geometry, factor);
    let mut after = state;
    let release = release(&mut after, limits, geometry, factor);
    let tracks: [Track; 3] = [0, 1, 2].map(|i| {
        let first = (i < 2).then(|| (release.0, release.1[i]));
        stop_track(
            first.filter(|&(ticks, _)| ticks > 0),
            &after[i],
            &axis_limits[i],
        )
    });
    let pieces = merged(&tracks);
    let mut plan = Plan {
        id,
        start: Start::Splice {
            plan: of.id,
            tick: at,
        },
        pieces,
        nudge: [0; 3],
        end: of.end,
    };
    if at + plan.ticks() >= of.ticks() {
        return None;
    }
    plan.end = run(&plan.pieces, &state).map(|axis| axis.rounded());
    Some(plan)
}

/// Half each of the square of what the path is allowed.
const DIAGONAL: f64 = core::f64::consts::FRAC_1_SQRT_2;
/// Distance to the limits, for what rounding to ticks costs.
const MARGIN: f64 = 0.998;
/// Least part of a speed that is left when the pivots ask for less: what is under way has to end too.
const LEAST_NEED: f64 = 0.1;

/// Shares of the ways along and across in the limits of translation: as their parts in what is to be done, but never more
/// uneven than 2:1 lest an axis that only has to come to rest can not. All for one when the other has nothing to do.
fn shares(view: &[(Axis, i128); 3], limits: &Limits) -> [f64; 2] {
    let stop_ticks = limits.speed_mm_s / limits.acceleration_mm_s2 * limits.rate_hz;
    let needs = [0, 1].map(|i| {
        let (axis, way) = &view[i];
        let task = task(axis, axis.position + way);
        task.distance.abs()
            + (task.velocity.abs() + task.acceleration.abs() * stop_ticks / 2.0) * stop_ticks / 2.0
    });
    match needs {
        [_, 0.0] => [1.0, 0.0],
        [0.0, _] => [0.0, 1.0],
        [x, y] => {
            let (x, y) = (x.max(y / 2.0), y.max(x / 2.0));
            let length = libm::hypot(x, y);
            [x / length, y / length]
        }
    }
}

/// For a sharp turn, the part of the speed limit that is granted along. With even shares in acceleration, speed along is gained as
/// fast as speed across is lost: the path is never faster than at the start when the speed along ends at the greater of the
/// two. `None` where so low a speed costs more time than to stop first.
fn kept(view: &[(Axis, i128); 3], limits: &Limits, geometry: &Geometry) -> Option<f64> {
    let mm = libm::exp2(-72.0) * geometry.radius_mm;
    let speed = |i: usize| (view[i].0.velocity as f64).abs() * mm * limits.rate_hz;
    let kept = (speed(0).max(speed(1)) / limits.speed_mm_s).clamp(DIAGONAL, 1.0);
    let seconds = (view[0].1 as f64).abs() * mm / limits.speed_mm_s;
    let stop_seconds = limits.speed_mm_s / limits.acceleration_mm_s2
        + limits.acceleration_mm_s2 / limits.jerk_mm_s3;
    (seconds * (1.0 / kept - 1.0) < stop_seconds).then_some(kept)
}

/// By how much the speeds of translation and rotation have to be lower for the pivots to keep their rate anywhere on the way:
/// each as low as the other's duration allows, and both in proportion from there.
fn pivot_scales(
    state: &[Axis; 3],
    to: &Position,
    limits: &Limits,
    geometry: &Geometry,
) -> [f64; 2] {
    let way = [0, 1, 2].map(|i| task(&state[i], target(to[i])).distance * libm::exp2(-72.0));
    let speed = limits.speed_mm_s / geometry.radius_mm;
    let turning = limits.turn_speed_deg_s.to_radians();
    let seconds = [
        libm::hypot(way[0], way[1]) / speed,
        way[2].abs() * core::f64::consts::TAU / turning,
    ];
    let longest = seconds[0].max(seconds[1]);
    let needs = seconds.map(|seconds| (seconds / longest).max(LEAST_NEED));
    let [from, to] = [centre(&state.map(|axis| axis.rounded())), centre(to)];
    let furthest = libm::hypot(from[0], from[1]).max(libm::hypot(to[0], to[1]));
    let pivots = needs[0] * speed * worst_rate_per_speed(furthest)
        + needs[1] * turning * worst_rate_per_rotation(furthest);
    needs.map(|need| need * (limits.pivot_rate_rad_s / pivots).min(1.0))
}

/// Limits of two axes of translation, with their shares in acceleration and jerk, and of theta, in 2^-72 units and ticks; the
/// speeds are scaled.
fn axis_limits(
    limits: &Limits,
    geometry: &Geometry,
    shares: [f64; 2],
    scales: [f64; 3],
) -> [AxisLimits; 3] {
    let unit = libm::exp2(72.0) * MARGIN;
    let hz = limits.rate_hz;
    let axis = |unit: f64, share: f64, speed: f64, acceleration: f64, jerk: f64| AxisLimits {
        velocity: speed * unit / hz,
        acceleration: acceleration * share * unit / (hz * hz),
        jerk: jerk * share * unit / (hz * hz * hz),
    };
    let translation = |i: usize| {
        axis(
            unit / geometry.radius_mm,
            shares[i],
            limits.speed_mm_s * scales[i],
            limits.acceleration_mm_s2,
            limits.jerk_mm_s3,
        )
    };
    [
        translation(0),
        translation(1),
        axis(
            unit / 360.0,
            1.0,
            limits.turn_speed_deg_s * scales[2],
            limits.turn_acceleration_deg_s2,
            limits.turn_jerk_deg_s3,
        ),
    ]
}

fn stop_limits(limits: &Limits, geometry: &Geometry, factor: f64) -> [AxisLimits; 3] {
    axis_limits(limits, geometry, [DIAGONAL; 2], [1.0; 3]).map(|limits| AxisLimits {
        acceleration: limits.acceleration * factor,
        jerk: limits.jerk * factor * factor,
        ..limits
    })
}

pub(super) fn target(units: i64) -> i128 {
    i128::from(units) << SUB_BITS
}

pub(super) type Pieces = Vec<Piece, MAX_PIECES>;

/// The pieces of all axes, that arrive together as far as they can.
fn pieces(view: &[(Axis, i128); 3], limits: &[AxisLimits; 3]) -> Option<Pieces> {
    let mut duration = 0.0_f64;
    for ((axis, way), limits) in view.iter().zip(limits) {
        let task = task(axis, axis.position + way);
        // An axis that has nothing to do needs no limits.
        if task.distance != 0.0 || task.velocity != 0.0 || task.acceleration != 0.0 {
            duration = duration.max(AxisProfile::fastest(&task, limits).ok()?.duration());
        }
    }
    let mut tracks: [Track; 3] = Default::default();
    for (track, ((axis, way), limits)) in tracks.iter_mut().zip(view.iter().zip(limits)) {
        *track = fit(*axis, *way, limits, duration)?;
    }
    Some(merged(&tracks))
}

/// The nudge that makes the end exact.
fn nudge(pieces: &Pieces, state: &[Axis; 3], to: &Position) -> Option<[i64; 3]> {
    let ticks: u64 = pieces.iter().map(|piece| piece.ticks).sum();
    let end = run(pieces, state);
    let mut nudge = [0; 3];
    for i in 0..3 {
        let rest = (target(to[i]) - end[i].position) / i128::from(ticks.max(1));
        nudge[i] = i64::try_from(rest).ok()?;
    }
    Some(nudge)
}

/// The states after the last piece, without a nudge, not brought to rest.
fn run(pieces: &Pieces, state: &[Axis; 3]) -> [Axis; 3] {
    let mut axes = *state;
    for piece in pieces {
        for (axis, jerk) in axes.iter_mut().zip(piece.jerk) {
            *axis = axis.after(piece.ticks, jerk, 0);
        }
    }
    axes
}

/// One list of pieces from three tracks: a new one wherever a jerk changes. It has room for all segments of all axes.
fn merged(tracks: &[Track; 3]) -> Pieces {
    let mut pieces = Pieces::new();
    let mut at = [0; 3];
    let mut done = [0; 3];
    loop {
        let now = [0, 1, 2].map(|i| tracks[i].get(at[i]).copied());
        let left = [0, 1, 2].map(|i| now[i].map(|(ticks, _)| ticks - done[i]));
        let Some(ticks) = left.into_iter().flatten().min() else {
            return pieces;
        };
        let _ = pieces.push(Piece {
            ticks,
            jerk: now.map(|segment| segment.map_or(0, |(_, jerk)| jerk)),
        });
        for i in 0..3 {
            done[i] += ticks;
            if left[i] == Some(ticks) {
                at[i] += 1;
                done[i] = 0;
            }
        }
    }
}

/// Releases the acceleration of translation, at all the jerk the path is allowed, where it speeds the stage up: with its share
/// alone an axis would pass the speed limit before it brakes. Ticks, and the jerks of x and y.
fn release(
    state: &mut [Axis; 3],
    limits: &Limits,
    geometry: &Geometry,
    factor: f64,
) -> (u64, [i64; 2]) {
    let [x, y] = [0, 1].map(|i| (state[i].velocity as f64, state[i].acceleration as f64));
    if x.0 * x.1 + y.0 * y.1 <= 0.0 {
        return (0, [0; 2]);
    }
    let hz = limits.rate_hz;
    let jerk = limits.jerk_mm_s3 * factor * factor / geometry.radius_mm * libm::exp2(72.0)
        / (hz * hz * hz);
    let ticks = libm::ceil(libm::hypot(x.1, y.1) / jerk).max(1.0) as u64;
    let mut jerks = [0; 2];
    for i in 0..2 {
        let step = JERK_STEP;
        jerks[i] = -state[i].acceleration / ticks as i64 / step * step;
        state[i] = state[i].after(ticks, jerks[i], 0);
    }
    (ticks, jerks)
}

/// The stop of one axis, after a first segment.
fn stop_track(first: Option<(u64, i64)>, axis: &Axis, limits: &AxisLimits) -> Track {
    let mut track: Track = first.into_iter().collect();
    if axis.velocity == 0 && axis.acceleration == 0 {
        return track;
    }
    let mut axis = *axis;
    let over = axis.acceleration.abs() as f64 - limits.acceleration;
    if over > 0.0 {
        let ticks = libm::ceil(over / limits.jerk);
        let step = JERK_STEP;
        let jerk = (-(over.copysign(axis.acceleration as f64)) / ticks) as i64 / step * step;
        let _ = track.push((ticks as u64, jerk));
        axis = axis.after(ticks as u64, jerk, 0);
    }
    let mut n =
        stop_durations(&task(&axis, axis.position), limits).map(|ticks| libm::ceil(ticks) as u64);
    n[0] = n[0].max(1);
    n[2] = n[2].max(1);
    // Rounding to ticks has lengthened the segments unevenly: a jerk or the peak may have grown a little.
    for _ in 0..40 {
        let [first, last] = jerks(&axis, n);
        let peak = (axis.acceleration + first * n[0] as i64) as f64;
        let most = limits
            .acceleration
            .max(axis.acceleration.unsigned_abs() as f64);
        let over = [
            first.unsigned_abs() as f64 / limits.jerk,
            peak.abs() / most,
            last.unsigned_abs() as f64 / limits.jerk,
        ];
        if over.iter().all(|&over| over <= 1.0) {
            break;
        }
        // Out of an acceleration a longer release alone would ask for a higher peak after it.
        if over[0] > 1.0 && peak * (axis.acceleration as f64) < 0.0 {
            n[1] += 1 + n[0] / 8;
        }
        for (ticks, over) in n.iter_mut().zip(over) {
            if over > 1.0 {
                *ticks += 1 + *ticks / 8;
            }
        }
    }
    let [first, last] = jerks(&axis, n);
    for (ticks, jerk) in [(n[0], first), (n[1], 0), (n[2], last)] {
        if ticks > 0 {
            let _ = track.push((ticks, jerk));
        }
    }
    track
}

/// Whether a smooth stop from wherever two pieces of a plan meet ends inside the usable disk.
fn can_stop(plan: &Plan, state: &[Axis; 3], limits: &Limits, geometry: &Geometry) -> bool {
    let stops = stop_limits(limits, geometry, 1.0);
    let mut axes = *state;
    plan.pieces.iter().all(|piece| {
        let mut after = axes;
        release(&mut after, limits, geometry, 1.0);
        let end = [0, 1].map(|i| {
            let way = stop_distance(&task(&after[i], after[i].position), &stops[i]);
            (after[i].position as f64 + way) * libm::exp2(-72.0)
        });
        for (i, axis) in axes.iter_mut().enumerate() {
            *axis = axis.after(piece.ticks, piece.jerk[i], plan.nudge[i]);
        }
        libm::hypot(end[0], end[1]) <= geometry.usable_radius() + 1e-6
    })
}
