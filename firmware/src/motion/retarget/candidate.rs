//! One way to the new target: for translation and for rotation each an ending of the motion under way, a line from
//! there, and the delay between them.

use super::ending::{Ended, Ending, Leaving};
use super::line::Line;
use super::overlap::Overlap;
use super::part::Part;
use crate::motion::plan::{Piece, Pieces, Plan, Position, state_after_pieces, write_sum};
use crate::number::float::{FloatMinMax, ticks_to_f32};

/// The way of translation, or of rotation.
#[derive(Clone, Copy)]
pub(super) struct PartWay {
    pub ending: Ending,
    ending_ticks: u64,
    /// None where there is no way left to go.
    line: Option<Line>,
    delay: u64,
}

/// The part of what is left of the longest delay that is added when a delay was too short.
const LATER: u64 = 3;

impl PartWay {
    /// With the least delay at which the path's or the rotation's own limits are kept; `None` where it would not be
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
            ending,
            ending_ticks: ended.ticks,
            line: Line::new(part.only(ended.left), share, leaving),
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
    pub fn level(&mut self, overlap: &Overlap, ended: &Ended, part: Part, ticks: u64) {
        if let Some(line) = &mut self.line {
            let longer = ticks_to_f32(ticks - self.delay) / ticks_to_f32(line.profile.ticks());
            if let Some(slowed) = line.slowed(longer.fmax(1.0))
                && overlap.is_kept(&ended.corners, &slowed, part, self.delay)
            {
                *line = slowed;
            }
        }
    }

    /// Takes a longer delay.
    fn later(&mut self) {
        let left = self.ending_ticks.saturating_sub(self.delay);
        self.delay += if left > self.ending_ticks / 16 {
            left.div_ceil(LATER)
        } else {
            left
        };
    }
}

/// See the module.
pub(super) struct Candidate {
    pub parts: [PartWay; 2],
}

impl Candidate {
    pub fn ticks(&self) -> u64 {
        self.parts[0].ticks().max(self.parts[1].ticks())
    }

    /// Takes longer delays; whether there were any left.
    pub fn later(&mut self) -> bool {
        let longest = |part: &PartWay| part.delay >= part.ending_ticks || part.line.is_none();
        if self.parts.iter().all(longest) {
            return false;
        }
        for part in &mut self.parts {
            part.later();
        }
        true
    }

    /// Slower lines; one that would take longer than can be counted stays as it is.
    pub fn slow(&mut self, slower: f32) {
        for line in self.parts.iter_mut().filter_map(|part| part.line.as_mut()) {
            if let Some(slowed) = line.slowed(slower) {
                *line = slowed;
            }
        }
    }

    /// Writes its pieces in floats; `None` where there are too many.
    #[inline(never)]
    pub fn write_floats(
        &self,
        leaving: &Leaving<'_>,
        ended: &mut Ended,
        pieces: &mut Pieces<f32>,
    ) -> Option<()> {
        let mut other = Pieces::new();
        let (mut from, mut to) = self.buffers(pieces, &mut other);
        let [translation, rotation] = &self.parts;
        leaving.write_ended(translation.ending, ended)?;
        from.clone_from(&ended.pieces);
        if translation.ending != rotation.ending {
            leaving.write_ended(rotation.ending, ended)?;
            to.clone_from(from);
            write_parts(to, &mut ended.pieces, from)?;
        }
        for line in self
            .parts
            .iter()
            .filter_map(|part| Some((part.line.as_ref()?, part.delay)))
        {
            write_sum(from, &line.0.pieces(leaving.hz), line.1, to)?;
            core::mem::swap(&mut from, &mut to);
        }
        Some(())
    }

    /// Writes its pieces.
    #[inline(never)]
    pub fn write(&self, leaving: &Leaving<'_>, to: &Position, pieces: &mut Pieces) -> Option<()> {
        let (mut other, mut line_plan) = (Pieces::new(), Plan::default());
        let (mut from, mut sum) = self.buffers(pieces, &mut other);
        let [translation, rotation] = &self.parts;
        leaving.write(translation.ending, from)?;
        if translation.ending != rotation.ending {
            sum.clone_from(from);
            leaving.write(rotation.ending, &mut line_plan.pieces)?;
            write_parts(sum, &mut line_plan.pieces, from)?;
        }
        let rest = state_after_pieces(&leaving.state, from, &[0; 3]).map(|axis| axis.rounded());
        let ends = [[to[0], to[1], rest[2]], [rest[0], rest[1], to[2]]];
        for (part, end) in self.parts.iter().zip(ends) {
            if let Some(line) = &part.line {
                line_plan.pieces.clear();
                line_plan.end = end;
                line.profile.write_plan(&mut line_plan, &rest)?;
                write_sum(from, &line_plan.pieces, part.delay, sum)?;
                core::mem::swap(&mut from, &mut sum);
            }
        }
        Some(())
    }

    /// Two lists of pieces, of which the first is the last after an exchange for each line.
    fn buffers<'a, J>(
        &self,
        last: &'a mut Pieces<J>,
        other: &'a mut Pieces<J>,
    ) -> (&'a mut Pieces<J>, &'a mut Pieces<J>) {
        let [first, second] = [0, 1].map(|i| self.parts[i].line.is_some());
        if first == second {
            (last, other)
        } else {
            (other, last)
        }
    }
}

/// Writes the sum of what one list of pieces says of translation, and another of rotation.
fn write_parts<J: Copy + Default + PartialEq + core::ops::Add<Output = J>>(
    translation: &mut [Piece<J>],
    rotation: &mut [Piece<J>],
    pieces: &mut Pieces<J>,
) -> Option<()> {
    for piece in translation.iter_mut() {
        piece.jerk[2] = J::default();
    }
    for piece in rotation.iter_mut() {
        piece.jerk = [J::default(), J::default(), piece.jerk[2]];
    }
    write_sum(translation, rotation, 0, pieces)
}
