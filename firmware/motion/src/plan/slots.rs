//! Where plans lie while they are handed over and followed: the tick copies none.
//!
//! Three slots. Two are the tick's: that of the plan under way, and that of the next one or of the one before. The third is the
//! planning side's: it is filled, handed over by a [`PlanHandle`] through a queue, and a slot comes back: the one that the plan
//! displaces, or its own when it is refused. So at most one plan is on its way, and neither side waits for the other.

use super::{MAX_PIECES, Piece, Plan, PlanStart, Position};
use core::sync::atomic::{AtomicU32, Ordering};

const SLOTS: usize = 3;
/// The slot that is free at first; and those of a follower that has not followed anything yet.
const FIRST_FREE: u32 = 0;
pub(super) const FIRST_KEPT: [u8; 2] = [1, 2];
/// No slot is free: a plan is on its way.
const NONE: u32 = u32::MAX;
/// Words of a piece: its ticks and three jerks, the lower half of each first.
const PIECE_WORDS: usize = 8;

type PieceWords = [AtomicU32; PIECE_WORDS];

/// The memory. All zero at first: as a static it costs no flash.
pub struct PlanSlots {
    pieces: [[PieceWords; MAX_PIECES]; SLOTS],
    free: AtomicU32,
}

/// The planning side's end.
pub struct PlanSender<'a>(&'a PlanSlots);

/// The tick's end.
#[derive(Clone, Copy)]
pub struct PlanReceiver<'a>(&'a PlanSlots);

/// A plan that lies in a slot: all of it but its pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanHandle {
    /// As of the [`Plan`].
    pub id: u32,
    /// As of the [`Plan`].
    pub start: PlanStart,
    /// As of the [`Plan`].
    pub nudge: [i64; 3],
    /// As of the [`Plan`].
    pub end: Position,
    /// How many pieces it has.
    pub pieces: u8,
    /// Where they lie.
    pub slot: u8,
}

impl PlanSlots {
    /// Empty.
    #[allow(clippy::new_without_default)] // A default of 3 KB is nothing to be made in passing.
    pub const fn new() -> Self {
        Self {
            pieces: [const { [const { [const { AtomicU32::new(0) }; PIECE_WORDS] }; MAX_PIECES] };
                SLOTS],
            free: AtomicU32::new(FIRST_FREE),
        }
    }

    /// The two ends.
    pub fn split(&mut self) -> (PlanSender<'_>, PlanReceiver<'_>) {
        (PlanSender(self), PlanReceiver(self))
    }
}

impl PlanSender<'_> {
    /// Writes a plan to the free slot; `None` while the one before is on its way.
    pub fn hand_over(&mut self, plan: &Plan) -> Option<PlanHandle> {
        let slot = self.0.free.load(Ordering::Acquire);
        let places = self.0.pieces.get(slot as usize)?;
        self.0.free.store(NONE, Ordering::Relaxed);
        for (words, piece) in places.iter().zip(&plan.pieces) {
            write(words, piece);
        }
        Some(PlanHandle {
            id: plan.id,
            start: plan.start,
            nudge: plan.nudge,
            end: plan.end,
            pieces: plan.pieces.len() as u8,
            slot: slot as u8,
        })
    }
}

impl PlanReceiver<'_> {
    /// A piece of a plan in this slot.
    #[inline]
    pub fn piece(&self, slot: u8, index: usize) -> Option<Piece> {
        let words = self.0.pieces.get(usize::from(slot))?.get(index)?;
        let half = |at: usize| u64::from(words[at & (PIECE_WORDS - 1)].load(Ordering::Relaxed));
        let word = |at: usize| half(2 * at) | half(2 * at + 1) << 32;
        Some(Piece {
            ticks: word(0),
            jerk: each!(i => word(i + 1).cast_signed()),
        })
    }

    /// The plan as it was written: for who has to have all of it.
    pub fn plan(&self, handle: &PlanHandle) -> Plan {
        let mut plan = Plan::new(handle.id, handle.start, handle.end);
        plan.nudge = handle.nudge;
        let pieces = 0..usize::from(handle.pieces);
        plan.pieces
            .extend(pieces.filter_map(|index| self.piece(handle.slot, index)));
        plan
    }

    /// Gives a slot back.
    #[inline]
    pub fn give_back(&self, slot: u8) {
        self.0.free.store(u32::from(slot), Ordering::Release);
    }

    /// The follower starts again, and no plan is on its way.
    pub fn restart(&self) {
        self.0.free.store(FIRST_FREE, Ordering::Release);
    }
}

fn write(words: &PieceWords, piece: &Piece) {
    let [x, y, theta] = piece.jerk.map(i64::cast_unsigned);
    let halves = [piece.ticks, x, y, theta]
        .into_iter()
        .flat_map(|word| [word as u32, (word >> 32) as u32]);
    for (word, half) in words.iter().zip(halves) {
        word.store(half, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(id: u32, pieces: usize) -> Plan {
        let mut plan = Plan::new(id, PlanStart::Rest([1, -2, 3]), [4, -5, 6]);
        for at in 0..pieces {
            let jerk = [i64::MIN + at as i64, -1, i64::from(id) << 33];
            let ticks = (1 << 40) + at as u64;
            plan.pieces.push(Piece { ticks, jerk }).unwrap();
        }
        plan
    }

    #[test]
    fn a_plan_arrives_as_it_was_and_one_is_on_its_way_at_a_time() {
        let mut slots = PlanSlots::new();
        let (mut sender, receiver) = slots.split();
        let mut kept = FIRST_KEPT;
        for (id, pieces) in [(1, 0), (2, 1), (3, MAX_PIECES), (4, 7)] {
            let sent = plan(id, pieces);
            let handle = sender.hand_over(&sent).expect("a free slot");
            assert!(!kept.contains(&handle.slot), "{handle:?} {kept:?}");
            assert_eq!(sender.hand_over(&sent), None);
            assert_eq!(receiver.plan(&handle), sent);
            // It takes the place of one that is kept.
            receiver.give_back(std::mem::replace(&mut kept[id as usize % 2], handle.slot));
        }
        sender.hand_over(&plan(5, 1)).expect("a free slot");
        receiver.restart();
        let handle = sender.hand_over(&plan(6, 1)).expect("a free slot");
        assert!(!FIRST_KEPT.contains(&handle.slot));
    }
}
