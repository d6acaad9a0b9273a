//! Whether a curved plan keeps to the workspace and to the limits that couple the axes, at every tick.
//!
//! Over a stretch of a piece, bounds are taken that need its two ends only: position lies no further out than the further end
//! plus `a T^2 / 8` (the most an arc of acceleration `a` rises over its chord), each speed is greatest at an end or where its
//! acceleration passes zero, acceleration is greatest at an end. A stretch that fails is halved, down to one tick.
//! Single precision is enough for that: it is off by less than 1e-7 track radii (10 nm).

use super::axis::Axis;
use super::limits::Limits;
use super::plan::{Piece, Plan};
use kinematics::{Geometry, worst_rate_per_rotation, worst_rate_per_speed};

/// Smallest and largest x, and y, 2^-32 track radii.
pub type Bounds = [[i64; 2]; 2];

/// What a plan is held against.
pub(super) struct Envelope {
    radius: f32,
    bounds: [[f32; 2]; 2],
    /// Of translation, track radii per second (squared, cubed), and of rotation, turns.
    speed: [f32; 2],
    acceleration: [f32; 2],
    jerk: [f32; 2],
    /// Turns per second.
    pivots: f32,
    hz: f32,
}

/// Slack of single precision.
const SLACK: f32 = 1.0 + 1e-4;
/// 0.02 um on the reference stage.
const RIM: f32 = 2e-7;
/// Stretches that may be looked at, failed ones included.
const MOST_STRETCHES: usize = 2_000;

/// Position in track radii, velocity and acceleration per second, of x, y and theta (turns; its position is not needed).
struct State {
    p: [f32; 2],
    v: [f32; 3],
    a: [f32; 3],
}

impl Envelope {
    /// The envelope of `limits`, or of the state at the start where that lies outside: it may have been planned with other
    /// limits, and can only be left.
    pub fn new(limits: &Limits, geometry: &Geometry, bounds: &Bounds, start: &[Axis; 3]) -> Self {
        let mm = geometry.radius_mm;
        let pair = |translation: f64, rotation_deg: f64| {
            [(translation / mm) as f32, (rotation_deg / 360.0) as f32]
        };
        let hz = limits.rate_hz as f32;
        let state = State::new(start, hz);
        let wider = |limit: [f32; 2], now: [f32; 3]| {
            [
                limit[0].max(hypot(now[0], now[1])),
                limit[1].max(now[2].abs()),
            ]
        };
        let speed = wider(pair(limits.speed_mm_s, limits.turn_speed_deg_s), state.v);
        let acceleration = pair(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2);
        Self {
            radius: geometry.usable_radius() as f32,
            bounds: [0, 1].map(|i| bounds[i].map(|units| units as f32 / UNITS)),
            speed,
            acceleration: wider(acceleration, state.a),
            jerk: pair(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
            pivots: limits.pivot_rate_rad_s as f32,
            hz,
        }
    }

    /// Whether `plan`, from `start`, stays inside.
    pub fn holds(&self, plan: &Plan, start: &[Axis; 3]) -> bool {
        let mut axes = *start;
        let mut looked = 0;
        for piece in &plan.pieces {
            if !self.jerk_holds(piece) {
                return false;
            }
            let mut left = piece.ticks;
            let mut ticks = left;
            while left > 0 {
                ticks = ticks.min(left);
                let end = after(&axes, ticks, piece, plan);
                looked += 1;
                if self.stretch_holds(&axes, &end, ticks) {
                    axes = end;
                    left -= ticks;
                    ticks *= 2;
                } else if ticks == 1 || looked > MOST_STRETCHES {
                    return false;
                } else {
                    ticks /= 2;
                }
            }
        }
        true
    }

    fn jerk_holds(&self, piece: &Piece) -> bool {
        let per_second = self.hz * self.hz * self.hz * PER_UNIT;
        let [x, y, theta] = piece.jerk.map(|jerk| jerk as f32 * per_second);
        hypot(x, y) <= self.jerk[0] * SLACK && theta.abs() <= self.jerk[1] * SLACK
    }

    fn stretch_holds(&self, from: &[Axis; 3], to: &[Axis; 3], ticks: u64) -> bool {
        let (from, to) = (State::new(from, self.hz), State::new(to, self.hz));
        let force = from.force().max(to.force());
        let turn_force = from.a[2].abs().max(to.a[2].abs());
        if force > self.acceleration[0] * SLACK || turn_force > self.acceleration[1] * SLACK {
            return false;
        }
        let seconds = ticks as f32 / self.hz;
        let rise = force * seconds * seconds / 8.0;
        let furthest = hypot(from.p[0], from.p[1]).max(hypot(to.p[0], to.p[1])) + rise;
        if furthest > self.radius + RIM {
            return false;
        }
        for i in 0..2 {
            let [low, high] = self.bounds[i];
            if from.p[i].min(to.p[i]) - rise < low - RIM
                || from.p[i].max(to.p[i]) + rise > high + RIM
            {
                return false;
            }
        }
        let [x, y, turn] = [0, 1, 2].map(|i| fastest(&from, &to, i, seconds));
        let speed = hypot(x, y);
        if speed > self.speed[0] * SLACK || turn > self.speed[1] * SLACK {
            return false;
        }
        let furthest = f64::from(furthest);
        let pivots = speed * worst_rate_per_speed(furthest) as f32
            + turn * core::f32::consts::TAU * worst_rate_per_rotation(furthest) as f32;
        pivots <= self.pivots * SLACK
    }
}

fn after(axes: &[Axis; 3], ticks: u64, piece: &Piece, plan: &Plan) -> [Axis; 3] {
    [0, 1, 2].map(|i| axes[i].after(ticks, piece.jerk[i], plan.nudge[i]))
}

/// Largest speed of an axis between two states of the same jerk.
fn fastest(from: &State, to: &State, i: usize, seconds: f32) -> f32 {
    let ends = from.v[i].abs().max(to.v[i].abs());
    let (a, b) = (from.a[i], to.a[i]);
    if a * b >= 0.0 {
        return ends;
    }
    // Acceleration passes zero after this part of the stretch.
    let part = a / (a - b);
    ends.max((from.v[i] + a * part * seconds / 2.0).abs())
}

/// 2^32 and 2^-72.
const UNITS: f32 = 4_294_967_296.0;
const PER_UNIT: f32 = 1.0 / 4_722_366_482_869_645_213_696.0;

impl State {
    fn new(axes: &[Axis; 3], hz: f32) -> Self {
        let position = |axis: &Axis| axis.rounded() as f32 / UNITS;
        Self {
            p: [position(&axes[0]), position(&axes[1])],
            v: axes.map(|axis| axis.velocity as f32 * (PER_UNIT * hz)),
            a: axes.map(|axis| axis.acceleration as f32 * (PER_UNIT * hz * hz)),
        }
    }

    fn force(&self) -> f32 {
        hypot(self.a[0], self.a[1])
    }
}

fn hypot(x: f32, y: f32) -> f32 {
    libm::sqrtf(x * x + y * y)
}
