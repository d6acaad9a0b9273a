//! The plans of a stream: knots along the curve, held against every limit, and the stop after them.
//!
//! The stop leads on from any state, wherever the velocity and the acceleration point to. The velocity is given up in three
//! segments (see `profile/velocity`), the first with as much jerk as a stream may have: an acceleration under way that is
//! released slowly would end over the limit of speed. Where a pivot is asked for too much, the stop is softer.

use super::curve::curve_point;
use super::{ONE, PART_BITS, SentPlan, Stream};
use motion::check::{BUDGET, PlanCheck, Violation};
use motion::constraints::Constraints;
use motion::plan::axis_state::{AxisState, SUB_BITS};
use motion::plan::cubic_segment::MotionState;
use motion::plan::quantise::velocity_pieces;
use motion::plan::{Piece, Plan, PlanStart, Position, nudge_to, state_after_pieces};
use motion::profile::velocity::VelocityProfile;
use motion::refusal::Refusal;
use motion::tolerances::JERK_TOLERANCE;
use number::float::FloatMinMax;

/// A plan, the axes that it starts from, and what is left when it is sent.
pub(super) type Planned = (Plan, [AxisState; 3], SentPlan);

impl Stream {
    /// The next plan, with the curve passed by its knots; after `sent`, or from rest.
    pub(super) fn plan(
        &mut self,
        id: u32,
        sent: Option<SentPlan>,
        constraints: &Constraints,
    ) -> Result<Planned, Refusal> {
        let rest = self.target(2);
        let (start, from) = match sent {
            Some(SentPlan { id, splice, state }) => {
                let (plan, tick) = (id, splice);
                (PlanStart::Splice { plan, tick }, state)
            }
            None => (PlanStart::Rest(rest), rest.map(AxisState::at_rest)),
        };
        let mut plan = Plan::new(id, start, rest);
        let plan_check = PlanCheck::for_stream(constraints);
        let state = (self.knots(&mut plan, from, &plan_check)).map_err(refusal)?;
        let splice = plan.ticks();
        if self.complete {
            plan.end = self.target(2);
            plan.nudge = nudge_to(&state, &plan.end, splice).ok_or(Refusal::InvalidLimits)?;
        } else {
            let stop = final_stop(&state, constraints, &plan_check)?;
            let end = state_after_pieces(&state, &stop, &[0; 3]);
            plan.pieces
                .extend(stop.into_iter().filter(|piece| piece.ticks > 0));
            plan.end = end.map(|axis| axis.rounded());
            if plan.ticks() == splice {
                // At rest there is nothing to stop; but a plan that is over can not be left.
                let _ = plan.pieces.push(Piece::coast(1));
            }
        }
        Ok((plan, from, SentPlan { id, splice, state }))
    }

    /// Adds the pieces along the curve; where they lead. Each knot is checked before the next: one that no stage can pass leads to states
    /// that the next one's numbers do not hold.
    fn knots(
        &mut self,
        plan: &mut Plan,
        from: [AxisState; 3],
        plan_check: &PlanCheck,
    ) -> Result<[AxisState; 3], Violation> {
        let (mut state, mut budget) = (from, BUDGET);
        for _ in 0..self.knots {
            self.pass();
            let pieces = self.pieces(&state);
            plan_check.check(&pieces, &state, &mut budget)?;
            for piece in pieces {
                piece.advance(&mut state, piece.ticks, &[0; 3]);
                // Six times three, and five of the stop: they fit.
                let _ = plan.pieces.push(piece);
            }
            if self.is_at_the_end() {
                self.complete = true;
                break;
            }
        }
        Ok(state)
    }

    /// Passes the curve by a knot.
    fn pass(&mut self) {
        self.part += self.knot.whole() * self.rate;
        while self.part >> PART_BITS != 0 {
            self.part -= 1 << PART_BITS;
            // The last target stays: it stands for all that would come.
            if self.targets.len() > 1 {
                let _ = self.targets.pop_front();
            }
        }
    }

    /// The pieces from a state to where the curve is now.
    fn pieces(&self, state: &[AxisState; 3]) -> [Piece; 3] {
        let mut pieces = self.knot.ticks.map(Piece::coast);
        let window = [0, 1, 2, 3, 4, 5].map(|k| self.target(k));
        let (part, rate) = (self.part as f32 / ONE, self.rate as f32 / ONE);
        for (i, axis) in state.iter().enumerate() {
            let point = curve_point(&window, i, part);
            let units = (1_u64 << SUB_BITS) as f32;
            let velocity = point.rate * rate * units;
            let acceleration = point.acceleration * rate * rate * units;
            let to = AxisState {
                position: (i128::from(window[2][i]) << SUB_BITS)
                    + (i128::from((point.offset * FINE) as i64) << (SUB_BITS - FINE_BITS)),
                velocity: velocity as i64,
                acceleration: acceleration as i64,
            };
            for (piece, jerk) in pieces.iter_mut().zip(self.knot.jerks(axis, &to)) {
                piece.jerk[i] = jerk;
            }
        }
        pieces
    }

    /// A target of the window; the last one stands for those that are not there.
    #[inline(never)]
    fn target(&self, place: usize) -> Position {
        let last = self.targets.len() - 1;
        match self.targets.get(place.min(last)) {
            Some(target) => each!(i => target[i]),
            // There is one always: the start, or the last.
            None => Position::default(),
        }
    }

    fn is_at_the_end(&self) -> bool {
        let first = self.target(0);
        self.announced && self.targets.iter().all(|target| *target == first)
    }
}

/// Bits of a place on the curve below a position's unit.
const FINE_BITS: u32 = 20;
const FINE: f32 = (1_u32 << FINE_BITS) as f32;

/// Why targets are refused that break this.
fn refusal(violation: Violation) -> Refusal {
    match violation {
        Violation::Disk => Refusal::OutsideDisk,
        Violation::Bounds(axis) => Refusal::OutOfBounds { axis },
        Violation::Speed => Refusal::Velocity,
        Violation::Acceleration => Refusal::Acceleration,
        Violation::Jerk => Refusal::Jerk,
        Violation::Pivots => Refusal::Pivots,
        Violation::TooLong => Refusal::NoRoomToStop,
    }
}

/// How often a softer stop is tried.
const ATTEMPTS: usize = 3;

/// The pieces, of which some have no ticks; after them it is at rest, but for what rounding leaves.
fn final_stop(
    state: &[AxisState; 3],
    constraints: &Constraints,
    plan_check: &PlanCheck,
) -> Result<[Piece; 4], Refusal> {
    let hz = constraints.limits.rate_hz as f32;
    let motion = MotionState::new(state, hz);
    let mut part = 1.0;
    for _ in 0..ATTEMPTS {
        let limits = constraints.motion_limits().scaled(part, 1.0);
        let mut profile = VelocityProfile::new(&motion, &[0.0; 3], &limits);
        profile.first_jerk = JERK_TOLERANCE;
        let pieces = velocity_pieces(state, &[0; 3], profile.ticks(hz));
        match plan_check.check(&pieces, state, &mut { BUDGET }) {
            Ok(()) => return Ok(pieces),
            Err(Violation::Speed) => return Err(Refusal::Velocity),
            Err(Violation::Pivots) => {
                let [rate, acceleration] = plan_check.pivot_parts(&pieces, state);
                let over = rate.fmax(acceleration);
                part *= (0.9 / over).fmin(0.7);
            }
            Err(_) => break,
        }
    }
    Err(Refusal::NoRoomToStop)
}

#[cfg(test)]
mod tests {
    use crate::stream::plans::*;
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
