//! A plan: what it starts from, its pieces, and where it ends.

use super::axis_state::{AxisState, SUB_BITS};
use super::piece::{MAX_PIECES, Piece, Position};
use heapless::Vec;

/// The state a plan starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanStart {
    /// At rest at this position.
    Rest(Position),
    /// In motion: where plan `plan` is `tick` ticks after its first.
    Splice {
        /// Identity of the plan that is left.
        plan: u32,
        /// Tick of that plan at which it is left.
        tick: u64,
    },
}

/// A motion ready to be executed tick by tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Identity, given by who plans; the tick reports progress under it.
    pub id: u32,
    /// What the plan starts from.
    pub start: PlanStart,
    /// The pieces, in order.
    pub pieces: Vec<Piece, MAX_PIECES>,
    /// Added to each position at every tick. It spreads what the rounding of the jerks leaves over the whole plan: far
    /// below anything that can be seen (2^-34 turns a tick in the most extreme case), and what remains of it at the end
    /// is less than 2^-32 of a [`Position`]'s unit a tick.
    pub nudge: [i64; 3],
    /// Where it ends, at rest, exactly.
    pub end: Position,
}

impl Default for Plan {
    /// Nothing to do, at the origin.
    fn default() -> Self {
        Self {
            id: 0,
            start: PlanStart::Rest([0; 3]),
            pieces: Vec::new(),
            nudge: [0; 3],
            end: [0; 3],
        }
    }
}

impl Plan {
    /// Duration in ticks.
    pub fn ticks(&self) -> u64 {
        self.pieces.iter().map(|piece| piece.ticks).sum()
    }

    /// The three axes `ticks` after the start from `axes`, as the tick will hold them; at rest at the end from the last
    /// tick on.
    pub fn state_after(&self, axes: &[AxisState; 3], mut ticks: u64) -> [AxisState; 3] {
        let mut state = *axes;
        for piece in &self.pieces {
            let now = ticks.min(piece.ticks);
            piece.advance(&mut state, now, &self.nudge);
            ticks -= now;
            if now < piece.ticks {
                return state;
            }
        }
        self.end.map(AxisState::at_rest)
    }
}

/// The nudge with which pieces that lead to `end` in `ticks` lead to `to`; `None` where they lead elsewhere.
pub fn nudge_to(end: &[AxisState; 3], to: &Position, ticks: u64) -> Option<[i64; 3]> {
    let mut nudge = [0; 3];
    for (nudge, (axis, to)) in nudge.iter_mut().zip(end.iter().zip(to)) {
        let rest = (i128::from(*to) << SUB_BITS) - axis.position;
        // In 64 bits a division is a tenth of one in 128.
        *nudge = i64::try_from(rest).ok()? / ticks.max(1) as i64;
    }
    Some(nudge)
}
