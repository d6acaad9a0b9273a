//! One way to the new target: for translation and for rotation, or for both as one, an ending of the motion under way, a
//! line from there, and the delay between them.

use super::ending::{Ended, Ending, Leaving};
use super::overlap::{Line, Overlap, Part};
use heapless::Vec;
use motion::plan::{Piece, Pieces, Plan, Position, write_sum};
use number::float::{FloatMinMax, ticks_to_f32};

/// The way of a part.
#[derive(Clone, Copy)]
pub(super) struct PartWay {
    part: Part,
    pub ending: Ending,
    ending_ticks: u64,
    /// None where there is no way left to go.
    line: Option<Line>,
    delay: u64,
}

/// The part of what is left of the longest delay that is added when a delay was too short.
const DELAY_STEPS: u64 = 3;

impl PartWay {
    /// With the least delay at which the path's and the rotation's own limits are kept; `None` where it would not be
    /// over before `soonest`.
    pub fn new(
        leaving: &Leaving<'_>,
        overlap: &Overlap,
        (ending, ended): (Ending, &Ended),
        share: f32,
        part: Part,
        soonest: u64,
    ) -> Option<Self> {
        let mut way = Self {
            part,
            ending,
            ending_ticks: ended.ticks,
            line: Line::new(part.select(ended.left, [0.0; 3]), share, leaving),
            delay: 0,
        };
        if way.ticks() >= soonest {
            return None;
        }
        if let Some(line) = &way.line {
            let latest = soonest - line.profile.ticks() - 1;
            let most = way.ending_ticks.min(latest);
            way.delay = overlap.least_delay(&ended.corners, line, part, most)?;
        }
        Some(way)
    }

    /// Ticks until it is over.
    pub fn ticks(&self) -> u64 {
        let line = self.line.as_ref().map_or(0, |line| line.profile.ticks());
        self.ending_ticks.max(self.delay + line)
    }

    /// Slower, so that it takes up to `ticks`: less is asked of the pivots.
    pub fn stretch(&mut self, overlap: &Overlap, ended: &Ended, ticks: u64) {
        if let Some(line) = &mut self.line {
            let longer = ticks_to_f32(ticks - self.delay) / ticks_to_f32(line.profile.ticks());
            if let Some(slowed) = line.slowed(longer.fmax(1.0))
                && overlap.is_kept(&ended.corners, &slowed, self.part, self.delay)
            {
                *line = slowed;
            }
        }
    }

    /// Takes a longer delay.
    fn delay_more(&mut self) {
        let left = self.ending_ticks.saturating_sub(self.delay);
        self.delay += if left > self.ending_ticks / 16 {
            left.div_ceil(DELAY_STEPS)
        } else {
            left
        };
    }
}

/// See the module.
pub(super) struct Candidate {
    pub ways: Vec<PartWay, 2>,
}

impl Candidate {
    pub fn ticks(&self) -> u64 {
        self.ways.iter().map(PartWay::ticks).fold(0, u64::max)
    }

    /// Takes longer delays; whether there were any left.
    pub fn delay_more(&mut self) -> bool {
        let longest = |way: &PartWay| way.delay >= way.ending_ticks || way.line.is_none();
        if self.ways.iter().all(longest) {
            return false;
        }
        self.ways.iter_mut().for_each(PartWay::delay_more);
        true
    }

    /// Slower lines; one that would take longer than can be counted stays as it is.
    pub fn slow(&mut self, slower: f32) {
        for line in self.ways.iter_mut().filter_map(|way| way.line.as_mut()) {
            if let Some(slowed) = line.slowed(slower) {
                *line = slowed;
            }
        }
    }

    /// Writes its pieces; `None` where there are too many.
    #[inline(never)]
    pub fn write(
        &self,
        leaving: &Leaving<'_>,
        to: &Position,
        ended: &mut Ended,
        pieces: &mut Pieces,
    ) -> Option<()> {
        let mut line_plan = Plan::default();
        let mut endings = self.ways.iter().map(|way| way.ending);
        let first = endings.next()?;
        leaving.write(first, ended)?;
        if let Some(second) = endings.next().filter(|&second| second != first) {
            let [x, y, _] = ended.rest;
            keep(&mut ended.pieces, Part::Translation);
            copy(&ended.pieces, &mut line_plan.pieces);
            ended.of = None;
            leaving.write(second, ended)?;
            keep(&mut ended.pieces, Part::Rotation);
            write_sum(&line_plan.pieces, &ended.pieces, 0, pieces)?;
            copy(pieces, &mut ended.pieces);
            (ended.rest[0], ended.rest[1]) = (x, y);
        }
        ended.of = None;
        let rest = ended.rest;
        let (mut from, mut sum) = (&mut ended.pieces, &mut *pieces);
        for way in &self.ways {
            if let Some(line) = &way.line {
                line_plan.pieces.clear();
                line_plan.end = way.part.select(*to, rest);
                line.profile.write_plan(&mut line_plan, &rest)?;
                write_sum(from, &line_plan.pieces, way.delay, sum)?;
                core::mem::swap(&mut from, &mut sum);
            }
        }
        // After an even number of lines the last sum is in the other list.
        if self.ways.iter().filter(|way| way.line.is_some()).count() % 2 == 0 {
            copy(from, sum);
        }
        Some(())
    }
}

/// Leaves what pieces say of a part.
fn keep(pieces: &mut [Piece], part: Part) {
    for piece in pieces {
        piece.jerk = part.select(piece.jerk, [0; 3]);
    }
}

fn copy(from: &[Piece], to: &mut Pieces) {
    to.clear();
    // As many.
    let _ = to.extend_from_slice(from);
}
