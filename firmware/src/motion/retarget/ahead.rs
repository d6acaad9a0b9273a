//! What lies ahead of a transition that has been handed over before all of it was looked at.
//!
//! ```text
//! velocity    ______________ _ _ _ _ _ _ _        The head is the transition's start, and a stop from where it ends: all of
//!          __/      head    \             \       that has been looked at, so what moves can always come to rest. The rest is
//!   ______/                  \   ahead     \      looked at in the next slice of the planning, and takes over from the head at
//!                             \_ stop       \_    any of its ticks: it is the same motion.
//! ```

use super::tries::Tries;
use crate::motion::check::violation::Violation;
use crate::motion::check::{CheckBudget, CheckedPieces, PlanCheck};
use crate::motion::constraints::Constraints;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::TickLimits;
use crate::motion::plan::{MAX_PIECES, Piece, Plan, PlanStart};
use crate::motion::refusal::RetargetError;
use crate::motion::stop::{Stop, write_stop};
use heapless::Vec;

/// Ticks of a head: enough for the slices that follow, 10 ms at 20 kHz.
pub(crate) const HEAD: u64 = 200;

/// How often a head's stop is tried.
const ATTEMPTS: usize = 2;

/// See the module.
#[derive(Clone, Debug)]
pub struct Ahead {
    /// All of the transition.
    whole: Plan,
    /// The axes at its start.
    start: [AxisState; 3],
    /// Ticks that have been looked at.
    seen: u64,
    /// Ticks of the head before it stops.
    head: u64,
}

impl Ahead {
    /// Leaves of `plan`, a transition of which so many ticks have been looked at, its head, and the rest `ahead`;
    /// whether there is a head, or else the plan is as it was.
    ///
    /// # Errors
    /// What the head's stop breaks, where it can not be helped: what moves would have no way to rest.
    // A plan is a kilobyte: none is handed around by value.
    pub(crate) fn divide(
        plan: &mut Plan,
        start: &[AxisState; 3],
        seen: u64,
        constraints: &Constraints,
        ahead: &mut Option<Self>,
    ) -> Result<bool, Violation> {
        let head = seen.min(HEAD);
        let mut stop = Plan::default();
        let stopped = write_stop(
            &mut stop,
            plan,
            start,
            head,
            constraints,
            Stop::Smooth,
            ATTEMPTS,
        );
        let kept = begun(&plan.pieces, head);
        match stopped {
            // The plan itself comes to rest as soon.
            None => return Ok(false),
            Some(_) if kept + stop.pieces.len() > MAX_PIECES => return Ok(false),
            Some(stopped) => stopped?,
        }
        let ahead = ahead.insert(Self {
            whole: Plan {
                pieces: Vec::new(),
                ..*plan
            },
            start: *start,
            seen,
            head,
        });
        // There is room for them, in both.
        let _ = ahead.whole.pieces.extend_from_slice(&plan.pieces);
        plan.pieces.truncate(kept);
        let over = plan.ticks().saturating_sub(head);
        if let Some(last) = plan.pieces.last_mut() {
            last.ticks -= over;
        }
        let _ = plan.pieces.extend_from_slice(&stop.pieces);
        plan.end = stop.end;
        Ok(true)
    }

    /// Whether it goes on from tick `at` of plan `id`.
    pub fn follows(&self, id: u32, at: u64) -> bool {
        self.whole.id == id && at <= self.head
    }

    /// Looks at the rest, and plans it from tick `at` of the head on.
    ///
    /// # Errors
    /// As of the transition, of which this was one of the `tries`.
    pub fn go_on(
        &self,
        id: u32,
        at: u64,
        constraints: &Constraints,
        tries: &mut Tries,
    ) -> Result<Plan, RetargetError> {
        self.look(constraints)
            .map_err(|broken| tries.after(&broken))?;
        let mut plan = Plan {
            id,
            start: PlanStart::Splice {
                plan: self.whole.id,
                tick: at,
            },
            pieces: Vec::new(),
            ..self.whole
        };
        for piece in after(&self.whole.pieces, at) {
            // They are no more than before.
            let _ = plan.pieces.push(piece);
        }
        Ok(plan)
    }

    #[inline(never)]
    fn look(&self, constraints: &Constraints) -> Result<(), Violation> {
        let plan_check = PlanCheck::new(constraints, TickLimits::new(constraints), &self.start);
        let mut checked_pieces = CheckedPieces::new();
        plan_check.prepare(&self.whole.pieces, &self.start, &mut checked_pieces);
        plan_check.check(&checked_pieces, &mut CheckBudget::after(self.seen))
    }

    /// Writes all of the transition, looked at.
    pub(crate) fn whole(
        self,
        plan: &mut Plan,
        constraints: &Constraints,
        tries: &mut Tries,
    ) -> Result<(), RetargetError> {
        self.look(constraints)
            .map_err(|broken| tries.after(&broken))?;
        *plan = self.whole;
        Ok(())
    }
}

/// How many of the pieces begin before a tick.
fn begun(pieces: &[Piece], tick: u64) -> usize {
    let mut begins = 0;
    let is_later = |piece: &Piece| {
        let later = begins >= tick;
        begins += piece.ticks;
        later
    };
    pieces.iter().position(is_later).unwrap_or(pieces.len())
}

/// What of the pieces lies after a tick.
fn after(pieces: &[Piece], tick: u64) -> impl Iterator<Item = Piece> {
    let mut ends = 0;
    pieces.iter().filter_map(move |piece| {
        ends += piece.ticks;
        let ticks = ends.saturating_sub(tick).min(piece.ticks);
        (ticks > 0).then_some(Piece { ticks, ..*piece })
    })
}
