//! How a line is travelled: segments of constant jerk of the path parameter, in whole numbers, and the plan they make.
//!
//! Every axis gets the same pieces, times its own factor: the line is straight by construction. The jerks of a path
//! profile are integers `q`; an axis' jerk is `6 D q / 2^bits`, rounded, with D such that the whole is the way. What
//! rounding takes from the acceleration in one piece is given back in the next, and what is left at the end is spread
//! as the plan's nudge.

use crate::motion::plan::axis_state::{JERK_STEP, SUB_BITS};
use crate::motion::plan::{MAX_PIECES, Piece, Plan, Position};
use crate::motion::profile::rest_to_rest::RestToRestProfile;
use crate::number::float::{i64_to_f32_fast, i128_to_f32_fast, ticks_to_f32};
use crate::number::round_ties_even;
use crate::number::wide_integer::quotient;
use heapless::Vec;

/// Fraction bits of jerks that are not just 1 and -1. Times the cube of the longest duration they are within 128 bits.
pub(super) const JERK_BITS: u32 = 30;

/// A segment of constant jerk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct JerkSegment {
    /// Length.
    pub ticks: u64,
    /// Jerk of the path parameter, in units of its own.
    pub jerk: i32,
}

/// See the module.
#[derive(Clone, Debug, Default)]
pub(super) struct PathProfile {
    /// The segments, from rest to rest.
    pub segments: Vec<JerkSegment, MAX_PIECES>,
    /// Six times the way that the jerks make: positive.
    pub six_times_distance: i128,
    /// Fraction bits of the jerks: [`JERK_BITS`] or none.
    pub bits: u32,
}

impl PathProfile {
    /// Duration in ticks.
    pub fn ticks(&self) -> u64 {
        self.segments.iter().map(|segment| segment.ticks).sum()
    }

    /// What the path parameter's jerk is, per tick cubed, for one unit of a segment's.
    pub fn unit(&self) -> f32 {
        6.0 / i128_to_f32_fast(self.six_times_distance)
    }

    /// Writes pieces and nudge of a plan from `from` to its end; `None` where a number would be too large.
    pub fn write_plan(&self, plan: &mut Plan, from: &Position) -> Option<()> {
        for segment in &self.segments {
            let ticks = segment.ticks;
            plan.pieces
                .push(Piece {
                    ticks,
                    jerk: [0; 3],
                })
                .ok()?;
        }
        let duration = self.ticks().max(1);
        let moments = self.moments(duration);
        for (i, from) in from.iter().enumerate() {
            let way = i128::from(plan.end[i]) - i128::from(*from);
            if way != 0 {
                let rest = self.axis(i, way << SUB_BITS, &moments, plan)?;
                // In 64 bits a division is a tenth of one in 128.
                plan.nudge[i] = rest / duration as i64;
            }
        }
        Some(())
    }

    /// How far a sixth of a jerk of 1 in each of the segments leads until the end, modulo 2^64: the cube of the time
    /// from the segment's start to the end, less that from its end.
    fn moments(&self, duration: u64) -> [u64; MAX_PIECES] {
        let cube = |ticks: u64| ticks.wrapping_mul(ticks).wrapping_mul(ticks);
        let mut moments = [0; MAX_PIECES];
        let mut left = duration;
        let mut before = cube(left);
        for (moment, segment) in moments.iter_mut().zip(&self.segments) {
            left = left.wrapping_sub(segment.ticks);
            let after = cube(left);
            *moment = before.wrapping_sub(after);
            before = after;
        }
        moments
    }

    /// Writes the jerks of an axis; what they leave of its way, 2^-72 track radii or turns.
    #[inline(never)]
    fn axis(
        &self,
        i: usize,
        way: i128,
        moments: &[u64; MAX_PIECES],
        plan: &mut Plan,
    ) -> Option<i64> {
        let (factor, left) = quotient(way << self.bits, self.six_times_distance)?;
        // Rounding the jerks leaves little more than this: what is within 64 bits can be summed up in them.
        i64::try_from(left >> self.bits).ok()?;
        let mut rest = way as u64;
        // What the acceleration lacks, in steps of a jerk.
        let mut carried_acceleration = 0.0;
        for ((piece, segment), moment) in plan.pieces.iter_mut().zip(&self.segments).zip(moments) {
            let (whole, fraction) = self.share(factor, segment.jerk);
            let ticks = ticks_to_f32(segment.ticks);
            let (more, rounded) = rounded(fraction + carried_acceleration / ticks);
            carried_acceleration += (fraction - rounded) * ticks;
            let sixth = whole.wrapping_add(more);
            rest = rest.wrapping_sub((sixth as u64).wrapping_mul(*moment));
            piece.jerk[i] = sixth.wrapping_mul(JERK_STEP);
        }
        Some(rest as i64)
    }

    /// A segment's jerk times an axis' factor: whole, rounded down, and the fraction.
    #[inline]
    fn share(&self, factor: i64, jerk: i32) -> (i64, f32) {
        const PART: f32 = 1.0 / (1_u32 << JERK_BITS) as f32;
        let jerk = i64::from(jerk);
        if self.bits == 0 {
            return (factor.wrapping_mul(jerk), 0.0);
        }
        // In two parts, each of them within 64 bits.
        let (high, low) = ((factor >> 32) * jerk, i64::from(factor as u32) * jerk);
        let fraction = low as u32 & ((1 << JERK_BITS) - 1);
        let whole = (high << (32 - JERK_BITS)).wrapping_add(low >> JERK_BITS);
        (whole, fraction as f32 * PART)
    }
}

impl RestToRestProfile {
    /// Writes pieces and nudge of a plan from `from` to its end.
    pub(crate) fn write_plan(&self, plan: &mut Plan, from: &Position) -> Option<()> {
        let mut path_profile = PathProfile::default();
        self.write(&mut path_profile);
        path_profile.write_plan(plan, from)
    }

    /// Writes it as a path profile: its jerks are 1 and -1.
    pub(super) fn write(&self, path_profile: &mut PathProfile) {
        path_profile.segments.clear();
        for (ticks, jerk) in self.segments() {
            if ticks > 0 {
                // Seven segments, room for more.
                let _ = path_profile.segments.push(JerkSegment { ticks, jerk });
            }
        }
        path_profile.six_times_distance = 6 * self.volume();
        path_profile.bits = 0;
    }
}

/// The nearest whole number, as one and as a float.
#[inline]
fn rounded(value: f32) -> (i64, f32) {
    const MOST: f32 = 2_097_152.0;
    if value.abs() < MOST {
        let (whole, float) = round_ties_even(value);
        (i64::from(whole), float)
    } else {
        let whole = value as i64;
        (whole, i64_to_f32_fast(whole))
    }
}
