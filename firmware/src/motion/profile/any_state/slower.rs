//! A longer duration, by a lower speed in segment 6.

use super::fastest::cruising;
use super::start::{Main, ProfileStart};
use super::state::ramp;
use crate::number::float::Float;

/// Rounds of the solution. Any of them gives a profile that arrives early: it is left at the last.
const MOST_ROUNDS: usize = 24;
/// Part of a duration by which an axis may be early.
const EARLY: f64 = 1e-4;

impl<F: Float> ProfileStart<F> {
    /// The profile of a lower speed in segment 6 that lasts `duration`.
    ///
    /// What the time left for segment 6 would cover at speed `top`, less what is left to cover, is negative for a `top`
    /// of zero and positive at the fastest profile's: bisection and regula falsi between them, and the side that is
    /// early.
    pub fn slower(&self, fastest: &Main<F>, duration: F) -> Option<Main<F>> {
        let miss = |top: F| {
            let (t, d) = self.ramps(top);
            (top * (duration - t) - (self.state.d - d), self.state.d - d)
        };
        let (mut low, mut high) = (F::ZERO, fastest.top);
        let mut f_low = -self.beyond;
        let (mut f_high, mut left) = miss(high);
        if !(f_low < F::ZERO && f_high >= F::ZERO) {
            return None;
        }
        for round in 0..MOST_ROUNDS {
            // Early by so little is as good as in time.
            if f_high <= high * duration * F::from_f64(EARLY) {
                break;
            }
            let middle = if round % 3 == 2 {
                (low + high).half()
            } else {
                high - f_high * (high - low) / (f_high - f_low)
            };
            let (f, rest) = miss(middle);
            if f >= F::ZERO {
                // Regula falsi would keep the other end for ever: it is made to count for half (Illinois).
                (high, f_high, left) = (middle, f, rest);
                f_low = f_low.half();
            } else {
                (low, f_low) = (middle, f);
                f_high = f_high.half();
            }
        }
        (left >= F::ZERO && high > F::ZERO).then(|| self.at_speed(high, left / high))
    }

    /// Time and distance of both ramps at a given speed between them.
    fn ramps(&self, top: F) -> (F, F) {
        let most = self.limits.a;
        let first = self.first(top);
        let state = self.state.mirrored(first);
        let (v_s, p_s) = state.virtual_start();
        let up = ramp((first * top - v_s).max(F::ZERO), most);
        let down = ramp(top, most);
        (
            up - state.a + down,
            first * (p_s + (v_s + first * top).half() * up) + top.half() * down,
        )
    }

    fn first(&self, top: F) -> F {
        if top >= self.v_z { F::ONE } else { -F::ONE }
    }

    fn at_speed(&self, top: F, hold: F) -> Main<F> {
        let first = self.first(top);
        let state = self.state.mirrored(first);
        let (v_s, _) = state.virtual_start();
        let gained = (first * top - v_s).max(F::ZERO);
        let mut main = cruising(&state, gained, top, hold, self.limits.a);
        main.first = first;
        main
    }
}
