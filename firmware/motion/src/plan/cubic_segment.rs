//! A piece of a plan in floats, track radii, radians and seconds: the state of the motion at an instant of it.

use super::Piece;
use super::axis_state::{AxisState, PER_AXIS_UNIT, PER_POSITION_UNIT, POSITION_UNITS};
use core::f32::consts::TAU;
use kinematics::Angle;
use number::float::{i64_to_f32_fast, truncate};
use number::sin_cos_f32;

/// Position of the moved point relative to where its motion began, its velocity and acceleration; theta in rad.
#[derive(Clone, Copy, Debug, Default)]
pub struct MotionState {
    /// From where the motion began, track radii and rad.
    pub displacement: [f32; 3],
    /// The same per second.
    pub v: [f32; 3],
    /// The same per second squared.
    pub a: [f32; 3],
}

/// A piece of constant jerk from its start on.
#[derive(Clone, Copy, Debug)]
pub struct CubicSegment {
    /// x and y of where the motion began.
    pub from: [f32; 2],
    /// Theta there, a fraction of a turn, 2^-32 turns.
    pub theta: u32,
    /// The state at its start.
    pub start: MotionState,
    /// Its jerk, per second cubed.
    pub jerk: [f32; 3],
}

/// Radians of theta in what is a track radius of x and y.
const RADIANS: [f32; 3] = [1.0, 1.0, TAU];

impl MotionState {
    /// Of the axes of a plan at `hz` ticks a second, where a displacement is counted from.
    #[inline(never)]
    pub fn new(axes: &[AxisState; 3], hz: f32) -> Self {
        let (once, twice) = (PER_AXIS_UNIT * hz, PER_AXIS_UNIT * hz * hz);
        Self {
            displacement: [0.0; 3],
            v: each!(i => i64_to_f32_fast(axes[i].velocity) * (once * RADIANS[i])),
            a: each!(i => i64_to_f32_fast(axes[i].acceleration) * (twice * RADIANS[i])),
        }
    }

    /// Whether nothing moves, nor is about to.
    pub fn is_at_rest(&self) -> bool {
        self.v == [0.0; 3] && self.a == [0.0; 3]
    }

    /// A way of an axis in units of a position as track radii or rad.
    pub fn way(axis: usize, units: i64) -> f32 {
        i64_to_f32_fast(units) * (PER_POSITION_UNIT * RADIANS[axis])
    }
}

impl CubicSegment {
    /// A piece's jerk per second cubed.
    pub fn jerk(piece: &Piece, hz: f32) -> [f32; 3] {
        let thrice = PER_AXIS_UNIT * hz * hz * hz;
        each!(i => i64_to_f32_fast(piece.jerk[i]) * (thrice * RADIANS[i]))
    }

    /// Without a jerk yet, from `axes` on, at `hz` ticks a second.
    pub fn new(axes: &[AxisState; 3], hz: f32) -> Self {
        Self {
            from: both!(i => i64_to_f32_fast(axes[i].rounded()) * PER_POSITION_UNIT),
            theta: axes[2].rounded() as u32,
            start: MotionState::new(axes, hz),
            jerk: [0.0; 3],
        }
    }

    /// The state `t` seconds after its start.
    #[inline(never)]
    pub fn at(&self, t: f32) -> MotionState {
        let MotionState { displacement, v, a } = self.start;
        let j = self.jerk;
        let half = t / 2.0;
        let third = t * (1.0 / 3.0);
        MotionState {
            displacement: each!(i => displacement[i] + t * (v[i] + half * (a[i] + third * j[i]))),
            v: each!(i => v[i] + t * (a[i] + half * j[i])),
            a: each!(i => a[i] + t * j[i]),
        }
    }

    /// x and y of the moved point there.
    pub fn point(&self, sample: &MotionState) -> [f32; 2] {
        [
            self.from[0] + sample.displacement[0],
            self.from[1] + sample.displacement[1],
        ]
    }

    /// Sine and cosine of theta after a way of so many radians.
    pub fn sin_cos(&self, way: f32) -> (f32, f32) {
        const UNITS_A_RADIAN: f32 = POSITION_UNITS / TAU;
        let theta = i64::from(self.theta).wrapping_add(truncate(way * UNITS_A_RADIAN));
        sin_cos_f32(Angle::from_units(theta))
    }
}

/// Rates of the axes (2^-72 units a tick, `hz` ticks a second) as track radii and rad per second.
pub fn per_second(rates: &[i64; 3], hz: f32) -> [f32; 3] {
    let unit = PER_AXIS_UNIT * hz;
    let [x, y, theta] = each!(i => i64_to_f32_fast(rates[i]) * unit);
    [x, y, theta * TAU]
}
