//! Planning from motion: a new target without coming to rest before.
//!
//! Position, velocity and acceleration of a stage in motion point anywhere, so there is no line to plan on: each axis
//! gets the fastest profile of its own ([`AxisProfile`](super::AxisProfile)), and those of the faster axes are slowed
//! down to the duration of the slowest.
//!
//! ```text
//!   across                     The axes of translation are one along the way to go and one across it (`heading`). What is
//!  v * .                       under way across is braked while the axis along goes on. With shares of the limits of
//!    |    .                    acceleration in proportion to what each has to change, the velocity goes straight from where
//!    |       .                 it is to what it is to be: it stays within the circle that both lie in, and a turn is no
//!  --+----------*--- along     faster than the straight. Shares more even, with a lower speed along, may be sooner: each of
//!    |          V              a few is tried (`Choice`), and the soonest planned.
//! ```
//!
//! What couples the axes otherwise (disk, bounds, pivots, a start over the shares) is checked on the plan that comes of
//! it ([`PlanCheck`]); where the pivots ask for less, it is planned once more, slower. Where the workspace is too
//! narrow, or where a stop and a straight line are sooner, the stage has to stop first.
//!
//! | file | idea |
//! |---|---|
//! | here | one slice of planning |
//! | `heading` | the frame along the way to go and across it |
//! | `choice` | shares, heading and speeds: the soonest of a few |
//! | `slower`, `expected_demand` | by how much less than the limits, and why |
//! | `tries` | what has been tried, and what is tried next |
//! | `ahead` | what is checked in the next slice |

use super::check::target::check_target;
use super::check::violation::Violation;
use super::check::{CheckBudget, CheckedPieces, MIN_CHECKED_TICKS, PlanCheck};
use super::constraints::Constraints;
use super::plan::axis_state::AxisState;
use super::plan::units::TickLimits;
use super::plan::{Piece, Pieces, Plan, PlanStart, Position, nudge_to, state_after_pieces};
use super::profile::tracks::{brake, merged};
use super::profile::whole_ticks::{Track, fit};
use super::refusal::{Refusal, RetargetError};
use crate::number::float::ceil_ticks;
use ahead::{Ahead, HEAD};
use choice::Choice;
use tries::Tries;

pub(crate) mod ahead;
pub(crate) mod choice;
pub(super) mod expected_demand;
pub(super) mod heading;
pub(super) mod slower;
pub(crate) mod tries;

/// What is left for another target.
#[derive(Clone, Copy)]
pub struct Leave<'a> {
    /// The plan under way.
    pub of: &'a Plan,
    /// The axes at its start.
    pub from: &'a [AxisState; 3],
    /// The tick of it at which it is left.
    pub at: u64,
}

/// Plans the way to rest at `to` that leaves plan `of`, which started from `from`, at its tick `at`: with as many tries
/// as it takes, all of it at once.
pub fn plan_retarget(
    id: u32,
    of: &Plan,
    from: &[AxisState; 3],
    at: u64,
    to: Position,
    constraints: &Constraints,
) -> Result<Plan, RetargetError> {
    let (mut tries, mut plan) = (Tries::NONE, Plan::default());
    loop {
        let mut ahead = None;
        let next = &mut plan;
        let leave = Leave { of, from, at };
        let tried = try_retarget(next, id, leave, to, constraints, &mut tries, &mut ahead);
        let tried = match ahead {
            Some(ahead) => ahead.whole(&mut plan, constraints, &mut tries),
            None => tried,
        };
        if tried != Err(RetargetError::TooFast) {
            return tried.map(|()| plan);
        }
    }
}

/// Writes the first slice of the same: one try, and where all of it can not be looked at in the time, its head; then
/// the rest is left `ahead`. After a try that was too fast the next can leave what takes the place of the motion, as a
/// rule a stop.
#[inline(never)]
pub fn try_retarget(
    plan: &mut Plan,
    id: u32,
    Leave { of, from, at }: Leave<'_>,
    to: Position,
    constraints: &Constraints,
    tries: &mut Tries,
    ahead: &mut Option<Ahead>,
) -> Result<(), RetargetError> {
    check_target(&to, constraints).map_err(RetargetError::Refused)?;
    if !constraints.limits.all_positive() {
        return Err(RetargetError::Refused(Refusal::InvalidLimits));
    }
    if at >= of.ticks() {
        return Err(RetargetError::NeedsStop);
    }
    let state = of.state_after(from, at);
    let limits = TickLimits::new(constraints);
    let choice = tries
        .choice(&state, &to, &limits, constraints)
        .ok_or(RetargetError::NeedsStop)?;
    (plan.id, plan.end) = (id, to);
    plan.start = PlanStart::Splice {
        plan: of.id,
        tick: at,
    };
    choice
        .lay(&state, &to, &mut plan.pieces)
        .ok_or(RetargetError::NeedsStop)?;
    let plan_check = PlanCheck::new(constraints, limits, &state);
    let mut checked_pieces = CheckedPieces::new();
    let first = first_slice(&plan.pieces);
    let (now, later) = plan.pieces.split_at(first);
    let then = plan_check.prepare(now, &state, &mut checked_pieces);
    let end = state_after_pieces(&then, later, &[0; 3]);
    plan.nudge = nudge_to(&end, &to, plan.ticks()).ok_or(RetargetError::NeedsStop)?;
    let mut budget = CheckBudget::SLICE;
    let looked = match plan_check.check(&checked_pieces, &mut budget) {
        Ok(()) if first == plan.pieces.len() => return Ok(()),
        Ok(()) | Err(Violation::Unchecked) if budget.checked_ticks >= MIN_CHECKED_TICKS => {
            Ahead::divide(plan, &state, budget.checked_ticks, constraints, ahead)
        }
        Ok(()) => Ok(false),
        Err(broken) => Err(broken),
    };
    let looked = looked.and_then(|divided| {
        if divided {
            return Ok(());
        }
        plan_check.prepare(&plan.pieces, &state, &mut checked_pieces);
        plan_check.check(
            &checked_pieces,
            &mut CheckBudget::after(budget.checked_ticks),
        )
    });
    looked.map_err(|broken| tries.after(&broken))
}

/// How many pieces are looked at in the first slice: all of a few, or as many as a head takes.
fn first_slice(pieces: &[Piece]) -> usize {
    if pieces.len() <= FEW {
        return pieces.len();
    }
    let mut ticks = 0;
    let reaches = |piece: &Piece| {
        ticks += piece.ticks;
        ticks >= HEAD
    };
    let before = pieces.iter().position(reaches);
    before.map_or(pieces.len(), |before| before + 1)
}

/// So many pieces are looked at at once.
const FEW: usize = 12;

impl Choice {
    /// Writes the pieces of this choice.
    fn lay(&self, state: &[AxisState; 3], to: &Position, pieces: &mut Pieces) -> Option<()> {
        let view = self.heading.view(state, to);
        let mut tracks: [Track; 3] = Default::default();
        brake(&mut tracks[1], &view[1].0, self.across.map(ceil_ticks));
        for i in [0, 2] {
            let (axis, way) = view[i];
            fit(
                &mut tracks[i],
                axis,
                way,
                &self.limits[i / 2],
                self.duration(),
            )?;
        }
        merged(&tracks, pieces);
        let seen = [0, 1].map(|i| view[i].0.acceleration);
        let from = [0, 1].map(|i| state[i].acceleration);
        self.heading.turn_back(pieces, seen, from);
        Some(())
    }
}
