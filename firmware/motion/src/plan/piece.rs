//! Positions of the moved point, and pieces of constant jerk of all axes.

use super::axis_state::AxisState;
use heapless::Vec;

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
    /// [`JERK_STEP`](super::axis_state::JERK_STEP).
    pub jerk: [i64; 3],
}

impl Piece {
    /// Takes the axes on by `ticks` of this piece, with a plan's nudge.
    // Inlined wherever plans are walked through, products of 128 bits were a tenth of the generator's code.
    #[inline(never)]
    pub fn advance(&self, axes: &mut [AxisState; 3], ticks: u64, nudge: &[i64; 3]) {
        for (axis, (jerk, nudge)) in axes.iter_mut().zip(self.jerk.iter().zip(nudge)) {
            *axis = axis.after(ticks, *jerk, *nudge);
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
