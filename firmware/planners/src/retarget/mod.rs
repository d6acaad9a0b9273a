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
//! A first way has to be there soon: of two endings, with one line for all axes, and the check is asked once. The soonest way
//! is looked for while that is under way: all endings, and a line and a delay each for translation and rotation; a line
//! that asks too much of the pivots is slowed down, one that meets an edge delayed. Where there is no first way, the stop
//! that was sent before goes on, and the soonest way leaves that.
//!
//! | file | idea |
//! |---|---|
//! | here | candidates, and the soonest that the check is content with |
//! | `ending` | how the motion under way comes to rest |
//! | `overlap` | the plain line from there; translation, rotation, or both as one: whether two motions that overlap keep to their limits, in floats |
//! | `candidate` | for each part an ending, a line, and the least delay between them |

mod candidate;
mod ending;
mod overlap;

use candidate::{Candidate, PartWay};
use ending::{Ended, Ending, Leaving};
use motion::check::workspace::check_target;
use motion::check::{Budget, PlanCheck, Violation};
use motion::constraints::Constraints;
use motion::plan::axis_state::AxisState;
use motion::plan::{Plan, Position, nudge_to, state_after_pieces};
use motion::refusal::{Refusal, RetargetError};
use motion::tolerances::SLOWER_FOR_PIVOTS;
use number::sqrt_f32;
use overlap::{Overlap, Part};

/// How the motion under way ends, and the shares of the limits that the line gets.
const ENDINGS: [(Ending, &[f32]); 5] = [
    (Ending::Followed, &[1.0, 0.5]),
    (stop(1.0, 1.0), &[1.0, 0.7]),
    (stop(0.7, 0.7), &[0.7, 1.0]),
    (stop(1.0, 0.7), &[0.7]),
    (stop(1.0, 0.5), &[0.5, 0.85]),
];

const fn stop(acceleration: f32, jerk: f32) -> Ending {
    Ending::Stop { acceleration, jerk }
}

/// How many of the ways are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// So few that the stage is soon on its way.
    First,
    /// All.
    All,
}

/// What an effort comes to.
struct Search {
    /// What has a line and a delay of its own.
    parts: &'static [Part],
    /// How many of the endings, and of the shares of each.
    endings: usize,
    shares: usize,
    /// How often the check may be asked, and how many intervals it may take before the next failure counts.
    checks: usize,
    intervals: usize,
}

const FIRST: Search = Search {
    parts: &[Part::Whole],
    endings: 2,
    shares: 1,
    checks: 1,
    intervals: 5,
};

const ALL: Search = Search {
    parts: &[Part::Translation, Part::Rotation],
    endings: ENDINGS.len(),
    shares: 2,
    checks: 4,
    intervals: 60,
};

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
    let search = match effort {
        Effort::First => &FIRST,
        Effort::All => &ALL,
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
    let mut candidate = soonest(&leaving, search, &mut ended).ok_or(RetargetError::NeedsStop)?;
    let mut plan = Plan::new(id, of.left_at(at), to);
    let plan_check = PlanCheck::new(constraints, &leaving.state);
    let mut budget = Budget {
        intervals: search.intervals,
        samples_pivots: search.checks > 1,
    };
    for _ in 0..search.checks {
        if budget.intervals == 0 {
            break;
        }
        (candidate.write(&leaving, &to, &mut ended, &mut plan.pieces))
            .ok_or(RetargetError::NeedsStop)?;
        match plan_check.check(&plan.pieces, &leaving.state, &mut budget) {
            Ok(()) => {
                close(&mut plan, &leaving).ok_or(RetargetError::NeedsStop)?;
                return Ok(plan);
            }
            Err(Violation::PivotRate(over)) => candidate.slow(margin(over)),
            Err(Violation::PivotAcceleration(over)) => {
                candidate.slow(margin(sqrt_f32(over)));
            }
            Err(_) => {
                if !candidate.delay_more() {
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
fn soonest(leaving: &Leaving<'_>, search: &Search, ended: &mut Ended) -> Option<Candidate> {
    let overlap = Overlap::new(leaving);
    let mut best: [Option<PartWay>; 2] = [None; 2];
    for (ending, shares) in ENDINGS.into_iter().take(search.endings) {
        if leaving.write(ending, ended).is_none() || leaving.is_over(ended) {
            continue;
        }
        for (&part, best) in search.parts.iter().zip(&mut best) {
            for &share in shares.iter().take(search.shares) {
                let soonest = best.as_ref().map_or(u64::MAX, |best| best.ticks());
                let ending = (ending, &*ended);
                let other = PartWay::new(leaving, &overlap, ending, share, part, soonest);
                *best = other.or(*best);
            }
        }
    }
    let ways = best.into_iter().flatten().collect();
    let mut candidate = Candidate { ways };
    if candidate.ways.len() < search.parts.len() {
        return None;
    }
    let ticks = candidate.ticks();
    for way in &mut candidate.ways {
        if way.ticks() < ticks && leaving.write(way.ending, ended).is_some() {
            way.stretch(&overlap, ended, ticks);
        }
    }
    Some(candidate)
}

/// 2^-32 track radii or turns by which pieces may miss a target: what floats leave of a way of four, 0.1 um on the
/// reference stage.
const NEAR: u64 = 1 << 12;

/// Gives a plan the nudge that leads it to its end exactly; `None` where its pieces lead elsewhere.
fn close(plan: &mut Plan, leaving: &Leaving<'_>) -> Option<()> {
    let end = state_after_pieces(&leaving.state, &plan.pieces, &[0; 3]);
    // The nudge is not held against any limit: it is for roundings only.
    let is_near = |i: usize| end[i].rounded().abs_diff(plan.end[i]) < NEAR;
    if !(0..3).all(is_near) {
        return None;
    }
    plan.nudge = nudge_to(&end, &plan.end, plan.ticks())?;
    Some(())
}
