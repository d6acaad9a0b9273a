//! The curve through samples, and the pieces that follow it.
//!
//! # The curve
//!
//! A cubic spline with uniform knots has a velocity and an acceleration without steps.
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
//!
//! # From knot to knot
//!
//! From a state to a given one in a given number of ticks: three pieces of constant jerk, which there is exactly one
//! way to choose.
//!
//! With `n` ticks in the first and the last piece, `m` in the middle one and `T` in all, the jerks j1, j2, j3 make up
//! what is missing when the state is left alone: in acceleration, velocity and position
//!
//! ```text
//! A =  j1 n                             + j2 m                           + j3 n
//! V =  j1 (n^2/2 + n (m + n))           + j2 (m^2/2 + m n)               + j3 n^2/2
//! P =  j1 (n^3/6 + n^2/2 (m + n) + n (m + n)^2/2) + j2 (m^3/6 + m^2/2 n + m n^2/2) + j3 n^3/6
//! ```
//!
//! What is missing is taken from the very integers that the tick will hold, so what rounding has left of the last piece
//! is made up in the next: nothing accumulates.

use motion::plan::Position;
use motion::plan::axis_state::{AxisState, JERK_STEP};

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
    let control = |k: usize| {
        let s = sample(k);
        s - (sample(k + 1) - 2.0 * s + sample(k - 1)) * (1.0 / 6.0)
    };
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

/// The three pieces' lengths, and the inverse of the equations in the module's head, with times in units of T.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    pub ticks: [u64; 3],
    whole: f32,
    inverse: [[f32; 3]; 3],
}

impl Knot {
    /// For a knot of at least three ticks.
    pub fn new(ticks: u32) -> Self {
        let first = ((ticks + 1) / 3).max(1);
        let middle = (ticks - 2 * first).max(1);
        let whole = (2 * first + middle) as f32;
        let (n, m) = (first as f32 / whole, middle as f32 / whole);
        let rest = m + n;
        Self {
            ticks: [first, middle, first].map(u64::from),
            whole,
            inverse: inverse([
                [n, m, n],
                [n * n / 2.0 + n * rest, m * m / 2.0 + m * n, n * n / 2.0],
                [
                    n * n * n / 6.0 + n * n / 2.0 * rest + n * rest * rest / 2.0,
                    m * m * m / 6.0 + m * m / 2.0 * n + m * n * n / 2.0,
                    n * n * n / 6.0,
                ],
            ]),
        }
    }

    /// Ticks of the three together.
    pub fn whole(&self) -> u64 {
        self.ticks[0] + self.ticks[1] + self.ticks[2]
    }

    /// The jerks that lead from `from` to `to`, of which the position may be off by what half a jerk step makes.
    #[inline(never)]
    pub fn jerks(&self, from: &AxisState, to: &AxisState) -> [i64; 3] {
        let alone = from.after(self.whole(), 0, 0);
        let t = self.whole;
        let missing = [
            to.acceleration.wrapping_sub(alone.acceleration) as f32 / t,
            to.velocity.wrapping_sub(alone.velocity) as f32 / (t * t),
            narrow(to.position.wrapping_sub(alone.position)) / (t * t * t),
        ];
        each!(k => {
            let row = self.inverse[k];
            let jerk = row[0] * missing[0] + row[1] * missing[1] + row[2] * missing[2];
            (jerk * (1.0 / JERK_STEP as f32)) as i64 * JERK_STEP
        })
    }
}

/// A difference of positions as a float. It is small; where not, the motion is refused for its speed.
fn narrow(difference: i128) -> f32 {
    const CUT: u32 = 24;
    ((difference >> CUT) as i64) as f32 * (1_u32 << CUT) as f32
}

/// The inverse of a matrix.
fn inverse(m: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let minor = |r: usize, c: usize| {
        let at = |i: usize, j: usize| m[(r + 1 + i) % 3][(c + 1 + j) % 3];
        at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0)
    };
    let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    each!(r => each!(c => minor(c, r) / determinant))
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

#[cfg(test)]
mod knot_tests {
    use super::*;

    #[test]
    fn three_pieces_arrive() {
        let from = AxisState {
            position: 5 << 60,
            velocity: 3 << 40,
            acceleration: -(6 << 30),
        };
        for ticks in [3, 4, 5, 10, 50, 200, 2_000] {
            let knot = Knot::new(ticks);
            assert_eq!(knot.whole(), u64::from(ticks));
            let t = i64::from(ticks);
            let to = AxisState {
                position: from.position + i128::from(t * (7 << 39)),
                velocity: -(2 << 40),
                acceleration: 6 << 31,
            };
            let mut axis = from;
            for (jerk, ticks) in knot.jerks(&from, &to).into_iter().zip(knot.ticks) {
                axis = axis.after(ticks, jerk, 0);
            }
            // Against what there was to change.
            let off = (axis.position - to.position) as f64 / (t * (1 << 41)) as f64;
            assert!(off.abs() < 1e-5, "{ticks}: {off:e}");
            let off = (axis.velocity - to.velocity) as f64 / f64::from(5 << 20) / 1_048_576.0;
            assert!(off.abs() < 1e-5, "{ticks}: {off:e}");
        }
    }
}
