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
//! On a line of many turns every orientation is met about everywhere: the bounds for any orientation (`check/pivots`) then
//! stand for them.

use kinematics::{Angle, Scalar};
use motion::check::pivots::PivotGain;
use motion::constraints::{Constraints, Speeds};
use motion::plan::Position;
use motion::plan::axis_state::PER_POSITION_UNIT;
use number::float::{FloatMinMax, hypot, i64_to_f32_fast, truncate};
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
    /// k_i, and how far the moved point lies from the platform's centre.
    offsets: [f32; 3],
    arm: f32,
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
        let (half, wide) = (0.5, f32::SIN_60);
        Self {
            from: both!(i => i64_to_f32_fast(from[i]) * PER_POSITION_UNIT),
            displacement,
            length: hypot(displacement[0], displacement[1]),
            turn: i64_to_f32_fast(turn_units) * (PER_POSITION_UNIT * core::f32::consts::TAU),
            theta: from[2],
            turn_units,
            offsets: [half * x + wide * y, -x, half * x - wide * y],
            arm: hypot(x, y),
            usable: constraints.usable_radius as f32,
        }
    }

    /// Whether the line turns so far that the pivots are not followed through each turn.
    pub fn spans_many_turns(&self) -> bool {
        self.turn_units.unsigned_abs() > FOLLOWED
    }

    /// Bounds of the first and the second derivative anywhere on a line of this kind: the place furthest out counts.
    pub fn worst(&self) -> (f32, f32) {
        let [from, to] = [self.from, self.point(1.0)].map(|[x, y]| hypot(x, y));
        self.at_any_orientation(from.fmax(to))
    }

    /// The same with the moved point this far from the track's centre.
    fn at_any_orientation(&self, radius: f32) -> (f32, f32) {
        let gain = PivotGain::new((radius + self.arm).fmin(self.usable), self.arm);
        let speeds = Speeds {
            linear: self.length,
            angular: self.turn.abs(),
        };
        (gain.rate(speeds), gain.bias_acceleration(speeds))
    }

    /// P(s).
    pub fn point(&self, s: f32) -> [f32; 2] {
        both!(i => self.from[i] + self.displacement[i] * s)
    }

    /// Cosine and sine of theta at s = 0, and of what it turns in a part of the line.
    pub fn directions(&self, part: f32) -> [[f32; 2]; 2] {
        let turn = truncate(i64_to_f32_fast(self.turn_units) * part);
        [self.theta, turn].map(|theta| {
            let (sin, cos) = sin_cos_f32(Angle::from_units(theta));
            [cos, sin]
        })
    }

    /// The demand at s, where the platform's x axis points in this direction (cosine and sine).
    pub fn demand(&self, s: f32, [cos, sin]: [f32; 2]) -> Demand {
        let point = self.point(s);
        if self.spans_many_turns() {
            let (first, second) = self.at_any_orientation(hypot(point[0], point[1]));
            return Demand {
                first: [first; 3],
                // With both signs.
                second: [second, -second, second],
            };
        }
        let (half, wide) = (0.5, f32::SIN_60);
        let directions = [
            [wide * cos + half * sin, wide * sin - half * cos],
            [-sin, cos],
            [half * sin - wide * cos, -wide * sin - half * cos],
        ];
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
}

/// Least 1 - d^2 that is divided by: a start outside the usable disk must not become a root of something negative.
const LEAST_COSINE: f32 = 1e-3;
