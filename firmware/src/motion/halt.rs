//! The stop that a motion carries with it: from any state, whatever the velocity and the acceleration point to.
//!
//! The acceleration is released, then the velocity given up, along its own direction: the pieces of a change of velocity (see
//! `change`). Every instant that may be the worst is held against the limits; where a pivot is asked for too much, the stop
//! is softer.

use super::axis::Axis;
use super::change::{Force, Pieces, Ramp, release};
use super::float::Order;
use super::instant::{Instant, Limiter};
use super::plan::Piece;
use super::refusal::Refusal;
use super::swing::{Pace, per_second};

/// How often a softer stop is tried.
const ATTEMPTS: usize = 3;
/// A piece longer than so many ticks is looked at in the middle too: there the way may bulge, and velocity has changed.
const LONG: u64 = 256;

/// The pieces, and the state after them: at rest, but for what rounding leaves.
pub(super) fn halt(
    state: &[Axis; 3],
    now: &Instant,
    limiter: &Limiter<'_>,
) -> Result<(Pieces, [Axis; 3]), Refusal> {
    let mut part = 1.0;
    for _ in 0..ATTEMPTS {
        let force = Force {
            acceleration: Pace {
                way: limiter.force.way * part,
                turn: limiter.force.turn * part,
            },
            jerk: limiter.jerk,
        };
        let pieces = pieces(state, now, &force, limiter);
        let (worst, end) = walk(state, now, &pieces, limiter).ok_or(Refusal::NoStop)?;
        if worst <= 1.0 {
            return Ok((pieces, end));
        }
        part *= (0.9 / worst).smaller(0.7);
    }
    Err(Refusal::NoStop)
}

fn pieces(state: &[Axis; 3], now: &Instant, force: &Force, limiter: &Limiter<'_>) -> Pieces {
    let mut pieces = release(state, now.acceleration, force.jerk, limiter.hz);
    let mut released = *state;
    for piece in &pieces {
        advance(&mut released, piece, piece.ticks);
    }
    let change = released.each_ref().map(|axis| -axis.velocity);
    if change != [0; 3] {
        let ramp = Ramp::new(
            Pace::of(&per_second(&change, limiter.hz)),
            force,
            limiter.hz,
        );
        for piece in ramp.pieces(change) {
            // Two and three of five.
            let _ = pieces.push(piece);
        }
    }
    pieces
}

/// The largest part of its limit that a pivot reaches, and the end; `None` where the workspace is left.
fn walk(
    state: &[Axis; 3],
    now: &Instant,
    pieces: &[Piece],
    limiter: &Limiter<'_>,
) -> Option<(f32, [Axis; 3])> {
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
            advance(&mut axes, piece, ticks);
            // What a tick changes does not show.
            if ticks == 1 {
                continue;
            }
            let now = limiter.look(&axes).ok()?;
            if !limiter.is_inside(&before, &now, ticks as f32 / limiter.hz) {
                return None;
            }
            worst = worst.larger(now.pivots[0]).larger(now.pivots[1]);
            before = now;
        }
    }
    Some((worst, axes))
}

/// The axes after some ticks of a piece.
pub(super) fn advance(axes: &mut [Axis; 3], piece: &Piece, ticks: u64) {
    for (axis, jerk) in axes.iter_mut().zip(piece.jerk) {
        *axis = axis.after(ticks, jerk, 0);
    }
}
