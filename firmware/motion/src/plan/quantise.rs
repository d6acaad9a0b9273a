//! From profiles to the integers of a plan: whole ticks, and jerks in 2^-72 units.
//!
//! A change of velocity ends with exactly no acceleration, whatever rounding does.
//!
//! Along a line every axis gets the same pieces, times its own factor: the line is straight by construction. The jerks of a
//! path profile are integers `q`; an axis' jerk is `6 D q / 2^bits`, rounded, with D such that the whole is the way. What
//! rounding takes from the acceleration in one piece is given back in the next, and what is left at the end is spread
//! as the plan's nudge.

use super::axis_state::{AxisState, JERK_STEP, SUB_BITS};
use super::{MAX_PIECES, Piece, Pieces, Plan, Position, push_piece, same};
use heapless::Vec;
use number::float::{i64_to_f32_fast, i128_to_f32_fast, ticks_to_f32};
use number::round_ties_even;
use number::wide_integer::{divide, quotient};

/// The pieces that take the axes to the velocities `wanted` (2^-72 units a tick): a jerk, a time without, a jerk, and a
/// tick that takes what rounding leaves of the acceleration, so that exactly none is left. What rounding leaves of a
/// velocity is less than the sum of the ticks, squared. The first and the last of the ticks are not zero.
pub fn velocity_pieces(
    state: &[AxisState; 3],
    wanted: &[i64; 3],
    [n1, n2, n3]: [u64; 3],
) -> [Piece; 4] {
    let mut pieces = [n1, n2, n3, 1].map(Piece::coast);
    for (i, (axis, wanted)) in state.iter().zip(wanted).enumerate() {
        if axis.velocity == *wanted && axis.acceleration == 0 {
            continue;
        }
        let [first, last] = velocity_jerks(axis, *wanted, [n1, n2, n3]);
        let ramps = first
            .wrapping_mul(n1 as i64)
            .wrapping_add(last.wrapping_mul(n3 as i64));
        pieces[0].jerk[i] = first;
        pieces[2].jerk[i] = last;
        pieces[3].jerk[i] = axis.acceleration.wrapping_add(ramps).wrapping_neg();
    }
    if same(&pieces[3].jerk, &[0; 3]) {
        pieces[3].ticks = 0;
    }
    pieces
}

/// Writes them in place of what there is.
pub fn write_velocity_pieces(
    pieces: &mut Pieces,
    state: &[AxisState; 3],
    wanted: &[i64; 3],
    ticks: [u64; 3],
) {
    pieces.clear();
    for piece in velocity_pieces(state, wanted, ticks) {
        // Four of many.
        let _ = push_piece(pieces, piece);
    }
}

/// Jerks of the first and the last segment.
#[inline(never)]
fn velocity_jerks(axis: &AxisState, wanted: i64, [n1, n2, n3]: [u64; 3]) -> [i64; 2] {
    let (n1, n2, n3) = (n1 as i64, n2 as i64, n3 as i64);
    // An acceleration is even.
    let half = axis.acceleration / 2;
    let gained = axis.velocity.wrapping_add(half.wrapping_mul(n1));
    let peak = twice_over(wanted.wrapping_sub(gained), n1 + 2 * n2 + n3);
    let first = jerk(peak - axis.acceleration, n1);
    let last = jerk(-axis.acceleration.wrapping_add(first.wrapping_mul(n1)), n3);
    [first, last]
}

/// Twice `value` over `divisor`, without an overflow, to two.
fn twice_over(value: i64, divisor: i64) -> i64 {
    let whole = divide(value, divisor);
    // Less than the divisor.
    let rest = 2 * value.wrapping_sub(whole.wrapping_mul(divisor));
    2 * whole + i64::from(rest >= divisor) - i64::from(rest <= -divisor)
}

/// The jerk that changes an acceleration by `change` in `ticks`, rounded towards zero to one that integers follow
/// exactly.
fn jerk(change: i64, ticks: i64) -> i64 {
    divide(change, ticks * JERK_STEP) * JERK_STEP
}

/// Fraction bits of jerks that are not just 1 and -1. Times the cube of the longest duration they are within 128 bits.
pub const JERK_BITS: u32 = 30;

/// A segment of constant jerk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JerkSegment {
    /// Length.
    pub ticks: u64,
    /// Jerk of the path parameter, in units of its own.
    pub jerk: i32,
}

/// How a line is travelled: segments of constant jerk of the path parameter, in whole numbers.
#[derive(Clone, Debug, Default)]
pub struct PathProfile {
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
            plan.pieces.push(Piece::coast(segment.ticks)).ok()?;
        }
        let duration = self.ticks().max(1);
        let moments = self.moments(duration);
        for (i, from) in from.iter().enumerate() {
            let way = i128::from(plan.end[i]) - i128::from(*from);
            if way != 0 {
                let rest = self.axis(i, way << SUB_BITS, &moments, plan)?;
                plan.nudge[i] = divide(rest, duration as i64);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::state_after_pieces;
    use number::random::Random;

    /// From any state to any velocity in any ticks: no acceleration is left, and of the velocity less than the ticks,
    /// squared, times the step of a jerk.
    #[test]
    fn the_velocity_is_reached_without_an_acceleration() {
        let mut random = Random::new(7);
        let mut next = |bits: u32| random.bits(bits);
        for _ in 0..2_000 {
            let state = [0; 3].map(|_| AxisState {
                position: 0,
                velocity: next(56),
                acceleration: next(44) * JERK_STEP,
            });
            let wanted = [0; 3].map(|_| next(56));
            let ticks = [0, 1, 2].map(|k| (next(11).unsigned_abs()).max(u64::from(k != 1)));
            let pieces = velocity_pieces(&state, &wanted, ticks);
            let end = state_after_pieces(&state, &pieces, &[0; 3]);
            let all: u64 = ticks.iter().sum();
            for i in 0..3 {
                assert_eq!(end[i].acceleration, 0);
                let off = end[i].velocity.abs_diff(wanted[i]);
                assert!(off <= 6 * all * all, "{off} {ticks:?}");
            }
        }
    }
}
