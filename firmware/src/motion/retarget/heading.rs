//! A frame for a transition: one axis along the way to go, one across it. What is under way across is braked, once,
//! while the axis along goes on; the frame is turned such that the target is ahead when that is done.
//!
//! It turns integers by integers (30 fraction bits), so that turning there and back leaves 1e-9 of them.

use crate::motion::plan::axis_state::{AxisState, JERK_STEP};
use crate::motion::plan::{Piece, Pieces, Position};
use crate::motion::profile::tracks::AxisWay;
use crate::number::float::{hypot, i64_to_f32_fast, i128_to_f32_fast};

/// Direction of the axis along, 2^-30.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Heading {
    cos: i32,
    sin: i32,
}

/// What is under way and what is to go in x and y, 2^-72 track radii and ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub way: [f32; 2],
    pub v: [f32; 2],
    pub a: [f32; 2],
}

/// What is no motion across: 2^-31 track radii of way, 2^-44 track radii a tick of the velocity that rounding leaves.
const STILL_WAY: i128 = 1 << 41;
const STILL_RATE: u64 = 1 << 28;
const POINT: u32 = 30;
/// 2^-64.
pub(super) const SMALLER: f32 = 5.421_011e-20;
/// Bits of a way that a turn does without: 2^-52 track radii.
const WAY_CUT: u32 = 20;

impl Plane {
    pub fn new(state: &[AxisState; 3], to: &Position) -> Self {
        Self {
            way: [0, 1].map(|i| i128_to_f32_fast(target(to[i]) - state[i].position)),
            v: [0, 1].map(|i| i64_to_f32_fast(state[i].velocity)),
            a: [0, 1].map(|i| i64_to_f32_fast(state[i].acceleration)),
        }
    }

    /// Velocity once the acceleration is released at this jerk.
    pub fn released(&self, jerk: f32) -> [f32; 2] {
        let seconds = hypot(self.a[0], self.a[1]) / (2.0 * jerk);
        [0, 1].map(|i| self.v[i] + self.a[i] * seconds)
    }
}

impl Heading {
    /// Along a vector; along x for one of no length.
    #[inline(never)]
    pub fn new(x: f32, y: f32) -> Self {
        const ONE: i64 = 1 << POINT;
        // Squares of 2^-72 track radii are beyond a float.
        let (x, y) = (x * SMALLER, y * SMALLER);
        let length = hypot(x, y);
        if !(length > 0.0) {
            return Self {
                cos: 1 << POINT,
                sin: 0,
            };
        }
        let scale = (1 << POINT) as f32 / length;
        let [cos, sin] = [x, y].map(|part| i64::from((part * scale) as i32));
        // Floats leave 1e-7 of length, half of which is taken off each.
        let long = (cos * cos + sin * sin - ONE * ONE) >> (POINT + 1);
        let exact = |value: i64| (value - ((value * long) >> POINT)) as i32;
        Self {
            cos: exact(cos),
            sin: exact(sin),
        }
    }

    /// From where the axis across comes to rest after what `gains` makes of velocity and acceleration, to the target.
    pub fn after(plane: &Plane, gains: [f32; 2]) -> Self {
        let [x, y] = [0, 1].map(|i| plane.way[i] - gains[0] * plane.v[i] - gains[1] * plane.a[i]);
        Self::new(x, y)
    }

    /// A vector along and across, in floats.
    pub fn seen(&self, vector: &[f32; 2]) -> [f32; 2] {
        let [cos, sin] = self.floats();
        let [x, y] = vector;
        [cos * x + sin * y, cos * y - sin * x]
    }

    fn floats(&self) -> [f32; 2] {
        const UNIT: f32 = 1.0 / (1 << POINT) as f32;
        [self.cos as f32 * UNIT, self.sin as f32 * UNIT]
    }

    /// The axes along, across and theta, with their ways to the target.
    pub fn view(&self, state: &[AxisState; 3], to: &Position) -> [AxisWay; 3] {
        let [x, y, theta] = [0, 1, 2].map(|i| (state[i], target(to[i]) - state[i].position));
        let seen = |x: i64, y: i64| {
            [
                product(x, self.cos) + product(y, self.sin),
                product(y, self.cos) - product(x, self.sin),
            ]
        };
        let way = seen((x.1 >> WAY_CUT) as i64, (y.1 >> WAY_CUT) as i64)
            .map(|way| i128::from(way) << WAY_CUT);
        let velocity = seen(x.0.velocity, y.0.velocity);
        let acceleration = seen(x.0.acceleration, y.0.acceleration);
        let axis = |i: usize| {
            let axis = AxisState {
                position: 0,
                velocity: velocity[i],
                acceleration: acceleration[i] & !1,
            };
            (axis, way[i])
        };
        let still = way[1].unsigned_abs() < STILL_WAY as u128
            && velocity[1].unsigned_abs() < STILL_RATE
            && acceleration[1].unsigned_abs() < STILL_RATE;
        let across = if still { Default::default() } else { axis(1) };
        [axis(0), across, theta]
    }

    /// Turns the jerks back to x and y, which start with the accelerations `from` where `view` has its own. Each takes
    /// up what the rounding of the one before left of the acceleration.
    pub fn turn_back(&self, pieces: &mut Pieces, view: [i64; 2], from: [i64; 2]) {
        let turned = self.turned(view);
        let mut rest = [turned[0] - from[0], turned[1] - from[1]];
        for Piece { ticks, jerk } in pieces {
            let turned = self.turned([jerk[0], jerk[1]]);
            let n = *ticks as i64;
            for i in 0..2 {
                let wanted = turned[i] + carried(rest[i], *ticks);
                jerk[i] = stepped_down(wanted);
                rest[i] = rest[i].wrapping_add((turned[i] - jerk[i]).wrapping_mul(n));
            }
        }
    }
}

impl Heading {
    /// A vector along and across, as x and y.
    fn turned(&self, [along, across]: [i64; 2]) -> [i64; 2] {
        [
            product(along, self.cos) - product(across, self.sin),
            product(across, self.cos) + product(along, self.sin),
        ]
    }
}

/// A position in the units of an axis.
pub(crate) fn target(units: i64) -> i128 {
    i128::from(units) << crate::motion::plan::axis_state::SUB_BITS
}

/// `value` times a factor of 2^-30.
fn product(value: i64, factor: i32) -> i64 {
    let (high, low) = (value >> 32, value & 0xFFFF_FFFF);
    let factor = i64::from(factor);
    ((high * factor) << (32 - POINT)) + ((low * factor) >> POINT)
}

/// What a tick of so many takes of an acceleration's rest; in 32 bits, where the chip divides.
fn carried(rest: i64, ticks: u64) -> i64 {
    match (i32::try_from(rest), i32::try_from(ticks)) {
        (Ok(rest), Ok(ticks)) if ticks > 0 => i64::from(rest / ticks),
        _ => 0,
    }
}

/// The nearest multiple of [`JERK_STEP`], up or down.
fn stepped_down(jerk: i64) -> i64 {
    const HALF: i64 = JERK_STEP / 2;
    let from = jerk.wrapping_add(HALF);
    let half = from >> 1;
    // 2^32 is 1 more than a multiple of 3.
    let thirds = (half as u32 % 3) as i64 + ((half >> 32) as i32).rem_euclid(3) as i64;
    (half - thirds % 3) * 2
}

#[cfg(test)]
mod tests {
    use crate::motion::retarget::heading::*;
    use crate::motion::{SUB_BITS, plan::MAX_PIECES};
    use heapless::Vec;

    #[test]
    fn steps_are_the_nearest_multiples_of_six() {
        for k in -40_i64..40 {
            for base in [0_i64, 6 << 33, -(6 << 40), 6 << 58] {
                let stepped = stepped_down(base + k);
                assert_eq!(stepped % JERK_STEP, 0, "{base} {k}");
                assert!((stepped - base - k).abs() <= 3, "{base} {k} {stepped}");
            }
        }
    }

    #[test]
    fn turning_there_and_back_leaves_a_thousand_millionth() {
        let state = |v: i64, a: i64| AxisState {
            position: 5 << 70,
            velocity: v,
            acceleration: a,
        };
        for k in 0..100 {
            let angle = k as f32 * 0.063;
            let heading = Heading::new(angle.cos() * 3e20, angle.sin() * 3e20);
            let (v, a) = ([1 << 59, -3 << 57], [6 << 45, 6 << 44]);
            let state = [state(v[0], a[0]), state(v[1], a[1]), AxisState::default()];
            let view = heading.view(&state, &[3 << 31, -(1 << 30), 0]);
            let back = heading.turned([view[0].0.velocity, view[1].0.velocity]);
            for i in 0..2 {
                let off = (back[i] - v[i]).unsigned_abs();
                assert!(off < 1 << 31, "{angle} {i} {off}");
            }
        }
    }

    #[test]
    fn the_target_is_ahead_when_the_motion_across_is_braked() {
        let plane = Plane {
            way: [3e20, 1e20],
            v: [0.0, 5e16],
            a: [0.0, 2e13],
        };
        let gains = [300.0, 40_000.0];
        let heading = Heading::after(&plane, gains);
        let across = |vector: &[f32; 2]| heading.seen(vector)[1];
        let left = across(&plane.way) - gains[0] * across(&plane.v) - gains[1] * across(&plane.a);
        assert!(left.abs() < 1e-6 * 3e20, "{left}");
        assert!(heading.seen(&plane.way)[0] > 0.0);
    }

    #[test]
    fn turned_jerks_leave_no_acceleration() {
        let heading = Heading::new(0.3, 0.7);
        let mut pieces: Vec<Piece, MAX_PIECES> = Vec::new();
        for (ticks, jerk) in [
            (200, 6_000_006),
            (1_000, 0),
            (200, -6_000_006),
            (50_000, 0),
            (7, -600),
            (7, 600),
        ] {
            let piece = Piece {
                ticks,
                jerk: [jerk, -jerk * 3, 0],
            };
            pieces.push(piece).unwrap();
        }
        heading.turn_back(&mut pieces, [0; 2], [0; 2]);
        let mut left = [0_i64; 2];
        for piece in &pieces {
            for (left, jerk) in left.iter_mut().zip(piece.jerk) {
                assert_eq!(jerk % JERK_STEP, 0);
                *left += jerk * piece.ticks as i64;
            }
        }
        assert!(left.iter().all(|left| left.abs() < 6 * 200), "{left:?}");
        assert_eq!(SUB_BITS, 40);
    }
}
