//! What a choice is expected to ask of the pivots, and how much slower that makes it.

use super::choice::Choice;
use super::slower::Slower;
use crate::motion::check::interval::IntervalBounds;
use crate::motion::check::pivot_bounds::PivotGain;
use crate::motion::constraints::Constraints;
use crate::motion::plan::Position;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::{PER_AXIS_UNIT, POSITION_UNITS};
use crate::number::float::{FloatMinMax, hypot, i64_to_f32_fast};
use core::f32::consts::TAU;

/// What the bounds of the pivots' rates and accelerations, which hold at any orientation, come to as a rule.
const USUAL: f32 = 0.85;

/// Less than this of a limit is not tried.
const LEAST: f32 = 0.1;

impl Slower {
    /// By what a choice asks of the pivots at the speeds to be expected; whether that is slower.
    pub fn expect(
        &mut self,
        state: &[AxisState; 3],
        to: &Position,
        choice: &Choice,
        constraints: &Constraints,
    ) -> bool {
        let hz = constraints.limits.rate_hz as f32;
        let [along, rotation] = choice.limits;
        let ticks = choice.duration();
        let place = |position: i64| i64_to_f32_fast(position) / POSITION_UNITS;
        let way = [0, 1, 2].map(|i| place(to[i].wrapping_sub(state[i].rounded())));
        // Twice the mean speed at most, whatever the limit.
        let mean = |way: f32| 2.0 * way * hz / ticks.fmax(1.0);
        let once = |limit: f32| limit * PER_AXIS_UNIT * hz;
        let speeds = [
            once(along.velocity).fmin(mean(hypot(way[0], way[1]))),
            TAU * once(rotation.velocity).fmin(mean(way[2].abs())),
        ];
        let twice = |limit: f32| once(limit) * hz;
        let forces = [
            twice(along.acceleration)
                .fmin(speeds[0] * twice(along.jerk) * hz / twice(along.acceleration)),
            (TAU * twice(rotation.acceleration))
                .fmin(speeds[1] * twice(rotation.jerk) * hz / twice(rotation.acceleration)),
        ];
        let radius = hypot(place(state[0].rounded()), place(state[1].rounded()))
            .fmax(hypot(place(to[0]), place(to[1])))
            .fmin(constraints.usable_radius as f32);
        let bound = PivotGain::new(radius);
        let arm = hypot(
            constraints.rotation_centre[0] as f32,
            constraints.rotation_centre[1] as f32,
        );
        let sizes = IntervalBounds {
            v: speeds,
            a: forces,
            j: [0.0; 2],
        };
        let [rate, acceleration] = sizes.at_offset(arm).pivot_bounds(&bound);
        let [_, drift] = IntervalBounds {
            a: [0.0; 2],
            ..sizes
        }
        .at_offset(arm)
        .pivot_bounds(&bound);
        let limits = [
            constraints.limits.pivot_rate_rad_s as f32 / USUAL,
            constraints.limits.pivot_acceleration_rad_s2 as f32 / USUAL,
        ];
        if rate > limits[0] {
            self.speed = (limits[0] / rate).fmax(LEAST);
        }
        let left = (limits[1] - drift * self.speed * self.speed).fmax(LEAST * limits[1]);
        if acceleration - drift > left {
            self.force = (left / (acceleration - drift)).fmax(LEAST);
        }
        self.speed < 1.0 || self.force < 1.0
    }
}
