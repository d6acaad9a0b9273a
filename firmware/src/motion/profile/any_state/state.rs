//! A state over jerk: the ramp it is part of, its fastest stop, its way back into the limits.

use super::task::Task;
use crate::number::float::Float;

/// Limits over jerk: that of acceleration is a time.
#[derive(Clone, Copy)]
pub(super) struct Scaled<F> {
    pub v: F,
    pub a: F,
}

/// State over jerk, and the way that is left.
#[derive(Clone, Copy)]
pub(super) struct State<F> {
    pub d: F,
    pub v: F,
    pub a: F,
}

/// The time in which speed changes by `u` from zero acceleration to zero acceleration.
pub(super) fn ramp<F: Float>(u: F, most: F) -> F {
    if u <= most.square() {
        let root = u.root();
        root + root
    } else {
        u / most + most
    }
}

/// Peak and duration of the peak in such a change.
pub(super) fn peak<F: Float>(u: F, most: F) -> (F, F) {
    if u <= most.square() {
        (u.root(), F::ZERO)
    } else {
        (most, u / most - most)
    }
}

impl<F: Float> State<F> {
    /// Of a task in the units of its limits.
    pub fn new<T: Float>(task: &Task<T>, jerk: F) -> Self {
        let over = |value: T| F::from_f64(value.to_f64()) / jerk;
        Self {
            d: over(task.distance),
            v: over(task.velocity),
            a: over(task.acceleration),
        }
    }

    fn run(&mut self, t: F, jerk: F) {
        self.d = self.d - t * (self.v + t * (self.a.half() + jerk * t / F::from_f64(6.0)));
        self.v = self.v + t * (self.a + jerk * t.half());
        self.a = self.a + jerk * t;
    }

    /// Speed once the acceleration is released.
    pub fn released(&self) -> F {
        self.v + (self.a * self.a.abs()).half()
    }

    pub fn mirrored(&self, sign: F) -> Self {
        Self {
            d: self.d * sign,
            v: self.v * sign,
            a: self.a * sign,
        }
    }

    /// Virtual start of a ramp upwards: its speed, and its distance.
    pub fn virtual_start(&self) -> (F, F) {
        let half = self.a.square().half();
        (
            self.v - half,
            -(self.a * (self.v - half * F::from_f64(2.0 / 3.0))),
        )
    }

    /// Distance of the fastest stop.
    pub fn stop(&self, most: F) -> F {
        let sign = if self.released() > F::ZERO {
            -F::ONE
        } else {
            F::ONE
        };
        let (v_s, p_s) = self.mirrored(sign).virtual_start();
        sign * (p_s + v_s.half() * ramp((-v_s).max(F::ZERO), most))
    }

    /// Brakes into the limits: the sign of the jerk, and how long it acts and the acceleration is held. Both reasons
    /// ask for the same sign of jerk, or the second for none.
    pub fn brake(&mut self, limits: &Scaled<F>) -> (F, [F; 2]) {
        let (mut sign, mut jerking, mut holding) = (F::ZERO, F::ZERO, F::ZERO);
        let over = self.a.abs() - limits.a;
        if over > F::ZERO {
            sign = -way_of(self.a);
            jerking = over;
            self.run(over, sign);
            self.a = -(sign * limits.a);
        }
        let released = self.released();
        let over = released.abs() - limits.v;
        if over > F::ZERO {
            let way = way_of(released);
            let a = self.a * way;
            let peak = (over + a.min(F::ZERO).square()).root().min(limits.a);
            let more = (peak + a).max(F::ZERO);
            if more > F::ZERO {
                sign = -way;
                jerking = jerking + more;
                self.run(more, -way);
            }
            holding = ((self.released() * way - limits.v) / limits.a).max(F::ZERO);
            self.run(holding, F::ZERO);
        }
        (sign, [jerking, holding])
    }
}

fn way_of<F: Float>(value: F) -> F {
    if value < F::ZERO { -F::ONE } else { F::ONE }
}
