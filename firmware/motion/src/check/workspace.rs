//! Targets: which way round to an orientation, since theta counts turns and a target may mean its turn or only its direction,
//! and whether one lies inside the workspace.

use crate::constraints::Constraints;
use crate::plan::Position;
use crate::refusal::Refusal;
use crate::tolerances::{TARGET_RADII, TARGET_RADII_OFF_CENTRE};
use kinematics::{Angle, Scalar};
use number::Fixed;

/// How a target of theta is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TurnDirection {
    /// With its turns: from 0 to 720 deg are two turns.
    #[default]
    AsGiven,
    /// The orientation only, the shortest way. Of half a turn either way the negative one.
    Shortest,
    /// The orientation only, turning to positive angles: less than a turn, or not at all.
    Positive,
    /// The orientation only, turning to negative angles: less than a turn, or not at all.
    Negative,
}

impl TurnDirection {
    /// Where theta (2^-32 turns) has to go from `now` for what is meant by `target`. Exact at any number of turns.
    pub const fn resolve(self, now: i64, target: i64) -> i64 {
        match self {
            Self::AsGiven => target,
            Self::Shortest => Angle::from_units(target)
                .near(Angle::from_units(now))
                .units(),
            Self::Positive => now.wrapping_add(ahead(now, target)),
            Self::Negative => now.wrapping_sub(ahead(target, now)),
        }
    }
}

/// From the orientation of `from` on to that of `to`, turning to positive angles: from 0 to less than a turn.
const fn ahead(from: i64, to: i64) -> i64 {
    to.wrapping_sub(from) as u32 as i64
}

/// Most turns that a target may have, a thousand million, in units of a position.
pub const MAX_TURNS: i64 = 1_000_000_000 << 32;

/// Whether `target` lies inside the workspace.
pub fn check_target(target: &Position, constraints: &Constraints) -> Result<(), Refusal> {
    if target[2].unsigned_abs() > MAX_TURNS.unsigned_abs() {
        return Err(Refusal::TooManyTurns);
    }
    check_disk(target, constraints)?;
    let inside =
        |i: usize| (constraints.bounds[i][0]..=constraints.bounds[i][1]).contains(&target[i]);
    match (0..3).find(|&i| !inside(i)) {
        Some(axis) => Err(Refusal::OutOfBounds { axis }),
        None => Ok(()),
    }
}

#[inline(never)]
fn check_disk(target: &Position, constraints: &Constraints) -> Result<(), Refusal> {
    const UNIT: f64 = 1.0 / 4_294_967_296.0;
    let [mut x, mut y] = [target[0] as f64 * UNIT, target[1] as f64 * UNIT];
    let mut rim = TARGET_RADII;
    if constraints.rotation_centre != [0.0; 2] {
        let (sin, cos) = Fixed::sin_cos(Angle::from_units(target[2]));
        let (sin, cos) = (sin.to_f64(), cos.to_f64());
        let [p, q] = constraints.rotation_centre;
        x -= cos * p - sin * q;
        y -= sin * p + cos * q;
        rim = TARGET_RADII_OFF_CENTRE;
    }
    let most = constraints.usable_radius + rim;
    let square = x * x + y * y;
    if square > most * most {
        return Err(Refusal::OutsideDisk);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TURN: i64 = 1 << 32;
    const MOST: i64 = 1_000_000_000 * TURN;

    /// Angles from all over the range, and the ones at which a choice turns over.
    fn angles() -> Vec<i64> {
        let mut angles = Vec::new();
        for turns in [-MOST, -3 * TURN, -TURN, 0, TURN, 20_000 * TURN, MOST] {
            for part in [
                0,
                1,
                TURN / 3,
                TURN / 2 - 1,
                TURN / 2,
                TURN / 2 + 1,
                TURN - 1,
            ] {
                angles.push(turns + part);
            }
        }
        angles
    }

    #[test]
    fn every_direction_but_as_given_keeps_the_orientation_and_its_own_range() {
        for now in angles() {
            for target in angles() {
                assert_eq!(TurnDirection::AsGiven.resolve(now, target), target);
                for (turn_direction, range) in [
                    (TurnDirection::Shortest, -TURN / 2..TURN / 2),
                    (TurnDirection::Positive, 0..TURN),
                    (TurnDirection::Negative, 1 - TURN..1),
                ] {
                    let to = turn_direction.resolve(now, target);
                    assert_eq!((to - target) % TURN, 0, "{turn_direction:?} {now} {target}");
                    assert!(
                        range.contains(&(to - now)),
                        "{turn_direction:?} {now} {target}"
                    );
                }
            }
        }
    }

    #[test]
    fn examples_in_degrees() {
        let degrees = |units: i64| units as f64 / TURN as f64 * 360.0;
        let units = |degrees: f64| (degrees / 360.0 * TURN as f64) as i64;
        for (now, target, expected) in [
            (10.0, 350.0, [350.0, -10.0, 350.0, -10.0]),
            (730.0, 45.0, [45.0, 765.0, 765.0, 405.0]),
            (0.0, 180.0, [180.0, -180.0, 180.0, -180.0]),
            (90.0, 90.0, [90.0; 4]),
            (90.0, 450.0, [450.0, 90.0, 90.0, 90.0]),
        ] {
            let ways = [
                TurnDirection::AsGiven,
                TurnDirection::Shortest,
                TurnDirection::Positive,
                TurnDirection::Negative,
            ];
            for (turn_direction, expected) in ways.into_iter().zip(expected) {
                let to = degrees(turn_direction.resolve(units(now), units(target)));
                assert!(
                    (to - expected).abs() < 1e-6,
                    "{turn_direction:?} {now} {target}: {to}"
                );
            }
        }
    }
}
