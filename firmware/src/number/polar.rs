//! Direction of a vector: a float's arctangent, corrected once in fixed point.

use super::{Fixed, root, trigonometric};
use kinematics::Angle;

/// Shorter vectors have no direction worth the name (no feasible pose comes near: the sum of the three guides, at least
/// three times the guide start).
const SHORTEST: i64 = 1 << 20;

/// Units of angle in a radian.
const UNITS_PER_RADIAN: f32 = (4_294_967_296.0 / core::f64::consts::TAU) as f32;
const RADIANS_PER_UNIT: f32 = (core::f64::consts::TAU / 4_294_967_296.0) as f32;

/// Angle of (`re`, `im`) with its cosine and sine; `None` for a vector shorter than 2^-9.
#[inline]
pub(super) fn polar(re: Fixed, im: Fixed) -> Option<(Angle, Fixed, Fixed)> {
    if i64::from(re.bits()).abs() + i64::from(im.bits()).abs() < SHORTEST {
        return None;
    }
    // Good to about 3e-7: the rest is found by turning the vector back by it.
    let rough = libm::atan2f(im.bits() as f32, re.bits() as f32);
    let rough = (rough * UNITS_PER_RADIAN) as i32;
    let (s, c) = trigonometric::sin_cos(rough as u32);
    let product = |a: Fixed, b: Fixed| i64::from(a.bits()) * i64::from(b.bits());
    let along = product(re, c) + product(im, s);
    let across = product(im, c) - product(re, s);
    let across = (across >> 20) as i32 as f32;
    let along = (along >> 29) as i32 as f32 * 512.0;
    let rest = root::round(across / along * UNITS_PER_RADIAN);
    let turn = |a: Fixed, b: Fixed| {
        let change = rest as f32 * RADIANS_PER_UNIT * b.bits() as f32;
        Fixed::from_bits(a.bits().wrapping_add(root::round(change)))
    };
    let angle = Angle::from_units(i64::from(rough) + i64::from(rest));
    Some((angle, turn(c, -s), turn(s, c)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_within_4e_9_of_the_exact_direction() {
        let mut worst = 0f64;
        for k in 0..500_000u32 {
            let exact = f64::from(k.wrapping_mul(2_654_435_769)) / 4_294_967_296.0
                * core::f64::consts::TAU
                - core::f64::consts::PI;
            let length = 0.6 + 2.4 * f64::from(k % 1000) / 1000.0;
            let re = Fixed::from_f64(length * exact.cos());
            let im = Fixed::from_f64(length * exact.sin());
            let exact = im.to_f64().atan2(re.to_f64());
            let (angle, cosine, sine) = polar(re, im).unwrap();
            let turn = (angle.radians() - exact) / core::f64::consts::TAU;
            worst = worst
                .max((turn - turn.round()).abs() * core::f64::consts::TAU)
                .max((cosine.to_f64() - exact.cos()).abs())
                .max((sine.to_f64() - exact.sin()).abs());
        }
        assert!(worst < 4e-9, "worst {worst:e}");
    }

    #[test]
    fn a_vector_of_no_length_has_no_direction() {
        assert_eq!(polar(Fixed::from_bits(0), Fixed::from_bits(0)), None);
    }
}
