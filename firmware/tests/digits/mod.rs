//! Numbers of 57 digits with the few functions that the exact kinematics need.

use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// 57 digits.
const BITS: usize = 192;
const ROUND: RoundingMode = RoundingMode::ToEven;

/// A number.
#[derive(Clone, Debug)]
pub struct Number(BigFloat);

/// What functions need to remember.
pub struct Digits(Consts);

impl Digits {
    pub fn new() -> Self {
        Self(Consts::new().expect("memory"))
    }

    /// `units` / 2^32 turns, in rad.
    pub fn radians(&mut self, units: i64) -> Number {
        let pi = Number(self.0.pi(BITS, ROUND));
        pi * Number::of(units) / Number::of(1 << 31)
    }

    pub fn sin_cos(&mut self, angle: &Number) -> (Number, Number) {
        (
            Number(angle.0.sin(BITS, ROUND, &mut self.0)),
            Number(angle.0.cos(BITS, ROUND, &mut self.0)),
        )
    }

    pub fn asin(&mut self, sine: &Number) -> Number {
        Number(sine.0.asin(BITS, ROUND, &mut self.0))
    }

    pub fn atan(&mut self, tangent: &Number) -> Number {
        Number(tangent.0.atan(BITS, ROUND, &mut self.0))
    }
}

impl Number {
    /// Exactly this integer.
    pub fn of(whole: i64) -> Self {
        Self(BigFloat::from_i64(whole, BITS))
    }

    pub fn sqrt(&self) -> Self {
        Self(self.0.sqrt(BITS, ROUND))
    }

    /// Its 15 first digits, which is all that a difference needs.
    pub fn to_f64(&self) -> f64 {
        let Some((words, _, sign, exponent, _)) = self.0.as_raw_parts() else {
            return f64::NAN;
        };
        // The mantissa's highest bit is set, and stands for a half.
        let mantissa = words.last().map_or(0.0, |&word| word as f64) / 18_446_744_073_709_551_616.0;
        let size = mantissa * 2f64.powi(exponent);
        if sign == Sign::Neg { -size } else { size }
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident) => {
        impl $operator for Number {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(&other.0, BITS, ROUND))
            }
        }
        impl $operator for &Number {
            type Output = Number;
            fn $name(self, other: Self) -> Number {
                Number(self.0.$name(&other.0, BITS, ROUND))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Number {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.neg())
    }
}
