//! The end of a jog, of the point or of theta: a velocity held, and given up in three pieces.

use crate::motion::plan::Piece;

/// What is left of it from some tick on.
pub(super) struct HoldThenStop {
    /// Ticks of the part under way.
    left: u64,
    /// The part under way: 0 while the velocity is held, then each of the brake's; more at rest.
    part: usize,
}

const AT_REST: usize = 4;

impl HoldThenStop {
    /// Of a velocity that is held for so many ticks, or of none.
    pub fn new(moves: bool, hold: u64) -> Self {
        Self {
            left: hold,
            part: if moves { 0 } else { AT_REST },
        }
    }

    /// Ticks to the next change of this or of another; `None` when both are at rest.
    pub fn next_change(&self, other: &Self) -> Option<u64> {
        let left = |end: &Self| (end.part < AT_REST).then_some(end.left);
        match (left(self), left(other)) {
            (Some(one), Some(two)) => Some(one.min(two)),
            (one, two) => one.or(two),
        }
    }

    /// What is asked of the axes now.
    pub fn jerk(&self, brakes: &[Piece; 3]) -> [i64; 3] {
        self.brake(brakes).map_or([0; 3], |piece| piece.jerk)
    }

    /// Lets time pass, to the next change at most.
    pub fn advance(&mut self, ticks: u64, brakes: &[Piece; 3]) {
        if self.part < AT_REST {
            self.left -= ticks;
            if self.left == 0 {
                self.part += 1;
                self.left = self.brake(brakes).map_or(0, |piece| piece.ticks);
            }
        }
    }

    fn brake<'a>(&self, brakes: &'a [Piece; 3]) -> Option<&'a Piece> {
        brakes.get(self.part.wrapping_sub(1))
    }
}
