//! The stop that a motion carries with it: from any state, whatever the velocity and the acceleration point to.
//!
//! The velocity is given up in three segments (see `profile/velocity`), the first with as much jerk as a stream may have:
//! an acceleration under way that is released slowly would end over the limit of speed. Where a pivot is asked for too
//! much, the stop is softer.

use motion::check::{Budget, PlanCheck, Violation};
use motion::constraints::Constraints;
use motion::plan::Piece;
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::MotionState;
use motion::plan::quantise::velocity_pieces;
use motion::profile::velocity::VelocityProfile;
use motion::refusal::Refusal;
use motion::tolerances::JERK_TOLERANCE;
use number::float::FloatMinMax;

/// How often a softer stop is tried.
const ATTEMPTS: usize = 3;

/// The pieces, of which some have no ticks; after them it is at rest, but for what rounding leaves.
pub(super) fn final_stop(
    state: &[AxisState; 3],
    constraints: &Constraints,
    plan_check: &PlanCheck,
) -> Result<[Piece; 4], Refusal> {
    let hz = constraints.limits.rate_hz as f32;
    let motion = MotionState::new(state, hz);
    let mut part = 1.0;
    for _ in 0..ATTEMPTS {
        let limits = constraints.motion_limits().scaled(part, 1.0);
        let ticks = VelocityProfile::new(&motion, &[0.0; 3], &limits)
            .with_first_jerk(JERK_TOLERANCE)
            .ticks(hz);
        let pieces = velocity_pieces(state, &[0; 3], ticks);
        match plan_check.check(&pieces, state, &mut { Budget::FOR_STOP }) {
            Ok(()) => return Ok(pieces),
            Err(Violation::Speed(_)) => return Err(Refusal::Velocity),
            Err(Violation::PivotRate(over) | Violation::PivotAcceleration(over)) => {
                part *= (0.9 / over).fmin(0.7);
            }
            Err(_) => break,
        }
    }
    Err(Refusal::NoRoomToStop)
}

#[cfg(test)]
mod tests {
    use crate::stream::final_stop::*;
    use kinematics::Geometry;
    use motion::Limits;
    use motion::plan::axis_state::AXIS_UNITS;
    use motion::plan::state_after_pieces;

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
    ) -> Result<([Piece; 4], [AxisState; 3]), Refusal> {
        let pieces = final_stop(axes, constraints, &PlanCheck::for_stream(constraints))?;
        Ok((pieces, state_after_pieces(axes, &pieces, &[0; 3])))
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
