//! The position that the servo takes over where it goes on: the measured one, to six decimals of mm and deg.
//!
//! It comes from one reading of each encoder, and has as many digits as the arithmetic. Kept, they would stand in every
//! target from then on. Rounded, the position is a number that the command side tells, and that means the same position,
//! to the unit, when it is commanded again.
//!
//! It is rounded where it is taken over, so that setpoint and target are one. The setpoint is off the reading by 0.5 nm
//! and 5e-7 deg at most, a fifth of a count of a pivot, which is less than the reading's own noise: nothing moves. Five
//! decimals would be 2 counts, and the simulated stage settles 1 ms later with them.

use crate::motion::Position;
use core::num::NonZeroU32;

/// Steps in a mm and in a deg.
pub(crate) const STEPS_PER_UNIT: f64 = 1e6;

/// What positions are rounded to: so many steps in a track radius and in a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionSteps {
    per_radius: NonZeroU32,
    per_turn: NonZeroU32,
}

impl PositionSteps {
    /// On a track of this radius.
    pub fn new(radius_mm: f64) -> Self {
        let steps = |length: f64| {
            let steps = libm::rint(length * STEPS_PER_UNIT) as u32;
            NonZeroU32::new(steps).unwrap_or(NonZeroU32::MIN)
        };
        Self {
            per_radius: steps(radius_mm),
            per_turn: steps(360.0),
        }
    }

    /// The position of the step nearest to `position`.
    pub fn nearest(&self, position: &Position) -> Position {
        let [x, y, theta] = *position;
        [
            nearest(x, self.per_radius),
            nearest(y, self.per_radius),
            nearest(theta, self.per_turn),
        ]
    }
}

/// The nearest multiple of 2^32 over `steps`, rounded to a unit. Whole radii and turns, on which there is a step, are set
/// aside: the rest has room in 64 bits. A step is at most 2^31 / `steps` units away: the chip divides that in an instruction, where the
/// whole position would be a call.
fn nearest(units: i64, steps: NonZeroU32) -> i64 {
    let [fraction, per_whole] = [units as u32, steps.get()].map(u64::from);
    let product = fraction * per_whole;
    let step = (product + (1 << 31)) >> 32;
    let away = (step << 32).wrapping_sub(product) as i64;
    let (far, half) = (away.unsigned_abs() as u32, steps.get() / 2);
    // To the nearest unit; from halfway up.
    let moved = if away >= 0 {
        i64::from(far.wrapping_add(half) / steps)
    } else {
        -i64::from(far.wrapping_add(steps.get() - 1 - half) / steps)
    };
    units.wrapping_add(moved)
}

#[cfg(test)]
mod tests {
    use crate::control::held_position::*;

    /// Within a turn or a track radius of zero, either way.
    fn positions() -> impl Iterator<Item = Position> {
        let mut units = 1_i64;
        core::iter::repeat_with(move || {
            [0, 1, 2].map(|_| {
                units = (units.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(7);
                units >> 31
            })
        })
        .take(10_000)
    }

    #[test]
    fn what_is_held_is_what_its_decimals_mean() {
        let steps = PositionSteps::new(100.0);
        for position in positions() {
            let held = steps.nearest(&position);
            for (i, unit) in [100.0, 100.0, 360.0].into_iter().enumerate() {
                let exact = position[i] as f64 / 4_294_967_296.0 * unit;
                let decimal = libm::rint(exact * 1e6) / 1e6;
                let units = libm::rint(decimal / unit * 4_294_967_296.0) as i64;
                assert_eq!(held[i], units, "{position:?}");
            }
            assert_eq!(steps.nearest(&held), held);
        }
    }

    #[test]
    fn it_is_the_quotient_of_the_whole_position() {
        for radius_mm in [0.001, 33.3, 100.0, 360.0, 1_999.9] {
            let steps = PositionSteps::new(radius_mm);
            let per_whole = i128::from(steps.per_radius.get());
            for units in positions().flatten().chain([0, 1, -1, i64::from(u32::MAX)]) {
                let step = (i128::from(units) * per_whole + (1 << 31)) >> 32;
                let exact = ((step << 32) + per_whole / 2).div_euclid(per_whole);
                assert_eq!(
                    i128::from(steps.nearest(&[units, 0, 0])[0]),
                    exact,
                    "{units}"
                );
            }
        }
    }

    #[test]
    fn turns_change_nothing() {
        let steps = PositionSteps::new(100.0);
        for position in positions() {
            let [x, y, theta] = steps.nearest(&position);
            for turns in [-9_999, 9_999].map(|turns: i64| turns << 32) {
                let turned = [position[0], position[1], position[2] + turns];
                assert_eq!(steps.nearest(&turned), [x, y, theta + turns]);
            }
        }
    }
}
