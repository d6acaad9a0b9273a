//! One axis of motion: position, velocity and acceleration as integers that a jerk drives, tick by tick.
//!
//! The unit of x and y is 2^-72 track radii, that of theta 2^-72 turns (see [`SUB_BITS`]); rates are per tick, per
//! tick squared and per tick cubed. In integers a cubic is followed exactly: no rounding grows with time or with the
//! number of turns, x86 and the chip agree to the bit, and a position can not step, because it is only ever added to.

/// Bits of an axis position below the 2^-32 track radii or turns of a [`Position`](super::Position).
///
/// 40 leaves velocity, in 64 bits, a range of 2^-9 turns a tick (39 turns/s at 20 kHz), while the jerk of the slowest
/// useful move (1e-3 turns/s^3 is 1.2e-16 turns a tick cubed) still has 19 significant bits.
pub const SUB_BITS: u32 = 40;

/// Every jerk is a multiple of this, so that the halves and sixths of the cubic are whole numbers.
pub const JERK_STEP: i64 = 6;

/// Times 3 this is 1, modulo 2^64: a multiple of 3 times it is a third of it, without the library call that a division of
/// 64 bits is on the chip.
const INVERSE_OF_3: i64 = 0xAAAA_AAAA_AAAA_AAAB_u64 as i64;

/// Position, velocity and acceleration of one axis at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// Position, 2^-72 track radii or turns.
    pub position: i128,
    /// Velocity, the same per tick.
    pub velocity: i64,
    /// Acceleration, the same per tick squared; always a multiple of [`JERK_STEP`].
    pub acceleration: i64,
}

impl Axis {
    /// At rest at `position` (2^-32 track radii or turns).
    pub const fn at_rest(position: i64) -> Self {
        Self {
            position: (position as i128) << SUB_BITS,
            velocity: 0,
            acceleration: 0,
        }
    }

    /// The state one tick later under a constant `jerk`, a multiple of [`JERK_STEP`]. `nudge` is added to the position
    /// besides; see [`Plan::nudge`](super::Plan::nudge).
    #[inline]
    pub fn advance(&mut self, jerk: i64, nudge: i64) {
        // Both are even, so that the shifts are the halves; the sixth is exact as well.
        let half_jerk = jerk >> 1;
        let step = self
            .velocity
            .wrapping_add(self.acceleration >> 1)
            .wrapping_add(half_jerk.wrapping_mul(INVERSE_OF_3))
            .wrapping_add(nudge);
        self.position = self.position.wrapping_add(i128::from(step));
        self.velocity = self
            .velocity
            .wrapping_add(self.acceleration)
            .wrapping_add(half_jerk);
        self.acceleration = self.acceleration.wrapping_add(jerk);
    }

    /// The state `ticks` later, the same to the bit as that many calls of [`advance`](Self::advance).
    pub fn after(&self, ticks: u64, jerk: i64, nudge: i64) -> Self {
        let t = i128::from(ticks);
        let (v, a, j) = (
            i128::from(self.velocity),
            i128::from(self.acceleration),
            i128::from(jerk),
        );
        Self {
            position: self.position
                + (v + i128::from(nudge)) * t
                + a / 2 * t * t
                + j / i128::from(JERK_STEP) * t * t * t,
            velocity: (v + a * t + j / 2 * t * t) as i64,
            acceleration: (a + j * t) as i64,
        }
    }

    /// Position in 2^-32 track radii or turns, rounded down.
    #[inline]
    pub fn rounded(&self) -> i64 {
        (self.position >> SUB_BITS) as i64
    }
}
