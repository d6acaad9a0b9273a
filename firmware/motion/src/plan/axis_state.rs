//! One axis of motion: position, velocity and acceleration as integers that a jerk drives, tick by tick.
//!
//! The unit of x and y is 2^-72 track radii, that of theta 2^-72 turns (see [`SUB_BITS`]); rates are per tick, per
//! tick squared and per tick cubed. In integers a cubic is followed exactly: no rounding grows with time or with the
//! number of turns, x86 and the chip agree to the bit, and a position can not step, because it is only ever added to.

use number::wide_integer::mul_i64_u32;

/// Bits of an axis position below the 2^-32 track radii or turns of a [`Position`](crate::Position).
///
/// 40 leaves velocity, in 64 bits, a range of 2^-9 turns a tick (39 turns/s at 20 kHz), while the jerk of the slowest
/// useful move (1e-3 turns/s^3 is 1.2e-16 turns a tick cubed) still has 19 significant bits.
pub const SUB_BITS: u32 = 40;

/// Every jerk is a multiple of this, so that the halves and sixths of the cubic are whole numbers.
pub const JERK_STEP: i64 = 6;

/// Times 3 this is 1, modulo 2^64: a multiple of 3 times it is a third of it, without the library call that a division
/// of 64 bits is on the chip.
const INVERSE_OF_3: i64 = 0xAAAA_AAAA_AAAA_AAAB_u64 as i64;

/// Position, velocity and acceleration of one axis at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisState {
    /// Position, 2^-72 track radii or turns.
    pub position: i128,
    /// Velocity, the same per tick.
    pub velocity: i64,
    /// Acceleration, the same per tick squared; always a multiple of [`JERK_STEP`].
    pub acceleration: i64,
}

/// What drives an axis in every tick of a piece, so that a sixth is taken once a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickIncrement {
    jerk: i64,
    /// A sixth of the jerk, and the nudge.
    sixth: i64,
}

impl TickIncrement {
    /// Of a constant `jerk`, a multiple of [`JERK_STEP`]; `nudge` is added to the position besides, see
    /// [`Plan::nudge`](crate::Plan::nudge).
    #[inline]
    pub fn new(jerk: i64, nudge: i64) -> Self {
        let sixth = (jerk >> 1).wrapping_mul(INVERSE_OF_3);
        Self {
            jerk,
            sixth: sixth.wrapping_add(nudge),
        }
    }
}

impl AxisState {
    /// At rest at `position` (2^-32 track radii or turns).
    pub const fn at_rest(position: i64) -> Self {
        Self {
            position: (position as i128) << SUB_BITS,
            velocity: 0,
            acceleration: 0,
        }
    }

    /// The state one tick later.
    #[inline]
    pub fn advance(&mut self, increment: &TickIncrement) {
        // Both are even, so that the shifts are the halves.
        let step = (self.velocity)
            .wrapping_add(self.acceleration >> 1)
            .wrapping_add(increment.sixth);
        self.position = self.position.wrapping_add(i128::from(step));
        self.velocity = (self.velocity)
            .wrapping_add(self.acceleration)
            .wrapping_add(increment.jerk >> 1);
        self.acceleration = self.acceleration.wrapping_add(increment.jerk);
    }

    /// The state `ticks` later, the same to the bit as that many calls of [`advance`](Self::advance).
    pub fn after(&self, ticks: u64, jerk: i64, nudge: i64) -> Self {
        let mut axis = *self;
        axis.pass(ticks, jerk, nudge);
        axis
    }

    /// The same in place.
    // Inlined wherever plans are walked through, products of 128 bits were a tenth of the generator's code.
    #[inline(never)]
    pub fn pass(&mut self, ticks: u64, jerk: i64, nudge: i64) {
        let displacement = self.displacement(ticks, jerk, nudge);
        self.position = self.position.wrapping_add(displacement);
        let t = ticks as i64;
        let change = self.acceleration.wrapping_add(t.wrapping_mul(jerk >> 1));
        self.velocity = self.velocity.wrapping_add(t.wrapping_mul(change));
        self.acceleration = self.acceleration.wrapping_add(t.wrapping_mul(jerk));
    }

    /// The way of `ticks`: `t (v + t (a / 2 + t j / 6))`.
    fn displacement(&self, ticks: u64, jerk: i64, nudge: i64) -> i128 {
        let sixth = (jerk >> 1).wrapping_mul(INVERSE_OF_3);
        let half = self.acceleration >> 1;
        let t = ticks as i64;
        // The mean velocity lies between those that are met, so it has 64 bits like them, whatever its terms have.
        let mean = half.wrapping_add(sixth.wrapping_mul(t)).wrapping_mul(t);
        let mean = mean.wrapping_add(self.velocity).wrapping_add(nudge);
        // A product with 32 bits is a fourth of one with 64, and only jogs and the slowest moves have pieces of days.
        match u32::try_from(ticks) {
            Ok(t) => mul_i64_u32(mean, t),
            Err(_) => i128::from(mean).wrapping_mul(i128::from(ticks)),
        }
    }

    /// Where this is at rest in the end, when a nudge comes on top for so many ticks. What rounding leaves of a
    /// velocity does not count.
    #[inline(never)]
    pub fn rest_position(&self, ticks: u64, nudge: i64) -> i64 {
        let way = i128::from(nudge) * i128::from(ticks);
        (self.position.wrapping_add(way) >> SUB_BITS) as i64
    }

    /// Position in 2^-32 track radii or turns, rounded down.
    #[inline]
    pub fn rounded(&self) -> i64 {
        (self.position >> SUB_BITS) as i64
    }
}

/// 2^32: units of a [`Position`](crate::Position) in a track radius or a turn.
pub const POSITION_UNITS: f32 = 4_294_967_296.0;
/// The inverse.
pub const PER_POSITION_UNIT: f32 = 1.0 / POSITION_UNITS;
/// 2^72: units of an [`AxisState`].
pub const AXIS_UNITS: f32 = 4_722_366_482_869_645_213_696.0;
/// The inverse.
pub const PER_AXIS_UNIT: f32 = 1.0 / AXIS_UNITS;

#[cfg(test)]
mod tests {
    use crate::plan::axis_state::*;
    use number::random::Random;

    #[test]
    fn many_ticks_at_once_are_as_many_ticks() {
        let mut random = Random::new(7);
        let mut next = |bits: u32| random.bits(bits);
        for _ in 0..200 {
            let start = AxisState {
                position: i128::from(next(60)) << 42,
                velocity: next(58),
                acceleration: next(48) * JERK_STEP,
            };
            let (jerk, nudge) = (next(40) * JERK_STEP, next(40));
            let mut axis = start;
            for ticks in 0..300 {
                assert_eq!(
                    start.after(ticks, jerk, nudge),
                    axis,
                    "{start:?} {ticks} {jerk}"
                );
                axis.advance(&TickIncrement::new(jerk, nudge));
            }
        }
    }

    #[test]
    fn two_stretches_are_as_long_as_one_beyond_32_bits() {
        let start = AxisState {
            position: -(5 << 90),
            velocity: 123_456_789,
            acceleration: -6 * 5_000,
        };
        for (first, second) in [(1, u64::from(u32::MAX)), (1 << 31, 1 << 33), (40, 1 << 40)] {
            let (jerk, nudge) = (0, -17);
            assert_eq!(
                start.after(first, jerk, nudge).after(second, jerk, nudge),
                start.after(first + second, jerk, nudge)
            );
        }
    }
}
