//! An angle that stays exact over any number of turns: whole turns and a wrapping fraction of a turn in one integer.

use core::f64::consts::TAU;
use core::ops::{Add, AddAssign, Neg, Sub, SubAssign};

/// 2^32: units in a turn, as a float (exact).
const UNITS_PER_TURN: f64 = 4_294_967_296.0;
/// 2^63: the first magnitude an `i64` cannot hold.
const UNIT_LIMIT: f64 = 9_223_372_036_854_775_808.0;

/// A multi-turn angle in units of 2^-32 turn (1.46 nrad): the upper half counts whole turns, the lower half is the
/// fraction of a turn, just as an absolute encoder and a turn counter would give it.
///
/// Holds +-2^31 turns with the same resolution everywhere; sums and differences are exact and wrap at that range.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Debug)]
pub struct Angle(i64);

impl Angle {
    /// No angle.
    pub const ZERO: Self = Self(0);
    /// One whole turn.
    pub const TURN: Self = Self(1 << 32);
    /// 30 deg, rounded to the nearest unit: a third of a unit short.
    pub const DEG_30: Self = Self(357_913_941);
    /// 120 deg, rounded to the nearest unit: a third of a unit (0.5 nrad) short, so three of them are one unit short of
    /// [`Angle::TURN`]. `DEG_120 - DEG_30` is a quarter turn exactly, and 240 deg - 30 deg is again a third of a unit
    /// short: no guide's direction is off by more than that.
    pub const DEG_120: Self = Self(1_431_655_765);

    /// The angle of this many units of 2^-32 turn.
    pub const fn from_units(units: i64) -> Self {
        Self(units)
    }

    /// The angle in units of 2^-32 turn.
    pub const fn units(self) -> i64 {
        self.0
    }

    /// The fraction of a turn above [`Angle::turns`], in units of 2^-32 turn.
    pub const fn fraction(self) -> u32 {
        self.0 as u32
    }

    /// Whole turns, rounded down: -1 for a small negative angle.
    pub const fn turns(self) -> i32 {
        (self.0 >> 32) as i32
    }

    /// The angle, within one turn from zero, of an encoder reading of `bits` bits (at most 32; more count as 32).
    /// A reading beyond its bits wraps.
    pub const fn from_counts(counts: u32, bits: u32) -> Self {
        Self((((counts as u64) << 32) >> at_most_32(bits)) as u32 as i64)
    }

    /// The encoder reading of `bits` bits (at most 32; more count as 32) nearest to this angle, turns dropped.
    pub const fn counts(self, bits: u32) -> u32 {
        let bits = at_most_32(bits);
        let nearest = (((self.fraction() as u64) << bits) + (1 << 31)) >> 32;
        (nearest & ((1 << bits) - 1)) as u32
    }

    /// The angle nearest to `radians`; `None` if that is not finite or beyond +-2^31 turns.
    pub fn from_radians(radians: f64) -> Option<Self> {
        Self::from_fractional_units(radians * (UNITS_PER_TURN / TAU))
    }

    /// The angle in radians.
    pub fn radians(self) -> f64 {
        self.0 as f64 * (TAU / UNITS_PER_TURN)
    }

    /// The angle nearest to `degrees`, exact for whole turns; `None` if that is not finite or beyond +-2^31 turns.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        // The product is exact (a power of two), so the quotient is the only rounding.
        Self::from_fractional_units(degrees * UNITS_PER_TURN / 360.0)
    }

    /// The angle in degrees, exact for whole turns.
    pub fn degrees(self) -> f64 {
        self.0 as f64 * 360.0 / UNITS_PER_TURN
    }

    /// The angle that differs from `self` by whole turns and lies nearest to `reference`: from half a turn below it
    /// up to, not including, half a turn above.
    pub const fn near(self, reference: Self) -> Self {
        let offset = self.0.wrapping_sub(reference.0) as i32;
        Self(reference.0.wrapping_add(offset as i64))
    }

    fn from_fractional_units(units: f64) -> Option<Self> {
        let nearest = libm::rint(units);
        (-UNIT_LIMIT..UNIT_LIMIT)
            .contains(&nearest)
            .then_some(Self(nearest as i64))
    }
}

const fn at_most_32(bits: u32) -> u32 {
    if bits < 32 { bits } else { 32 }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl AddAssign for Angle {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Angle {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
