//! Where the main part of a profile sets out, and how far beyond the fastest stop its target lies.

use super::state::{Scaled, State};
use super::task::{AxisProfile, Task, Unusable};
use crate::motion::plan::units::AxisLimits;
use crate::number::float::Float;

/// Where the main part starts: within the limits, and mirrored so that the target lies beyond the fastest stop.
pub(super) struct ProfileStart<F> {
    pub limits: Scaled<F>,
    pub state: State<F>,
    /// How far the target lies beyond the stop.
    pub beyond: F,
    /// Speed once the acceleration is released, and that of the virtual start.
    pub v_z: F,
    pub v_s: F,
    /// Jerk sign of the first segment, durations of the first two.
    brake: (F, [F; 2]),
    /// The mirror: 1 or -1.
    sign: F,
}

/// The main part: seven segments, and the sign of the jerk in the first.
#[derive(Clone, Copy)]
pub(super) struct Main<F> {
    pub t: [F; 7],
    pub first: F,
    /// Speed in segment 6.
    pub top: F,
    pub released_in_part: bool,
}

/// Smaller than this part of what it is the difference of, a difference is taken from doubles.
const NEAR: f64 = 1.0 / 64.0;

impl<F: Float> ProfileStart<F> {
    pub fn new<T: Float>(task: &Task<T>, limits: &AxisLimits<F>) -> Result<Self, Unusable> {
        let scaled = scaled(limits)?;
        let mut state = State::new(task, limits.jerk);
        let brake = state.brake(&scaled);
        let stop = state.stop(scaled.a);
        let (mut beyond, mut v_z) = (state.d - stop, state.released());
        if !beyond.is_finite() {
            return Err(Unusable::Task);
        }
        if F::COARSE && brake.0 == F::ZERO && state.is_near(beyond, v_z, stop) {
            (beyond, v_z) = from_doubles(task, limits);
        }
        let sign = if beyond < F::ZERO { -F::ONE } else { F::ONE };
        let state = state.mirrored(sign);
        let v_z = v_z * sign;
        let v_s = if state.a < F::ZERO {
            v_z
        } else {
            state.virtual_start().0
        };
        Ok(Self {
            limits: scaled,
            state,
            beyond: beyond.abs(),
            v_z,
            v_s,
            brake,
            sign,
        })
    }

    pub fn braked(&self) -> F {
        self.brake.1[0] + self.brake.1[1]
    }

    pub fn profile(&self, main: &Main<F>, jerk: F) -> Result<AxisProfile<F>, Unusable> {
        let (brake, [b1, b2]) = self.brake;
        let t = main.t;
        let durations = [b1, b2, t[0], t[1], t[2], t[3], t[4], t[5], t[6]];
        if !durations.iter().all(|t| t.is_finite()) {
            return Err(Unusable::Task);
        }
        let first = self.sign * main.first * jerk;
        let last = self.sign * jerk;
        let (brake, none) = (brake * jerk, F::ZERO);
        Ok(AxisProfile {
            durations,
            jerks: [brake, none, first, none, -first, none, -last, none, last],
            released_in_part: main.released_in_part,
        })
    }
}

/// The limits over jerk, if they are any.
fn scaled<F: Float>(limits: &AxisLimits<F>) -> Result<Scaled<F>, Unusable> {
    let AxisLimits {
        velocity,
        acceleration,
        jerk,
    } = *limits;
    let scaled = Scaled {
        v: velocity / jerk,
        a: acceleration / jerk,
    };
    let usable = |limit: F| limit.is_finite() && limit > F::ZERO;
    let all = [velocity, acceleration, jerk, scaled.v, scaled.a];
    if all.into_iter().all(usable) {
        Ok(scaled)
    } else {
        Err(Unusable::Limits)
    }
}

impl<F: Float> State<F> {
    /// Whether one of the two differences is small.
    fn is_near(&self, beyond: F, v_z: F, stop: F) -> bool {
        let near = F::from_f64(NEAR);
        let (v, a) = (self.v.abs(), self.a.abs());
        let moving = v > F::ZERO || a > F::ZERO;
        let terms = self.d.abs() + stop.abs() + a * (v + a.square());
        moving && (beyond.abs() < near * terms || v_z.abs() < near * (v + a.square()))
    }
}

/// Distance beyond the stop and released speed.
#[inline(never)]
fn from_doubles<T: Float, F: Float>(task: &Task<T>, limits: &AxisLimits<F>) -> (F, F) {
    let jerk = limits.jerk.to_f64();
    let state = State::<f64>::new(task, jerk);
    let beyond = state.d - state.stop(limits.acceleration.to_f64() / jerk);
    (F::from_f64(beyond), F::from_f64(state.released()))
}
