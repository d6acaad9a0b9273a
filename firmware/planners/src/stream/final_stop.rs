//! The stop that a motion carries with it: from any state, whatever the velocity and the acceleration point to.
//!
//! The velocity is given up in three segments (see `profile/velocity`), the first with as much jerk as a stream may have:
//! an acceleration under way that is released slowly would end over the limit of speed. Every instant that may be the
//! worst is held against the limits; where a pivot is asked for too much, the stop is softer.

use motion::check::instant::{InstantCheck, InstantState};
use motion::plan::Piece;
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::MotionState;
use motion::plan::quantise::velocity_pieces;
use motion::profile::velocity::{VelocityProfile, stop_speeds};
use motion::refusal::Refusal;
use motion::tolerances::JERK_TOLERANCE;
use number::float::{FloatMinMax, ticks_to_f32};

/// Three, and the closing tick; some have no ticks.
pub(super) type StopPieces = [Piece; 4];

/// How often a softer stop is tried.
const ATTEMPTS: usize = 3;
/// A piece longer than so many ticks is looked at in the middle too: there the way may bulge, and velocity has changed.
const LONG: u64 = 256;

/// The pieces, and the state after them: at rest, but for what rounding leaves.
pub(super) fn final_stop(
    state: &[AxisState; 3],
    now: &InstantState,
    instant_check: &InstantCheck<'_>,
) -> Result<(StopPieces, [AxisState; 3]), Refusal> {
    let motion = MotionState::new(state, instant_check.hz);
    let mut part = 1.0;
    for _ in 0..ATTEMPTS {
        let limits = instant_check.limits.scaled(part, 1.0);
        let ticks = VelocityProfile::new(&motion, &[0.0; 3], &limits)
            .with_first_jerk(JERK_TOLERANCE)
            .ticks(instant_check.hz);
        let times_s = each!(k => ticks_to_f32(ticks[k]) / instant_check.hz);
        if instant_check.is_too_fast(stop_speeds(&motion, times_s)) {
            return Err(Refusal::Velocity);
        }
        let pieces = velocity_pieces(state, &[0; 3], ticks);
        let (worst, end) = walk(state, now, &pieces, instant_check).ok_or(Refusal::NoRoomToStop)?;
        if worst <= 1.0 {
            return Ok((pieces, end));
        }
        part *= (0.9 / worst).fmin(0.7);
    }
    Err(Refusal::NoRoomToStop)
}

/// The largest part of its limit that a pivot reaches, and the end; `None` where the workspace is left.
fn walk(
    state: &[AxisState; 3],
    now: &InstantState,
    pieces: &[Piece],
    instant_check: &InstantCheck<'_>,
) -> Option<(f32, [AxisState; 3])> {
    let mut axes = *state;
    let mut before = *now;
    let mut worst = 0.0_f32;
    for piece in pieces {
        let first = if piece.ticks > LONG {
            piece.ticks / 2
        } else {
            0
        };
        for ticks in [first, piece.ticks - first] {
            if ticks == 0 {
                continue;
            }
            piece.advance(&mut axes, ticks, &[0; 3]);
            // What a tick changes does not show.
            if ticks == 1 {
                continue;
            }
            let now = instant_check.evaluate(&axes).ok()?;
            if !instant_check.is_inside(&before, &now, ticks_to_f32(ticks) / instant_check.hz) {
                return None;
            }
            worst = worst.fmax(now.pivots[0]).fmax(now.pivots[1]);
            before = now;
        }
    }
    Some((worst, axes))
}

#[cfg(test)]
mod tests {
    use crate::stream::final_stop::*;
    use kinematics::Geometry;
    use motion::Constraints;
    use motion::Limits;
    use motion::plan::axis_state::AXIS_UNITS;

    const CONSTRAINTS: Constraints = Constraints::new(Limits::REFERENCE, Geometry::REFERENCE);

    /// At `x` track radii, with these mm/s, mm/s and deg/s, and mm/s^2 along x.
    fn state(x: f64, velocity: [f64; 3], along: f64) -> [AxisState; 3] {
        let hz = CONSTRAINTS.limits.rate_hz;
        let units = f64::from(AXIS_UNITS);
        let per = [100.0, 100.0, 360.0];
        let mut axes = [0, 1, 2].map(|i| AxisState {
            position: 0,
            velocity: (velocity[i] / per[i] / hz * units) as i64,
            acceleration: 0,
        });
        axes[0].position = (x * units) as i128;
        axes[0].acceleration = (along / 100.0 / hz / hz * units) as i64 / 6 * 6;
        axes
    }

    fn stopped(
        axes: &[AxisState; 3],
        constraints: &Constraints,
    ) -> Result<(StopPieces, [AxisState; 3]), Refusal> {
        let instant_check = InstantCheck::new(constraints);
        final_stop(axes, &instant_check.evaluate(axes)?, &instant_check)
    }

    #[test]
    fn it_comes_to_rest_along_its_way_in_the_time_that_the_limits_ask_for() {
        // 200 mm/s at 4 m/s^2 and 400 m/s^3: 50 ms and 10 ms, 6 mm.
        let axes = state(0.0, [200.0, 0.0, 0.0], 0.0);
        let (pieces, end) = stopped(&axes, &CONSTRAINTS).unwrap();
        let ticks: u64 = pieces.iter().map(|piece| piece.ticks).sum();
        assert!(ticks.abs_diff(1_200) <= 2, "{ticks}");
        let mm = (end[0].position - axes[0].position) as f64 / f64::from(AXIS_UNITS) * 100.0;
        assert!((mm - 6.0).abs() < 0.01, "{mm}");
        assert!(end.iter().all(|axis| axis.acceleration == 0));
        // What is left is no speed that anything could follow.
        assert!(end.iter().all(|axis| axis.velocity.abs() < 1 << 32));
        assert_eq!((end[1], end[2]), (axes[1], axes[2]));
    }

    #[test]
    fn an_acceleration_under_way_is_given_up_too() {
        let axes = state(0.0, [100.0, 30.0, 90.0], 3_000.0);
        let (_, end) = stopped(&axes, &CONSTRAINTS).unwrap();
        assert!(end.iter().all(|axis| axis.acceleration == 0));
        assert!(
            end.iter().all(|axis| axis.velocity.abs() < 1 << 32),
            "{end:?}"
        );
    }

    #[test]
    fn at_rest_there_is_nothing_to_do() {
        let (pieces, _) = stopped(&state(0.0, [0.0; 3], 0.0), &CONSTRAINTS).unwrap();
        assert!(pieces.iter().all(|piece| piece.jerk == [0; 3]));
    }

    #[test]
    fn near_the_edge_there_is_none() {
        assert!(stopped(&state(0.73, [200.0, 0.0, 0.0], 0.0), &CONSTRAINTS).is_ok());
        let late = stopped(&state(0.75, [200.0, 0.0, 0.0], 0.0), &CONSTRAINTS);
        assert_eq!(late.err(), Some(Refusal::NoRoomToStop));
        assert!(stopped(&state(0.75, [-200.0, 0.0, 0.0], 0.0), &CONSTRAINTS).is_ok());
    }

    #[test]
    fn with_weak_drives_it_is_softer() {
        let axes = state(0.0, [0.0, 0.0, 300.0], 0.0);
        let ticks = |constraints: &Constraints| -> u64 {
            let (pieces, _) = stopped(&axes, constraints).unwrap();
            pieces.iter().map(|piece| piece.ticks).sum()
        };
        let mut weak = CONSTRAINTS;
        weak.limits.pivot_acceleration_rad_s2 = 100.0;
        assert!(ticks(&weak) > ticks(&CONSTRAINTS) * 11 / 10);
    }
}
