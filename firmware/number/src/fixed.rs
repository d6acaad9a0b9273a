//! A fixed-point number with 29 fraction bits, for lengths in track radii, sines and cosines.
//!
//! Why not the crate `fixed`: its type could only be the inside of this one. [`Scalar`] is a trait of `kinematics`, and
//! Rust lets a third crate implement it for a type of its own only. What the wrapper could then pass on is shifts and
//! wrapping sums. What counts here is not in it: its product is rounded down, where [`Scalar`]'s is rounded to nearest,
//! once for a whole sum of products (`fixed` has the wide product to build that from, which is what `add_product` is);
//! sine, arcsine and polar form need the instructions in `multiply`, that work on the bits; and its plain operators
//! panic on overflow in a debug build, where these wrap on every machine alike, so host and chip could differ. `fixed`
//! 1.31 wants Rust 1.93, this workspace 1.90.
//!
//! [`Scalar`]: kinematics::Scalar

use super::multiply;
use core::ops::{Add, Mul, Neg, Sub};

/// A number in [-4, 4) with a resolution of 2^-29 = 1.9e-9 (0.19 nm on a track of 100 mm).
///
/// The range holds what position kinematics makes of poses inside the track: coordinates within 1, guides within 2, the
/// symmetrical components of the pivots within 3. Arithmetic wraps beyond it, so callers check ranges first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fixed(pub(super) i32);

impl Fixed {
    /// Bits after the point.
    pub const FRACTION_BITS: u32 = 29;
    const LSB: f32 = 1.0 / (1u32 << Self::FRACTION_BITS) as f32;

    /// From the number times 2^29.
    #[inline]
    pub const fn from_bits(bits: i32) -> Self {
        Self(bits)
    }

    /// The number times 2^29.
    #[inline]
    pub const fn bits(self) -> i32 {
        self.0
    }

    /// The nearest to `value`, for constants; saturates.
    pub const fn from_f64(value: f64) -> Self {
        let scaled = value * (1u32 << Self::FRACTION_BITS) as f64;
        Self(if scaled < 0.0 {
            (scaled - 0.5) as i32
        } else {
            (scaled + 0.5) as i32
        })
    }

    /// From a length in 2^-32 track radii, as motion holds it, rounded to nearest; `None` out of range.
    #[inline]
    pub fn from_position(position: i64) -> Option<Self> {
        let rounded = position.wrapping_add(4) >> (32 - Self::FRACTION_BITS);
        i32::try_from(rounded).ok().map(Self)
    }

    /// As a length in 2^-32 track radii, exactly.
    #[inline]
    pub const fn to_position(self) -> i64 {
        (self.0 as i64) << (32 - Self::FRACTION_BITS)
    }

    /// `sum` plus the product, both with 58 fraction bits.
    #[inline]
    pub(super) fn add_product(sum: i64, a: Self, b: Self) -> i64 {
        multiply::add_product(sum, a.0, b.0)
    }

    /// From 58 fraction bits, rounded down.
    #[inline]
    pub(super) const fn from_product(product: i64) -> Self {
        Self((product >> Self::FRACTION_BITS) as i32)
    }

    /// `a b + c d` as a length in 2^-32 track radii, rounded to nearest.
    #[inline]
    pub fn products_as_position((a, b): (Self, Self), (c, d): (Self, Self)) -> i64 {
        const CUT: u32 = 2 * Fixed::FRACTION_BITS - 32;
        Self::add_product(Self::add_product(1 << (CUT - 1), a, b), c, d) >> CUT
    }

    /// As a float, rounded to its 24 bits.
    #[inline]
    pub fn to_f32(self) -> f32 {
        self.0 as f32 * Self::LSB
    }

    /// As a double, exactly.
    pub fn to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(1u32 << Self::FRACTION_BITS)
    }
}

/// Half of the last bit, with 58 fraction bits: what makes rounding down rounding to nearest.
pub(super) const HALF_LSB: i64 = 1 << (Fixed::FRACTION_BITS - 1);

impl Add for Fixed {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Fixed {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Fixed {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl Mul for Fixed {
    type Output = Self;
    /// Rounded to nearest.
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::from_product(Self::add_product(HALF_LSB, self, other))
    }
}
