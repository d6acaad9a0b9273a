//! The curve through samples: a cubic spline with uniform knots, which has a velocity and an acceleration without
//! steps.
//!
//! ```text
//! c_k = s_k - (s_(k+1) - 2 s_k + s_(k-1)) / 6              control points
//! P(k + f) = a + b f + c f^2 + d f^3 of c_(k-1) .. c_(k+2)   between samples k and k + 1
//! ```
//!
//! A spline of the samples themselves would cut corners, by a sixth of their second difference; the control points lie
//! that much further out. The curve then follows every cubic exactly, and passes the samples of any smooth path with an
//! error of the fourth order of the distance between them: `h^4 P'''' (k + f^2 (1 - f)^2) / 24` with a k of a sixth at
//! most. It takes six samples, so it is three samples behind the newest.

use motion::plan::Position;

/// Samples that the curve between the third and the fourth is made of.
pub(super) const WINDOW: usize = 6;

/// Position, velocity and acceleration of one axis on the curve: relative to the third sample, in the samples' units,
/// per sample and sample squared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CurvePoint {
    pub offset: f32,
    pub rate: f32,
    pub acceleration: f32,
}

/// The curve a part `f` (0 to 1) on from the third sample of `window` to the fourth.
#[inline(never)]
pub(super) fn curve_point(window: &[Position; WINDOW], axis: usize, f: f32) -> CurvePoint {
    let origin = window[2][axis];
    let sample = |k: usize| window[k][axis].wrapping_sub(origin) as f32;
    let s = [
        sample(0),
        sample(1),
        sample(2),
        sample(3),
        sample(4),
        sample(5),
    ];
    let control = |k: usize| s[k] - (s[k + 1] - 2.0 * s[k] + s[k - 1]) * (1.0 / 6.0);
    let (c0, c1, c2, c3) = (control(1), control(2), control(3), control(4));
    let a = c1 + (c0 - 2.0 * c1 + c2) * (1.0 / 6.0);
    let b = (c2 - c0) * 0.5;
    let c = (c0 - 2.0 * c1 + c2) * 0.5;
    let d = (c3 - c0 - 3.0 * (c2 - c1)) * (1.0 / 6.0);
    CurvePoint {
        offset: a + f * (b + f * (c + f * d)),
        rate: b + f * (2.0 * c + f * 3.0 * d),
        acceleration: 2.0 * c + f * 6.0 * d,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(path: impl Fn(f64) -> f64) -> [Position; WINDOW] {
        [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(|t| [(path(t) * 1e6).round() as i64, 0, 0])
    }

    #[test]
    fn every_cubic_is_followed_exactly() {
        let path = |t: f64| 3.0 + t * (1.5 + t * (-0.7 + t * 0.2));
        let window = window(path);
        for f in [0.0, 0.1, 0.5, 0.9, 1.0] {
            let point = curve_point(&window, 0, f as f32);
            let exact = [
                path(f) - path(0.0),
                1.5 - 1.4 * f + 0.6 * f * f,
                -1.4 + 1.2 * f,
            ];
            for (given, exact) in [point.offset, point.rate, point.acceleration]
                .iter()
                .zip(exact)
            {
                assert!(
                    (f64::from(*given) / 1e6 - exact).abs() < 3e-6,
                    "{given} {exact}"
                );
            }
        }
    }

    #[test]
    fn nothing_steps_from_one_window_to_the_next() {
        let samples = [0, 5_000, -3_000, 40_000, 7, 90_000, -1_000].map(|s| [s, 0, 0]);
        let one = curve_point(&samples[..6].try_into().unwrap(), 0, 1.0);
        let other = curve_point(&samples[1..].try_into().unwrap(), 0, 0.0);
        let moved = (samples[3][0] - samples[2][0]) as f32;
        assert!((one.offset - (other.offset + moved)).abs() < 0.1);
        assert!((one.rate - other.rate).abs() < 0.1);
        assert!((one.acceleration - other.acceleration).abs() < 0.1);
    }

    #[test]
    fn a_stage_that_starts_starts_at_rest() {
        let samples = [0, 0, 0, 0, 0, 70_000].map(|s| [s, 0, 0]);
        assert_eq!(curve_point(&samples, 0, 0.0), CurvePoint::default());
    }
}
