//! The sum of two motions that overlap: what is linear in its jerks adds up.
//!
//! ```text
//! first    |-----------------|            A stop to A and a line from A to B, begun before the stop is over, end exactly
//! second         |---------------------|  at B, at rest, whatever the delay: positions, velocities and accelerations of
//!          |delay|                        the two add up.
//! ```

use super::piece::{Piece, Pieces};

/// Writes the sum of `first` and of `second`, which begins `delay` ticks later. `None` where it has more pieces than
/// there is room for.
pub fn write_sum(first: &[Piece], second: &[Piece], delay: u64, pieces: &mut Pieces) -> Option<()> {
    pieces.clear();
    let mut cursors = [Cursor::new(first, 0), Cursor::new(second, delay)];
    loop {
        let [a, b] = &cursors;
        let ticks = a.left.min(b.left);
        if ticks == NEVER {
            return Some(());
        }
        let jerk = each!(i => a.jerk[i] + b.jerk[i]);
        push_piece(pieces, Piece { ticks, jerk })?;
        for cursor in &mut cursors {
            cursor.pass(ticks);
        }
    }
}

/// Adds a piece: nothing where it has no ticks, to the last where that has the same jerk.
#[inline(never)]
pub fn push_piece(pieces: &mut Pieces, piece: Piece) -> Option<()> {
    match pieces.last_mut() {
        _ if piece.ticks == 0 => Some(()),
        Some(last) if last.jerk == piece.jerk => {
            last.ticks += piece.ticks;
            Some(())
        }
        _ => pieces.push(piece).ok(),
    }
}

/// Where one of the motions is.
struct Cursor<'a> {
    /// Ticks until its jerk changes.
    left: u64,
    jerk: [i64; 3],
    rest: core::slice::Iter<'a, Piece>,
}

/// Ticks until anything changes when all is over.
const NEVER: u64 = u64::MAX;

impl<'a> Cursor<'a> {
    fn new(pieces: &'a [Piece], delay: u64) -> Self {
        let mut cursor = Self {
            left: delay,
            jerk: [0; 3],
            rest: pieces.iter(),
        };
        cursor.enter();
        cursor
    }

    fn pass(&mut self, ticks: u64) {
        if self.left != NEVER {
            self.left -= ticks;
            self.enter();
        }
    }

    /// Enters the next piece, if this one is over.
    fn enter(&mut self) {
        while self.left == 0 {
            let next = self.rest.next();
            (self.left, self.jerk) =
                next.map_or((NEVER, [0; 3]), |piece| (piece.ticks, piece.jerk));
        }
    }
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
