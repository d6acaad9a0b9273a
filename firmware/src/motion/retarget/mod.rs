//! A new target in motion: the end of the motion under way, and a line from there, that overlap.
//!
//! ```text
//! speed  ____                              A plan is linear in its pieces: a stop that ends at A, and a line from A to the
//!            \    stop                     target that begins before the stop is over, add up to a motion that ends at the
//!             \____                        target, at rest, whatever the delay. With a delay as long as the stop it is
//!               ________                   "stop, then line", of which both were planned within every limit. The least
//!         |    /  line  \                  delay at which the check is content is taken. Towards a target straight ahead
//!         |___/          \____             the stop's braking and the line's acceleration cancel: the stage goes on.
//!         delay
//! ```
//!
//! Some pairs of shares of the limits for stop and line are tried, and the motion under way as it is, followed to its
//! end, in place of a stop: for a target that is corrected, and out of a stop. The soonest wins. PLCopen calls it
//! superimposed motion.
//!
//! | file | idea |
//! |---|---|
//! | here | candidates, and the soonest that the check is content with |
//! | `part`, `corner` | translation or rotation; a motion by its corners |
//! | `ending` | how the motion under way comes to rest |
//! | `line` | the plain line from there |
//! | `candidate` | for translation and for rotation an ending, a line, and the least delay between them |
//! | `overlap` | whether two motions that overlap keep to the limits of path and rotation, in floats |

mod candidate;
mod corner;
mod ending;
mod line;
mod overlap;
mod part;

use super::check::PlanCheck;
use super::check::target::check_target;
use super::check::violation::Violation;
use super::constraints::Constraints;
use super::plan::axis_state::AxisState;
use super::plan::{Pieces, Plan, PlanStart, Position, nudge_to, state_after_pieces};
use super::refusal::{Refusal, RetargetError};
use super::tolerances::SLOWER_FOR_PIVOTS;
use crate::number::sqrt_f32;
use candidate::{Candidate, PartWay};
use ending::{Ended, Ending, Leaving};
use overlap::Overlap;
use part::Part;

/// How the motion under way ends, and the shares of the limits that the line gets.
const ENDINGS: [(Ending, &[f32]); 7] = [
    (Ending::Followed, &[1.0, 0.5]),
    (Ending::Stop(1.0, 1.0), &[1.0, 0.7]),
    (Ending::Stop(0.7, 0.7), &[0.7, 1.0]),
    (Ending::Stop(1.0, 0.7), &[0.7]),
    (Ending::Stop(1.0, 0.5), &[0.5, 0.85]),
    (Ending::Stop(0.5, 0.5), &[0.85]),
    (Ending::Stop(0.85, 0.85), &[0.5]),
];

/// How many of the ways are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// So many that the stage is soon on its way.
    First,
    /// All.
    All,
}

/// Of the endings, how many are tried at first.
const FIRST: usize = 2;
/// Intervals that the checks of a first way may take together, and those of all.
const FIRST_INTERVALS: usize = 24;
const ALL_INTERVALS: usize = 60;

const PARTS: [Part; 2] = [Part::Translation, Part::Rotation];

/// How often the check may be asked.
const CHECKS: usize = 4;

/// Plans the way to rest at `to` that leaves plan `of`, which started from `from`, at its tick `at`.
///
/// # Errors
/// [`RetargetError::Refused`] where the target can not be moved to; [`RetargetError::NeedsStop`] where there is no way
/// but to come to rest first.
#[inline(never)]
pub fn plan_retarget(
    id: u32,
    of: &Plan,
    from: &[AxisState; 3],
    at: u64,
    to: Position,
    constraints: &Constraints,
    effort: Effort,
) -> Result<Plan, RetargetError> {
    let (tried, mut intervals) = match effort {
        Effort::First => (FIRST, FIRST_INTERVALS),
        Effort::All => (ENDINGS.len(), ALL_INTERVALS),
    };
    check_target(&to, constraints).map_err(RetargetError::Refused)?;
    if !constraints.limits.all_positive() {
        return Err(RetargetError::Refused(Refusal::InvalidLimits));
    }
    if at >= of.ticks() {
        return Err(RetargetError::NeedsStop);
    }
    let leaving = Leaving::new(of, from, at, to, constraints);
    if leaving.is_outside() {
        return Err(RetargetError::NeedsStop);
    }
    let mut ended = Ended::default();
    let mut candidate = soonest(&leaving, tried, &mut ended).ok_or(RetargetError::NeedsStop)?;
    let mut pieces = Pieces::new();
    let plan_check = PlanCheck::new(constraints, &leaving.state);
    for _ in 0..CHECKS {
        if intervals == 0 {
            break;
        }
        (candidate.write_floats(&leaving, &mut ended, &mut pieces))
            .ok_or(RetargetError::NeedsStop)?;
        match plan_check.check_floats(&pieces, &leaving.state, &mut intervals) {
            Ok(()) => {
                let start = PlanStart::Splice {
                    plan: of.id,
                    tick: at,
                };
                return written(id, start, &candidate, &leaving, &to)
                    .ok_or(RetargetError::NeedsStop);
            }
            Err(Violation::PivotRate(over)) => candidate.slow(margin(over)),
            Err(Violation::PivotAcceleration(over)) => {
                candidate.slow(margin(sqrt_f32(over)));
            }
            Err(_) => {
                if !candidate.later() {
                    break;
                }
            }
        }
    }
    Err(RetargetError::NeedsStop)
}

/// What a sample of the pivots says is not taken for more than this.
const MOST_SLOWER: f32 = 1.3;

/// By how much slower a line is made that asks for so much more of the pivots than they can.
fn margin(over: f32) -> f32 {
    (over * SLOWER_FOR_PIVOTS).clamp(SLOWER_FOR_PIVOTS, MOST_SLOWER)
}

/// The soonest of the candidates, and the part that is over sooner slowed down to the other.
fn soonest(leaving: &Leaving<'_>, tried: usize, ended: &mut Ended) -> Option<Candidate> {
    let overlap = Overlap::new(leaving);
    let mut best: [Option<PartWay>; 2] = [None; 2];
    for (ending, shares) in ENDINGS.into_iter().take(tried) {
        if leaving.write_ended(ending, ended).is_none() || leaving.is_over(ended) {
            continue;
        }
        for (part, best) in PARTS.into_iter().zip(&mut best) {
            for &share in shares {
                let soonest = best.as_ref().map_or(u64::MAX, |best| best.ticks());
                let ending = (ending, &*ended);
                let other = PartWay::new(leaving, &overlap, ending, share, part, soonest);
                *best = other.or(*best);
            }
        }
    }
    let [Some(translation), Some(rotation)] = best else {
        return None;
    };
    let mut candidate = Candidate {
        parts: [translation, rotation],
    };
    let ticks = candidate.ticks();
    for (way, part) in candidate.parts.iter_mut().zip(PARTS) {
        if way.ticks() < ticks && leaving.write_ended(way.ending, ended).is_some() {
            way.level(&overlap, ended, part, ticks);
        }
    }
    Some(candidate)
}

/// 2^-32 track radii or turns by which pieces may miss a target: what floats leave of a way of four, 0.1 um on the
/// reference stage.
const NEAR: u64 = 1 << 12;

/// The plan of a candidate.
#[inline(never)]
fn written(
    id: u32,
    start: PlanStart,
    candidate: &Candidate,
    leaving: &Leaving<'_>,
    to: &Position,
) -> Option<Plan> {
    let mut plan = Plan {
        id,
        start,
        end: *to,
        ..Plan::default()
    };
    candidate.write(leaving, to, &mut plan.pieces)?;
    let end = state_after_pieces(&leaving.state, &plan.pieces, &[0; 3]);
    // The nudge is not held against any limit: it is for roundings only.
    let is_near = |i: usize| end[i].rounded().wrapping_sub(to[i]).unsigned_abs() < NEAR;
    if !(0..3).all(is_near) {
        return None;
    }
    plan.nudge = nudge_to(&end, to, plan.ticks())?;
    Some(plan)
}
