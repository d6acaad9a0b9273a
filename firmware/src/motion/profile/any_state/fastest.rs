//! The fastest main part, by cases; see the module above. Distances count from the fastest stop.

use super::start::{Main, ProfileStart};
use super::state::{State, peak};
use crate::number::float::Float;

/// Rounds of the solutions; a few are needed.
const MOST_ROUNDS: usize = 40;

impl<F: Float> ProfileStart<F> {
    pub fn fastest(&self) -> Main<F> {
        let mut beyond = self.beyond;
        if self.state.a < F::ZERO && self.v_z > F::ZERO {
            let full = -self.state.a;
            // What case A can add to the stop: by releasing the brake wholly.
            let most = self.partly(F::ZERO).0 - self.partly(full).0;
            if beyond < most {
                return self.released_in_part(beyond + self.partly(full).0, full);
            }
            beyond = beyond - most;
        }
        let touching = Touching::new(self);
        let s = (self.limits.v - self.v_s).max(F::ZERO).root();
        let full = (s - touching.least).max(F::ZERO);
        let longest = touching.way(full).0;
        if beyond >= longest {
            let hold = (beyond - longest) / self.limits.v;
            return cruising(&self.state, s.square(), self.limits.v, hold, self.limits.a);
        }
        let more = touching.solve(beyond, full);
        let s = touching.least + more;
        cruising(
            &self.state,
            s.square(),
            touching.top(more),
            F::ZERO,
            self.limits.a,
        )
    }

    /// Case A: `way` of braking virtually begun from `w = v_z + q^2`, with its derivative over `q`, but for a constant.
    /// With `r = sqrt(w)` and `g = r - q = v_z / (r + q)`, `w / 2 T(w) - q (2 v_z + q^2)` is `g (g^2 + g q - q^2)`;
    /// over the limit of acceleration it is `(v_z (v_z + 2 q^2 + A^2 - 4 q A) + q^2 (A - q)^2) / (2 A)`.
    fn partly(&self, q: F) -> (F, F) {
        let (v_z, most) = (self.v_z, self.limits.a);
        let w = v_z + q.square();
        if w <= most.square() {
            let r = w.root();
            let g = v_z / (r + q);
            return (g * (g.square() + g * q - q.square()), -(g * (r + g)));
        }
        let two = F::from_f64(2.0);
        let room = q * (most - q);
        let way =
            v_z * (v_z + two * q.square() + most * (most - F::from_f64(4.0) * q)) + room.square();
        let slope = two * (v_z * (q - most) * two + room * (most - two * q));
        (way / (most + most), slope / (most + most))
    }

    fn released_in_part(&self, way: F, full: F) -> Main<F> {
        // Falling: its negative grows.
        let q = newton(F::ZERO, full, full.half(), |q| {
            let (value, slope) = self.partly(q);
            (way - value, -slope)
        });
        let (down, hold) = peak(self.v_z + q.square(), self.limits.a);
        let none = F::ZERO;
        Main {
            t: [full - q, none, none, none, (down - q).max(none), hold, down],
            first: F::ONE,
            top: self.v_z,
            released_in_part: true,
        }
    }
}

/// From `state` up to a speed `u` above the virtual start's, `top`; that for `hold`; and down to rest.
pub(super) fn cruising<F: Float>(state: &State<F>, u: F, top: F, hold: F, most: F) -> Main<F> {
    let (up, up_hold) = peak(u, most);
    let (down, down_hold) = peak(top, most);
    let release = (up - state.a).max(F::ZERO);
    Main {
        t: [release, up_hold, up, hold, down, down_hold, down],
        first: F::ONE,
        top,
        released_in_part: false,
    }
}

/// Case B: the root `s` of the speed gained from the virtual start, as what it is `more` than the `least`, at which the
/// way is that of the fastest stop (or of case A's most).
struct Touching<F> {
    v_s: F,
    most: F,
    least: F,
    /// Top speed at `least`, and the way from it to rest.
    base: F,
    base_way: F,
}

impl<F: Float> Touching<F> {
    fn new(start: &ProfileStart<F>) -> Self {
        let least = if start.v_z > F::ZERO {
            start.state.a.max(F::ZERO)
        } else {
            (-start.v_s).max(F::ZERO).root()
        };
        let base = start.v_z.max(F::ZERO);
        Self {
            v_s: start.v_s,
            most: start.limits.a,
            least,
            base,
            base_way: down(base, start.limits.a).0,
        }
    }

    fn top(&self, more: F) -> F {
        self.base + more * (self.least + self.least + more)
    }

    /// The way beyond that of `least`, and its derivative. Each ramp's is taken as a product with `more`, not as a
    /// difference.
    fn way(&self, more: F) -> (F, F) {
        let (low, s) = (self.least, self.least + more);
        let (up, up_slope) = if s <= self.most {
            (self.by_jerk(low, s), self.jerk_slope(s))
        } else if low >= self.most {
            (self.at_peak(low, s), self.peak_slope(s))
        } else {
            (
                self.by_jerk(low, self.most) + self.at_peak(self.most, s),
                self.peak_slope(s),
            )
        };
        let (down, slope) = down(self.top(more), self.most);
        (up + (down - self.base_way), up_slope + (s + s) * slope)
    }

    /// `(2 v_s + s^2) s` from `low` to `s`, and its derivative.
    fn by_jerk(&self, low: F, s: F) -> F {
        (s - low) * (self.v_s + self.v_s + s.square() + s * low + low.square())
    }

    fn jerk_slope(&self, s: F) -> F {
        self.v_s + self.v_s + F::from_f64(3.0) * s.square()
    }

    /// `(v_s + s^2 / 2) (s^2 / A + A)` from `low` to `s`, and its derivative.
    fn at_peak(&self, low: F, s: F) -> F {
        let sum = s.square() + low.square();
        (s - low) * (s + low) * ((self.v_s + sum.half()) / self.most + self.most.half())
    }

    fn peak_slope(&self, s: F) -> F {
        (s + s) * ((self.v_s + s.square()) / self.most + self.most.half())
    }

    fn solve(&self, beyond: F, full: F) -> F {
        // Exact from rest.
        let most = self.most;
        let from_rest = if beyond <= F::from_f64(2.0) * most.square() * most {
            beyond.half().cbrt_estimate().square()
        } else {
            let root = (most.square() + F::from_f64(4.0) * beyond / most).root();
            most.half() * (root - most)
        };
        let guess = (from_rest - self.v_s).max(F::ZERO).root() - self.least;
        newton(F::ZERO, full, guess, |more| {
            let (way, slope) = self.way(more);
            (way - beyond, slope)
        })
    }
}

/// Distance of the ramp from speed `u` to rest, and its derivative.
fn down<F: Float>(u: F, most: F) -> (F, F) {
    if u <= most.square() {
        let root = u.max(F::ZERO).root();
        (u * root, F::from_f64(1.5) * root)
    } else {
        let held = u / most;
        (u.half() * (held + most), held + most.half())
    }
}

/// The zero of a growing function between `low` and `high`: Newton's method, bisection where that leaves the bracket.
fn newton<F: Float>(mut low: F, mut high: F, guess: F, f: impl Fn(F) -> (F, F)) -> F {
    let mut x = guess.max(low).min(high.max(low));
    for _ in 0..MOST_ROUNDS {
        let (value, slope) = f(x);
        if value > F::ZERO {
            high = x;
        } else if value < F::ZERO {
            low = x;
        } else {
            return x;
        }
        let next = x - value / slope;
        let inside = next > low && next < high;
        let next = if inside { next } else { (low + high).half() };
        if (next - x).abs() <= F::from_f64(2.0) * F::EPSILON * next.abs() {
            return next;
        }
        x = next;
    }
    x
}
