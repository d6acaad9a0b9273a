//! Direction of a vector: a coarse arctangent in floats, corrected once in fixed point.

use super::fixed::Fixed;
use super::{root, trigonometric};
use kinematics::Angle;

/// Shorter vectors have no direction worth the name (no feasible pose comes near: the sum of the three guides, at least
/// three times the guide start).
const SHORTEST: u32 = 1 << 20;

/// Units of angle in a radian.
const UNITS_PER_RADIAN: f32 = (4_294_967_296.0 / core::f64::consts::TAU) as f32;

/// atan(t) / t for t in [0, 1], a polynomial in t^2: Hastings' (Approximations for Digital Computers, 1955, sheet 9),
/// off by 1e-5 rad at most.
const ARCTANGENT: [f32; 5] = [0.999_866, -0.330_299_5, 0.180_141, -0.085_133, 0.020_835_1];

/// Angle of (`re`, `im`) in 2^-32 turns, good to 1.1e-5 rad.
#[inline]
fn coarse_angle(re: Fixed, im: Fixed) -> u32 {
    const QUARTER_TURN: u32 = 1 << 30;
    let (width, height) = (re.bits().unsigned_abs(), im.bits().unsigned_abs());
    let steep = height > width;
    let (small, large) = if steep {
        (width, height)
    } else {
        (height, width)
    };
    let t = small as i32 as f32 / large as i32 as f32;
    let [a, b, c, d, e] = ARCTANGENT;
    let z = t * t;
    let ratio = a + z * (b + z * (c + z * (d + z * e)));
    let angle = (t * UNITS_PER_RADIAN * ratio) as i32 as u32;
    // Out of the first octant into the vector's own.
    let angle = if steep { QUARTER_TURN - angle } else { angle };
    let angle = if re.bits() < 0 {
        2 * QUARTER_TURN - angle
    } else {
        angle
    };
    if im.bits() < 0 {
        angle.wrapping_neg()
    } else {
        angle
    }
}

/// Angle of (`re`, `im`) with its cosine and sine; `None` for a vector shorter than 2^-9.
#[inline]
pub(super) fn polar(re: Fixed, im: Fixed) -> Option<(Angle, Fixed, Fixed)> {
    if re
        .bits()
        .unsigned_abs()
        .saturating_add(im.bits().unsigned_abs())
        < SHORTEST
    {
        return None;
    }
    let rough = coarse_angle(re, im);
    let (s, c) = trigonometric::sin_cos(rough);
    // What is left is found by turning the vector back by the rough angle. It is under 1.2e-5 rad, its square under
    // 2e-10.
    let along = Fixed::add_product(Fixed::add_product(0, re, c), im, s);
    let across = Fixed::add_product(Fixed::add_product(0, im, c), -re, s);
    let across = (across >> 20) as i32 as f32;
    let along = (along >> 32) as i32 as f32 * 4096.0;
    let tangent = across / along;
    let (rest, _) = root::round_ties_even(tangent * UNITS_PER_RADIAN);
    let turn = |a: Fixed, b: Fixed| {
        let (change, _) = root::round_ties_even(tangent * b.bits() as f32);
        Fixed::from_bits(a.bits().wrapping_add(change))
    };
    let angle = Angle::from_units(i64::from((rough as i32).wrapping_add(rest)));
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
