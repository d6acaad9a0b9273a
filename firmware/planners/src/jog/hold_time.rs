//! How long a jog can be held before its axes have to brake, and how much slower it has to be where that is too short.

use super::request::JogRequest;
use super::trajectory::{Jog, change};
use motion::plan::axis_state::AxisState;
use motion::speeds::per_second;
use number::float::{FloatMinMax, ticks_to_f32, truncate};

/// Some axes would be over after so many seconds at the velocity wanted: too soon to reach it and to stop.
pub(super) struct TooShort {
    seconds: f32,
    point: bool,
    turn: bool,
}

/// Longest that a velocity is held, ticks: two million years.
const LONGEST: f32 = 1_152_921_504_606_846_976.0;

/// A velocity of which less than this share can be reached is none.
const LEAST_SHARE: f32 = 1e-3;

impl Jog {
    /// For how many ticks each axis keeps its velocity before it has to brake.
    pub(super) fn hold(
        &self,
        state: &[AxisState; 3],
        request: &JogRequest,
        from_rest: bool,
    ) -> Result<[u64; 3], TooShort> {
        let hz = request.hz;
        let target = per_second(&self.wanted, request.hz);
        // From rest the ramp goes the same way, at half the speed.
        let ramp = ticks_to_f32(self.ramp) / (2.0 * hz);
        let (from, done) = if from_rest {
            (state, ramp)
        } else {
            (&self.steady, 0.0)
        };
        let edge = request.steady(from, &target).time_to_edge(self.radius);
        let bounds = request
            .steady(&self.steady, &target)
            .time_to_bounds(&request.constraints.bounds);
        let mut point = (edge.seconds - done).fmin(bounds);
        let mut turn = request.time_to_theta_bound(&self.steady[2], self.wanted[2]);
        if edge.theta_too {
            point = point.fmin(turn);
            turn = point;
        }
        let brake = ticks_to_f32(self.brake.iter().sum()) / (2.0 * hz);
        let is_short = [
            self.wanted[..2] != [0, 0] && point < brake,
            self.wanted[2] != 0 && turn < brake,
        ];
        if is_short != [false; 2] {
            return Err(TooShort {
                seconds: if is_short[0] { point } else { turn } + ramp,
                point: is_short[0],
                turn: is_short[1] && (edge.theta_too || !is_short[0]),
            });
        }
        let ticks = |seconds: f32| truncate(((seconds - brake) * hz).fmin(LONGEST)) as u64;
        Ok([ticks(point), ticks(point), ticks(turn)])
    }

    /// A velocity that can be reached and given up again in what way there is; zero where there is none.
    pub(super) fn slower(&self, short: &TooShort, request: &JogRequest) -> [i64; 3] {
        let slower = |share: f32| {
            let share = (share * 65_536.0) as i64;
            each!(i => {
                let velocity = self.wanted[i];
                let counts = if i < 2 { short.point } else { short.turn };
                if counts {
                    (velocity >> 16) * share
                } else {
                    velocity
                }
            })
        };
        let (mut low, mut high) = (0.0, 1.0);
        // To a thousandth.
        for _ in 0..10 {
            let share = (low + high) / 2.0;
            let velocity = per_second(&slower(share), request.hz);
            let brake = change(&velocity, &self.acceleration_limits);
            if share * brake.times_s().iter().sum::<f32>() <= short.seconds {
                low = share;
            } else {
                high = share;
            }
        }
        // A little less, for what a slower motion has besides: a larger disk, and in it less acceleration.
        slower(if low < LEAST_SHARE { 0.0 } else { low * 0.95 })
    }
}
