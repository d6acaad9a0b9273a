//! A plan: the pieces of constant jerk that carry the three axes from a known state to rest; the sum of two motions that
//! overlap; and how the tick follows a plan.
//!
//! ```text
//! first    |-----------------|            A stop to A and a line from A to B, begun before the stop is over, end exactly
//! second         |---------------------|  at B, at rest, whatever the delay: positions, velocities and accelerations of
//!          |delay|                        the two add up, because pieces are linear in their jerks.
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `axis_state` | one axis in integers: an exact cubic, tick by tick or many ticks at once |
//! | `quantise` | profiles in whole ticks and integers |
//! | `cubic_segment` | a piece in floats: the state at an instant of it |
//! | `setpoint` | what the control loop is given at a tick: of the point that is moved, and of the platform's centre |
//! | `fault_stop` | a fault's stop: the plan's time runs slower and slower |
//! | `follower` | following a plan, and taking the next |
//! | `lone_follower` | the same with a memory of its own |
//! | `slots` | where plans lie while they are handed over and followed |

pub mod axis_state;
pub mod cubic_segment;
pub mod fault_stop;
pub mod follower;
pub mod lone_follower;
pub mod quantise;
pub mod setpoint;
pub mod slots;

use axis_state::{AxisState, SUB_BITS};
use heapless::Vec;
use number::wide_integer::divide;

/// x and y in 2^-32 track radii, theta in 2^-32 turns (multi-turn).
pub type Position = [i64; 3];

/// Pieces a plan can hold: those of the longest line and of a stop that it overlaps.
pub const MAX_PIECES: usize = 32;

/// So many ticks of constant jerk, of all axes together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Piece {
    /// Length in ticks.
    pub ticks: u64,
    /// Jerk of each axis: 2^-72 track radii or turns per tick cubed, a multiple of
    /// [`JERK_STEP`](axis_state::JERK_STEP).
    pub jerk: [i64; 3],
}

impl Piece {
    /// So many ticks without a jerk.
    pub const fn coast(ticks: u64) -> Self {
        let jerk = [0; 3];
        Self { ticks, jerk }
    }

    /// Takes the axes on by `ticks` of this piece, with a plan's nudge.
    pub fn advance(&self, axes: &mut [AxisState; 3], ticks: u64, nudge: &[i64; 3]) {
        for (axis, (jerk, nudge)) in axes.iter_mut().zip(self.jerk.iter().zip(nudge)) {
            axis.pass(ticks, *jerk, *nudge);
        }
    }
}

/// Pieces of a plan.
pub type Pieces = Vec<Piece, MAX_PIECES>;

/// The axes after all of these pieces.
pub fn state_after_pieces(
    state: &[AxisState; 3],
    pieces: &[Piece],
    nudge: &[i64; 3],
) -> [AxisState; 3] {
    let mut axes = *state;
    for piece in pieces {
        piece.advance(&mut axes, piece.ticks, nudge);
    }
    axes
}

/// What of the pieces lies after a tick.
pub fn pieces_after(pieces: &[Piece], tick: u64) -> impl Iterator<Item = Piece> {
    let mut ends = 0;
    pieces.iter().filter_map(move |piece| {
        ends += piece.ticks;
        let ticks = piece.ticks.min(u64::saturating_sub(ends, tick));
        (ticks > 0).then_some(Piece { ticks, ..*piece })
    })
}

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
        Self::new(0, PlanStart::Rest([0; 3]), [0; 3])
    }
}

impl Plan {
    /// Without pieces yet.
    // A call writes it where it stays: inlined, its thousand bytes were copied there.
    #[inline(never)]
    pub fn new(id: u32, start: PlanStart, end: Position) -> Self {
        Self {
            id,
            start,
            pieces: Vec::new(),
            nudge: [0; 3],
            end,
        }
    }

    /// The start of a plan that leaves this one at a tick.
    pub fn left_at(&self, tick: u64) -> PlanStart {
        let plan = self.id;
        PlanStart::Splice { plan, tick }
    }

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
        *nudge = divide(i64::try_from(rest).ok()?, ticks as i64);
    }
    Some(nudge)
}

/// Writes the sum of `first` and of `second`, which begins `delay` ticks later. `None` where it has more pieces than
/// there is room for.
pub fn write_sum(first: &[Piece], second: &[Piece], delay: u64, pieces: &mut Pieces) -> Option<()> {
    pieces.clear();
    let (mut first, mut second) = (first.iter(), second.iter());
    let (mut a, mut b) = (first.next().copied(), Some(Piece::coast(delay)));
    loop {
        let (ticks, jerk) = match (a, b) {
            (Some(a), Some(b)) => (a.ticks.min(b.ticks), each!(i => a.jerk[i] + b.jerk[i])),
            (Some(piece), None) | (None, Some(piece)) => (piece.ticks, piece.jerk),
            (None, None) => return Some(()),
        };
        push_piece(pieces, Piece { ticks, jerk })?;
        a = left_of(a, ticks).or_else(|| first.next().copied());
        b = left_of(b, ticks).or_else(|| second.next().copied());
    }
}

/// What of a piece is left after so many ticks.
fn left_of(piece: Option<Piece>, ticks: u64) -> Option<Piece> {
    let piece = piece.filter(|piece| piece.ticks > ticks)?;
    let ticks = piece.ticks - ticks;
    Some(Piece { ticks, ..piece })
}

/// Adds a piece: nothing where it has no ticks, to the last where that has the same jerk.
#[inline(never)]
pub fn push_piece(pieces: &mut Pieces, piece: Piece) -> Option<()> {
    match pieces.last_mut() {
        _ if piece.ticks == 0 => Some(()),
        Some(last) if same(&last.jerk, &piece.jerk) => {
            last.ticks += piece.ticks;
            Some(())
        }
        _ => pieces.push(piece).ok(),
    }
}

/// Equality, word by word: that of arrays is a call that compares bytes.
#[inline]
pub(super) fn same(a: &[i64; 3], b: &[i64; 3]) -> bool {
    a[0] == b[0] && a[1] == b[1] && a[2] == b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(ticks: u64, jerk: i64) -> Piece {
        Piece {
            ticks,
            jerk: [jerk, -jerk, 0],
        }
    }

    #[test]
    fn tick_by_tick_it_is_the_sum() {
        let first = [piece(3, 6), piece(0, 60), piece(4, 0), piece(2, -12)];
        let second = [piece(2, 18), piece(5, 6)];
        let at = |pieces: &[Piece], tick: u64| {
            let mut end = 0;
            pieces
                .iter()
                .find(|piece| {
                    end += piece.ticks;
                    tick < end
                })
                .map_or([0; 3], |piece| piece.jerk)
        };
        for delay in 0..14 {
            let mut sum = Pieces::new();
            write_sum(&first, &second, delay, &mut sum).unwrap();
            let ticks: u64 = sum.iter().map(|piece| piece.ticks).sum();
            assert_eq!(ticks, 9.max(delay + 7));
            for tick in 0_u64..30 {
                let later = tick.checked_sub(delay).map_or([0; 3], |t| at(&second, t));
                let expected = [0, 1, 2].map(|i| at(&first, tick)[i] + later[i]);
                assert_eq!(at(&sum, tick), expected, "{delay} {tick}");
            }
        }
    }
}
