//! How a line is travelled: stretches of constant jerk of the path parameter, in whole numbers, and the plan they make.
//!
//! Every axis gets the same pieces, times its own factor: the line is straight by construction. The jerks of a pace are
//! integers `q`; an axis' jerk is `6 D q / 2^bits`, rounded, with D such that the whole is the way. What rounding takes from
//! the acceleration in one piece is given back in the next, and what is left at the end is spread as the plan's nudge.

use super::axis::{Axis, JERK_STEP, SUB_BITS};
use super::plan::{MAX_PIECES, Piece, Plan, Position, Start};
use heapless::Vec;

/// A stretch of constant jerk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Beat {
    /// Length.
    pub ticks: u64,
    /// Jerk of the path parameter, in units of its own.
    pub jerk: i32,
}

/// See the module.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// The stretches, from rest to rest.
    pub beats: Vec<Beat, MAX_PIECES>,
    /// Six times the way that the jerks make: positive.
    pub sixfold: i128,
    /// Fraction bits of the jerks.
    pub bits: u32,
}

impl Pace {
    /// Duration in ticks.
    pub fn ticks(&self) -> u64 {
        self.beats.iter().map(|beat| beat.ticks).sum()
    }

    /// What the path parameter's jerk is, per tick cubed, for one unit of a beat's.
    pub fn unit(&self) -> f32 {
        6.0 / self.sixfold as f32
    }

    /// The plan from `from` to `to`; `None` where a number would be too large.
    pub fn plan(&self, id: u32, from: Position, to: Position) -> Option<Plan> {
        let mut plan = Plan {
            id,
            start: Start::Rest(from),
            pieces: Vec::new(),
            nudge: [0; 3],
            end: to,
        };
        for beat in &self.beats {
            let ticks = beat.ticks;
            plan.pieces
                .push(Piece {
                    ticks,
                    jerk: [0; 3],
                })
                .ok()?;
        }
        let duration = self.ticks().max(1);
        for i in 0..3 {
            let way = i128::from(to[i]) - i128::from(from[i]);
            if way != 0 {
                plan.nudge[i] = self.axis(i, way, duration, &mut plan)?;
            }
        }
        Some(plan)
    }

    /// Writes the jerks of an axis; its nudge.
    #[inline(never)]
    fn axis(&self, i: usize, way: i128, duration: u64, plan: &mut Plan) -> Option<i64> {
        let way = way << SUB_BITS;
        let factor = i64::try_from((way << self.bits) / self.sixfold).ok()?;
        let mut axis = Axis::default();
        // What the acceleration lacks, in steps of a jerk.
        let mut owed = 0.0;
        for (piece, beat) in plan.pieces.iter_mut().zip(&self.beats) {
            let product = i128::from(factor) * i128::from(beat.jerk);
            let whole = (product >> self.bits) as i64;
            let fraction =
                (product - (i128::from(whole) << self.bits)) as f32 / (1u64 << self.bits) as f32;
            let ticks = beat.ticks as f32;
            let more = libm::rintf(fraction + owed / ticks);
            owed += (fraction - more) * ticks;
            let jerk = whole.wrapping_add(more as i64).wrapping_mul(JERK_STEP);
            axis = axis.after(beat.ticks, jerk, 0);
            piece.jerk[i] = jerk;
        }
        // In 64 bits a division is a tenth of one in 128.
        let rest = i64::try_from(way - axis.position).ok()?;
        Some(rest / duration as i64)
    }
}
