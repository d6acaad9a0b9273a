//! A straight line as the pivots see it.
//!
//! The moved point goes `P(s) = P(0) + L s`, the platform turns `theta(s) = theta(0) + T s`, s from 0 to 1. With the
//! guide's direction `u = (cos theta_i, sin theta_i)`, `n` a quarter turn on from it and `k_i` the distance of guide
//! line i from the moved point (constant: both are fixed in the platform; 0 when it is the platform centre),
//! `d_i = n.P - k_i` and
//!
//! ```text
//! d_i' = n.L - T u.P          d_i'' = -2 T u.L - T^2 n.P          c_i = sqrt(1 - d_i^2)
//! phi_i' = T + d_i' / c_i     phi_i'' = (d_i'' + (d_i' / c_i)^2 d_i) / c_i
//! ```
//!
//! are derivatives by s. A motion s(t) then asks pivot i for the rate `phi_i' s'` and the acceleration
//! `phi_i' s'' + phi_i'' s'^2`.
//!
//! On a line of many turns every orientation is met about everywhere. The largest of the above over all orientations
//! then stands for them. With `r = |P|`, K the largest `|k_i|`, and the line's way as seen from the track's centre,
//! `L_r` outwards and `L_t` around: n goes all round, `n.L - T u.P = n.(L - T E P)` with E the quarter turn, whose part
//! around is `L_t - T r`. Of it `cos a / sqrt(1 - (r sin a + K)^2)` is passed on at most, largest where `x = sin a`
//! solves `r K x^2 - (1 - r^2 - K^2) x + r K = 0`; of `L_r`, `1 / sqrt(1 - (r + K)^2)`.

use kinematics::{Angle, Scalar};
use motion::constraints::Constraints;
use motion::plan::Position;
use motion::plan::axis_state::PER_POSITION_UNIT;
use number::float::{FloatMinMax, i64_to_f32_fast};
use number::{sin_cos_f32, sqrt_f32};

/// Turns (2^-32) up to which the pivots are followed through each of them.
const FOLLOWED: u64 = 3 << 32;

/// A line; see the module. Lengths in track radii, angles in rad.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// P(0).
    pub from: [f32; 2],
    /// L.
    pub displacement: [f32; 2],
    /// |L|.
    pub length: f32,
    /// T.
    pub turn: f32,
    /// theta(0) in 2^-32 turns.
    theta: i64,
    /// T in 2^-32 turns.
    turn_units: i64,
    /// k_i.
    offsets: [f32; 3],
    /// Radius of the disk that the platform centre keeps to: no `d_i` is larger.
    usable: f32,
}

/// What a place on the line asks of the pivots: the derivatives of each by s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Demand {
    /// phi_i'.
    pub first: [f32; 3],
    /// phi_i''.
    pub second: [f32; 3],
}

impl Path {
    #[inline(never)]
    pub fn new(from: &Position, to: &Position, constraints: &Constraints) -> Self {
        let displacement =
            both!(i => i64_to_f32_fast(to[i].wrapping_sub(from[i])) * PER_POSITION_UNIT);
        let turn_units = to[2].wrapping_sub(from[2]);
        let [x, y] = constraints.centre();
        // n_i of the platform's own axes: its guides point at -30, 90 and 210 deg.
        let half = 0.5;
        let wide = f32::SIN_60;
        Self {
            from: both!(i => i64_to_f32_fast(from[i]) * PER_POSITION_UNIT),
            displacement,
            length: sqrt_f32(displacement[0] * displacement[0] + displacement[1] * displacement[1]),
            turn: i64_to_f32_fast(turn_units) * (PER_POSITION_UNIT * core::f32::consts::TAU),
            theta: from[2],
            turn_units,
            offsets: [half * x + wide * y, -x, half * x - wide * y],
            usable: constraints.usable_radius as f32,
        }
    }

    /// Whether the line turns so far that the pivots are not followed through each turn.
    pub fn spans_many_turns(&self) -> bool {
        self.turn_units.unsigned_abs() > FOLLOWED
    }

    /// Bounds of the first and the second derivative anywhere on a line of this kind: the place furthest out counts.
    pub fn worst(&self) -> (f32, f32) {
        let [from, to] = [self.from, self.point(1.0)].map(|[x, y]| sqrt_f32(x * x + y * y));
        let furthest = from.fmax(to);
        let r = (furthest + self.offset()).fmin(self.usable);
        let over_c = 1.0 / sqrt_f32((1.0 - r * r).fmax(LEAST_COSINE));
        let turn = self.turn.abs();
        let relative_rate = if self.offset() > 0.0 {
            (self.length + turn * furthest) * over_c
        } else {
            self.length * over_c + turn * furthest
        };
        let d_2 = turn * (2.0 * self.length + turn * furthest);
        (
            turn + relative_rate,
            (d_2 + relative_rate * relative_rate * r) * over_c,
        )
    }

    /// K.
    fn offset(&self) -> f32 {
        self.offsets
            .iter()
            .fold(0.0, |k, offset| k.fmax(offset.abs()))
    }

    /// P(s).
    pub fn point(&self, s: f32) -> [f32; 2] {
        both!(i => self.from[i] + self.displacement[i] * s)
    }

    /// The demands at places evenly spaced, from s = 0 on, with so many intervals in all.
    pub fn demands(&self, intervals: usize) -> Demands<'_> {
        let step = 1.0 / intervals as f32;
        // A direction is worth nothing on a line that is of many turns, and not looked at.
        let turn = (i64_to_f32_fast(self.turn_units) * step) as i32;
        Demands {
            path: self,
            s: 0.0,
            step,
            direction: direction(self.theta),
            turn: direction(i64::from(turn)),
        }
    }

    /// The demand at s, by sine and cosine of theta there.
    #[cfg(test)]
    pub fn at(&self, s: f32) -> Demand {
        if self.spans_many_turns() {
            return self.demand_of_any_orientation(s);
        }
        let turned = (self.turn_units as f64 * f64::from(s)) as i64;
        self.demand(s, direction(self.theta + turned))
    }

    /// The demand at s, where the platform's x axis points in this direction (cosine and sine).
    fn demand(&self, s: f32, [cos, sin]: [f32; 2]) -> Demand {
        let (half, wide) = (0.5, f32::SIN_60);
        let directions = [
            [wide * cos + half * sin, wide * sin - half * cos],
            [-sin, cos],
            [half * sin - wide * cos, -wide * sin - half * cos],
        ];
        let point = self.point(s);
        let pivots = each!(i => self.pivot(&point, &directions[i], self.offsets[i]));
        Demand {
            first: each!(i => pivots[i].0),
            second: each!(i => pivots[i].1),
        }
    }

    /// phi' and phi'' of the pivot on the guide of direction `u`.
    #[inline]
    fn pivot(&self, [x, y]: &[f32; 2], [cos, sin]: &[f32; 2], offset: f32) -> (f32, f32) {
        let [way_x, way_y] = self.displacement;
        let turn = self.turn;
        let across = y * cos - x * sin;
        let d = across - offset;
        let d_1 = way_y * cos - way_x * sin - turn * (x * cos + y * sin);
        let d_2 = -turn * (2.0 * (way_x * cos + way_y * sin) + turn * across);
        let over_c = 1.0 / sqrt_f32((1.0 - d * d).fmax(LEAST_COSINE));
        let relative_rate = d_1 * over_c;
        (
            turn + relative_rate,
            (d_2 + relative_rate * relative_rate * d) * over_c,
        )
    }

    /// The largest demand of any orientation; with both signs of the second derivative.
    fn demand_of_any_orientation(&self, s: f32) -> Demand {
        let [x, y] = self.point(s);
        let [way_x, way_y] = self.displacement;
        let square = x * x + y * y;
        let r = sqrt_f32(square);
        let k = self.offset();
        let over_r = if r > 0.0 { 1.0 / r } else { 0.0 };
        let outwards = (way_x * x + way_y * y) * over_r;
        let outwards = if r > 0.0 { outwards } else { self.length };
        let around = (way_y * x - way_x * y) * over_r - self.turn * r;
        let (rk, b) = (r * k, 1.0 - square - k * k);
        let mut sine = 2.0 * rk / (b + sqrt_f32((b * b - 4.0 * rk * rk).fmax(0.0)));
        if !(b > 0.0 && r * sine + k <= self.usable) {
            // Only orientations that keep to the disk are met here: the best of them is the last.
            sine = (self.usable - k) * over_r;
        }
        let d = r * sine + k;
        let passed = sqrt_f32(((1.0 - sine * sine) / (1.0 - d * d).fmax(LEAST_COSINE)).fmax(0.0));
        let furthest = (r + k).fmin(self.usable);
        let over_c = 1.0 / sqrt_f32((1.0 - furthest * furthest).fmax(LEAST_COSINE));
        let relative_rate = around.abs() * passed + outwards.abs() * over_c;
        let turn = self.turn.abs();
        let d_2 = turn * (2.0 * self.length + turn * r);
        // Of a guide through the moved point the two parts of phi'' oppose each other.
        let squared_rate = relative_rate * relative_rate * furthest;
        let either = if k > 0.0 {
            d_2 + squared_rate
        } else {
            d_2.fmax(squared_rate)
        };
        let (first, second) = (turn + relative_rate, either * over_c);
        Demand {
            first: [first; 3],
            second: [second, -second, second],
        }
    }
}

/// Cosine and sine of an angle in 2^-32 turns.
fn direction(theta: i64) -> [f32; 2] {
    let (sin, cos) = sin_cos_f32(Angle::from_units(theta));
    [cos, sin]
}

/// Demands along a line; see [`Path::demands`].
pub(super) struct Demands<'a> {
    path: &'a Path,
    s: f32,
    step: f32,
    /// Cosine and sine of theta, and of what it turns from place to place: turned by a product, which is a fourth of
    /// what sine and cosine cost, and off by some 1e-7 a place.
    direction: [f32; 2],
    turn: [f32; 2],
}

impl Demands<'_> {
    /// The demand at the next place.
    pub fn next(&mut self) -> Demand {
        let path = self.path;
        let demand = if path.spans_many_turns() {
            path.demand_of_any_orientation(self.s)
        } else {
            path.demand(self.s, self.direction)
        };
        let ([cos, sin], [a, b]) = (self.direction, self.turn);
        self.direction = [cos * a - sin * b, sin * a + cos * b];
        self.s += self.step;
        demand
    }
}

/// Least 1 - d^2 that is divided by: a start outside the usable disk must not become a root of something negative.
const LEAST_COSINE: f32 = 1e-3;
