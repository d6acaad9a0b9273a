//! The plans of a stream: knots along the curve, held against every limit, and the stop after them.

use super::final_stop::final_stop;
use super::spline::curve_point;
use super::state::{PART_BITS, SentPlan, Stream};
use motion::check::{Budget, PlanCheck, Violation};
use motion::constraints::Constraints;
use motion::plan::axis_state::{AxisState, SUB_BITS};
use motion::plan::{Piece, Plan, PlanStart, Position, nudge_to, state_after_pieces};
use motion::refusal::Refusal;

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
        let state = self.knots(&mut plan, from);
        let plan_check = PlanCheck::for_stream(constraints);
        (plan_check.check(&plan.pieces, &from, &mut { Budget::FOR_ANSWER }))
            .map_err(|violation| refusal(violation, constraints))?;
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
                let _ = plan.pieces.push(Piece {
                    ticks: 1,
                    jerk: [0; 3],
                });
            }
        }
        Ok((plan, from, SentPlan { id, splice, state }))
    }

    /// Adds the pieces along the curve; where they lead.
    fn knots(&mut self, plan: &mut Plan, from: [AxisState; 3]) -> [AxisState; 3] {
        let mut state = from;
        for _ in 0..self.knots {
            self.pass();
            for piece in self.pieces(&state) {
                piece.advance(&mut state, piece.ticks, &[0; 3]);
                // Six times three, and five of the stop: they fit.
                let _ = plan.pieces.push(piece);
            }
            if self.is_at_the_end() {
                self.complete = true;
                break;
            }
        }
        state
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
        let mut pieces = self.knot.ticks.map(|ticks| Piece {
            ticks,
            jerk: [0; 3],
        });
        const ONE: f32 = (1_u64 << PART_BITS) as f32;
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
fn refusal(violation: Violation, constraints: &Constraints) -> Refusal {
    let mm = constraints.geometry.radius_mm;
    match violation {
        Violation::Disk(radius) => Refusal::OutsideDisk {
            radius_mm: f64::from(radius) * mm,
            usable_mm: constraints.usable_radius * mm,
        },
        Violation::Bounds(axis) => Refusal::OutOfBounds { axis },
        Violation::Speed(_) => Refusal::Velocity,
        Violation::Acceleration(_) => Refusal::Acceleration,
        Violation::Jerk(_) => Refusal::Jerk,
        Violation::PivotRate(_) | Violation::PivotAcceleration(_) => Refusal::Pivots,
        Violation::NoRoomToStop => Refusal::NoRoomToStop,
    }
}
