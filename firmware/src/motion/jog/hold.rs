//! How long a jog can be held before its axes have to brake, and how much slower it has to be where that is too short.

use super::Jog;
use super::start::Setting;
use crate::motion::brake::velocity_change::Ramp;
use crate::motion::check::pivot_bounds::{Pace, per_second};
use crate::motion::plan::axis_state::AxisState;
use crate::number::float::{FloatMinMax, ticks_to_f32, truncate};

/// Some axes would be over after so many seconds at the velocity wanted: too soon to reach it and to stop.
pub(super) struct Short {
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
        setting: &Setting,
        from_rest: bool,
    ) -> Result<[u64; 3], Short> {
        let hz = setting.hz;
        let target = per_second(&self.wanted, setting.hz);
        // From rest the ramp goes the same way, at half the speed.
        let ramp = ticks_to_f32(self.ramp) / (2.0 * hz);
        let (from, done) = if from_rest {
            (state, ramp)
        } else {
            (&self.steady, 0.0)
        };
        let edge = setting.steady(from, &target).reach(self.radius);
        let bounds = setting
            .steady(&self.steady, &target)
            .within(&setting.ground.bounds);
        let mut point = (edge.seconds - done).fmin(bounds);
        let mut turn = setting.turn_seconds(&self.steady[2], self.wanted[2]);
        if edge.all {
            point = point.fmin(turn);
            turn = point;
        }
        let brake = ticks_to_f32(self.brake.ticks()) / (2.0 * hz);
        let is_short = [
            self.wanted[..2] != [0, 0] && point < brake,
            self.wanted[2] != 0 && turn < brake,
        ];
        if is_short != [false; 2] {
            return Err(Short {
                seconds: if is_short[0] { point } else { turn } + ramp,
                point: is_short[0],
                turn: is_short[1] && (edge.all || !is_short[0]),
            });
        }
        let ticks = |seconds: f32| truncate(((seconds - brake) * hz).fmin(LONGEST)) as u64;
        Ok([ticks(point), ticks(point), ticks(turn)])
    }

    /// A velocity that can be reached and given up again in what way there is; zero where there is none.
    pub(super) fn slower(&self, short: &Short, setting: &Setting) -> [i64; 3] {
        let slower = |share: f32| {
            let share = (share * 65_536.0) as i64;
            [0, 1, 2].map(|i| {
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
        for _ in 0..16 {
            let share = (low + high) / 2.0;
            let pace = Pace::of(&per_second(&slower(share), setting.hz));
            let ticks = ticks_to_f32(Ramp::new(pace, &self.force, setting.hz).ticks());
            if share * ticks <= short.seconds * setting.hz {
                low = share;
            } else {
                high = share;
            }
        }
        // A little less, for what a slower motion has besides: a larger disk, and in it less force.
        slower(if low < LEAST_SHARE { 0.0 } else { low * 0.95 })
    }
}
