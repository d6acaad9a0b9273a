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
//! A first way has to be there soon: of two endings, and the check is asked once. The soonest way is looked for while that is
//! under way: all endings and shares, and finer delays; a line that asks too much of the pivots is slowed down, one that
//! meets an edge delayed. Where there is no first way, the stop that was sent before goes on, and the soonest way leaves that.
//!
//! | file | idea |
//! |---|---|
//! | here | ways: an ending, a line from there, and the delay between them; the soonest that the check is content with |
//! | `ending` | how the motion under way comes to rest |
//! | `overlap` | whether two motions that overlap keep to the limits of path and rotation, in floats; the least delay |

mod ending;
mod overlap;

use ending::{Ended, Ending, Leaving};
use motion::check::workspace::check_target;
use motion::check::{PlanCheck, Violation};
use motion::constraints::Constraints;
use motion::plan::axis_state::AxisState;
use motion::plan::{Pieces, Plan, PlanStart, Position, nudge_to, state_after_pieces, write_sum};
use motion::profile::rest_to_rest::RestToRestProfile;
use motion::refusal::{Refusal, RetargetError};
use motion::tolerances::{SLOWER_FOR_PIVOTS, TARGET_UNITS};
use number::float::{FloatMinMax, hypot, ticks_to_f32};
use number::sqrt_f32;
use overlap::{Corner, Corners, Overlap};

/// How the motion under way ends, and the shares of the limits that the line gets.
const ENDINGS: [(Ending, &[f32]); 6] = [
    (Ending::Followed, &[1.0, 0.7, 0.5]),
    (stop(1.0, 1.0), &[1.0, 0.7, 0.4]),
    (stop(0.7, 0.7), &[0.7, 1.0, 0.4]),
    (stop(1.0, 0.7), &[0.7, 1.0, 0.4]),
    (stop(1.0, 0.5), &[0.5, 0.85, 1.0]),
    (stop(0.5, 0.5), &[0.5, 0.85, 1.0]),
];

const fn stop(acceleration: f32, jerk: f32) -> Ending {
    Ending::Stop { acceleration, jerk }
}

/// How many of the ways are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// How many of the endings, and of the shares of each.
    endings: usize,
    shares: usize,
    /// How often a delay is halved.
    halvings: usize,
    /// How often the check may be asked, and how many intervals it may take before the next failure counts.
    checks: usize,
    intervals: usize,
}

impl Effort {
    /// So few that the stage is soon on its way.
    pub const FIRST: Self = Self {
        endings: 2,
        shares: 1,
        halvings: 2,
        checks: 1,
        intervals: 5,
    };
    /// All.
    pub const ALL: Self = Self {
        endings: ENDINGS.len(),
        shares: 3,
        halvings: 5,
        checks: 4,
        intervals: 60,
    };
}

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
    let mut way = soonest(&leaving, &effort, &mut ended).ok_or(RetargetError::NeedsStop)?;
    (leaving.write(way.ending, &mut ended)).ok_or(RetargetError::NeedsStop)?;
    let mut plan = Plan::new(id, of.left_at(at), to);
    let plan_check = PlanCheck::new(constraints, &leaving.state);
    let mut budget = effort.intervals;
    for left in (0..effort.checks).rev() {
        (way.write(&ended, &to, &mut plan.pieces)).ok_or(RetargetError::NeedsStop)?;
        match plan_check.check(&plan.pieces, &leaving.state, &mut budget) {
            Ok(()) => {
                close(&mut plan, &leaving).ok_or(RetargetError::NeedsStop)?;
                return Ok(plan);
            }
            Err(_) if left == 0 || budget == 0 => break,
            Err(Violation::Pivots) => {
                let [rate, acceleration] = plan_check.pivot_parts(&plan.pieces, &leaving.state);
                let over = rate.fmax(sqrt_f32(acceleration)) * SLOWER_FOR_PIVOTS;
                let slower = over.clamp(SLOWER_FOR_PIVOTS, MOST_SLOWER);
                // One that would take longer than can be counted stays as it is.
                way.line = (way.line.and_then(|line| line.slowed(slower))).or(way.line);
            }
            Err(_) if way.delay < ended.ticks => way.delay_more(ended.ticks),
            Err(_) => break,
        }
    }
    Err(RetargetError::NeedsStop)
}

/// An ending of the motion under way, a line from there, and the delay between them.
struct Way {
    ending: Ending,
    /// None where there is no way left to go.
    line: Option<RestToRestProfile>,
    delay: u64,
    ticks: u64,
}

/// The part of what is left of the longest delay that is added when a delay was too short.
const DELAY_STEPS: u64 = 3;

impl Way {
    /// Takes a longer delay, up to `most`.
    fn delay_more(&mut self, most: u64) {
        let left = most - self.delay;
        self.delay += if left > most / 16 {
            left.div_ceil(DELAY_STEPS)
        } else {
            left
        };
    }

    /// Writes its pieces; `None` where there are too many.
    #[inline(never)]
    fn write(&self, ended: &Ended, to: &Position, pieces: &mut Pieces) -> Option<()> {
        let mut line_plan = Plan::new(0, PlanStart::Rest(ended.rest), *to);
        if let Some(line) = &self.line {
            line.write_plan(&mut line_plan, &ended.rest)?;
        }
        write_sum(&ended.pieces, &line_plan.pieces, self.delay, pieces)
    }
}

/// What a sample of the pivots says is not taken for more than this.
const MOST_SLOWER: f32 = 1.3;

/// The soonest of the ways.
fn soonest(leaving: &Leaving<'_>, effort: &Effort, ended: &mut Ended) -> Option<Way> {
    let overlap = Overlap::new(&leaving.limits, leaving.hz, effort.halvings);
    let mut best: Option<Way> = None;
    for (ending, shares) in ENDINGS.into_iter().take(effort.endings) {
        if leaving.write(ending, ended).is_none() || leaving.is_over(ended) {
            continue;
        }
        for &share in shares.iter().take(effort.shares) {
            let soonest = best.as_ref().map_or(u64::MAX, |best| best.ticks);
            best = way(leaving, &overlap, ended, ending, share, soonest).or(best);
        }
    }
    best
}

/// The way with the least delay at which the path's and the rotation's own limits are kept; `None` where it would not be
/// over before `soonest`.
fn way(
    leaving: &Leaving<'_>,
    overlap: &Overlap,
    ended: &Ended,
    ending: Ending,
    share: f32,
    soonest: u64,
) -> Option<Way> {
    let line = line(&ended.left, share, leaving);
    let (mut delay, mut ticks) = (0, ended.ticks);
    if let Some(line) = &line {
        let latest = soonest.checked_sub(line.ticks() + 1)?;
        let corners = line_corners(line, &ended.left, leaving.hz);
        delay = overlap.least_delay(&ended.corners, &corners, ticks.min(latest))?;
        ticks = ticks.max(delay + line.ticks());
    }
    (ticks < soonest).then_some(Way {
        ending,
        line,
        delay,
        ticks,
    })
}

/// The plain line along `way` with a share of the limits of acceleration and jerk; `None` where there is no way to go, or
/// one that takes longer than can be counted.
fn line(way: &[f32; 3], share: f32, leaving: &Leaving<'_>) -> Option<RestToRestProfile> {
    if *way == [0.0; 3] {
        return None;
    }
    let limits = leaving.limits.scaled(share, share);
    let limits = limits.for_line(hypot(way[0], way[1]), way[2].abs());
    RestToRestProfile::new(&limits, leaving.hz)
}

/// The states of a line at which its jerk changes.
#[inline(never)]
fn line_corners(line: &RestToRestProfile, way: &[f32; 3], hz: f32) -> Corners {
    let cube = ticks_to_f32(line.jerk) * ticks_to_f32(line.ramp) * ticks_to_f32(line.travel);
    let push = hz * hz * hz / cube;
    let (mut corners, mut now, mut ticks) = (Corners::new(), Corner::default(), 0);
    for (lasts, jerk) in line.segments() {
        now.j = each!(i => way[i] * (push * jerk as f32));
        // Eight of many.
        let _ = corners.push(now);
        ticks += lasts;
        now = now.at(ticks_to_f32(ticks) / hz);
    }
    let _ = corners.push(now);
    corners
}

/// Gives a plan the nudge that leads it to its end exactly; `None` where its pieces lead elsewhere.
fn close(plan: &mut Plan, leaving: &Leaving<'_>) -> Option<()> {
    let end = state_after_pieces(&leaving.state, &plan.pieces, &[0; 3]);
    // The nudge is not held against any limit: it is for roundings only.
    let is_near = |i: usize| end[i].rounded().abs_diff(plan.end[i]) < TARGET_UNITS;
    if !(0..3).all(is_near) {
        return None;
    }
    plan.nudge = nudge_to(&end, &plan.end, plan.ticks())?;
    Some(())
}
