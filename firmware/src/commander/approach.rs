//! Arriving from one side, against lost motion: guides that give way under the friction of their carriages hold the platform off its place
//! by how they were last moved.
//!
//! A pivot's place on its guide changes with the platform's place by `-e / c`, e being the direction from the track's centre to the pivot and
//! c the cosine of `phi - theta_i`, 1 at most. So a way along v moves each carriage by `|e . v| / c` or more, and by the sign of `e . v` this
//! way or that. Along the sum of two pivots' directions those two go one way, and the third the other. No choice of signs can be had at
//! every pose of the disk; but one of the three sums always moves every carriage by [`LEAST_SHARE`] of the way, and which one is taken
//! depends on the target alone: wherever the stage comes from, its last way to a target is the same.

use super::coordinates::UNITS_PER_RADIUS;
use super::error::CommandError;
use super::state::Commander;
use crate::motion::{Constraints, Position, Refusal, check_line, check_target};
use kinematics::{Angle, Pose, inverse};

/// Largest way, um: over much less friction forgets where it came from.
pub const MOST_APPROACH_UM: f64 = 200.0;
/// Each carriage moves by this share of the way at least.
const LEAST_SHARE: f64 = 0.35;

impl Commander {
    /// From the next target on the last way moves each carriage by so much at least, always in the same direction at a target; 0 goes there
    /// at once.
    pub const fn set_approach(&mut self, way_um: f64) {
        self.approach.way_um = way_um.clamp(0.0, MOST_APPROACH_UM);
    }

    /// Way of each carriage on the last way to a target, um.
    pub const fn approach_um(&self) -> f64 {
        self.approach.way_um
    }

    /// Where a move to a target goes first; the target itself without an approach.
    ///
    /// # Errors
    /// Why the stage cannot arrive from beside the target: soft limits leave no room, say.
    pub(super) fn approach_from(&self, target: &Position) -> Result<Position, CommandError> {
        if self.approach.way_um == 0.0 {
            return Ok(*target);
        }
        let constraints = self.constraints();
        let way = self.approach.way_um * 1e-3 / self.base_constraints.geometry.radius_mm;
        Ok(beside(target, way, &constraints)?)
    }
}

/// Where the last way to a target begins; `way` in track radii.
fn beside(target: &Position, way: f64, constraints: &Constraints) -> Result<Position, Refusal> {
    let mut refusal = Refusal::OutsideDisk;
    for direction in directions(target, constraints.rotation_centre) {
        let [x, y] = direction.map(|part| libm::rint(part * way * UNITS_PER_RADIUS) as i64);
        let from = [target[0] + x, target[1] + y, target[2]];
        let checked =
            check_target(&from, constraints).and_then(|()| check_line(&from, target, constraints));
        match checked {
            Ok(()) => return Ok(from),
            Err(no) => refusal = no,
        }
    }
    Err(refusal)
}

/// Ways from a target that move each carriage by 1 at least, the one to be preferred first.
fn directions(target: &Position, rotation_centre: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let sums = pivots(target, rotation_centre).map_or([(0.0, [0.0; 2]); 3], sums);
    let mut order = [0, 1, 2];
    // One and the same over as much of the disk as can be: neighbouring targets are arrived at alike.
    if sums[0].0 < LEAST_SHARE {
        order.sort_unstable_by(|&one, &other| sums[other].0.total_cmp(&sums[one].0));
    }
    let good = order
        .map(|i| sums[i])
        .into_iter()
        .filter(|(share, _)| *share >= LEAST_SHARE);
    good.flat_map(|(share, [x, y])| [[x / share, y / share], [-x / share, -y / share]])
}

/// Sums of two of these directions, of length 1, with the share of a way along each by which every carriage moves.
fn sums(pivots: [[f64; 2]; 3]) -> [(f64, [f64; 2]); 3] {
    [0, 1, 2].map(|i| {
        let ([one, other], third) = match i {
            0 => ([pivots[1], pivots[2]], pivots[0]),
            1 => ([pivots[2], pivots[0]], pivots[1]),
            _ => ([pivots[0], pivots[1]], pivots[2]),
        };
        let [x, y] = [one[0] + other[0], one[1] + other[1]];
        let length = libm::hypot(x, y);
        let along = |pivot: [f64; 2]| ((pivot[0] * x + pivot[1] * y) / length).abs();
        let share = along(one).min(along(other)).min(along(third));
        // Of two that are opposite to each other there is none.
        if share.is_finite() {
            (share, [x / length, y / length])
        } else {
            (0.0, [0.0; 2])
        }
    })
}

/// Directions from the track's centre to the three pivots, as drawn: a way that is off by some mrad does as well.
fn pivots(target: &Position, rotation_centre: [f64; 2]) -> Option<[[f64; 2]; 3]> {
    let theta = Angle::from_units(i64::from(target[2] as u32)).radians();
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let [point_x, point_y] = rotation_centre;
    let pose = Pose {
        x: target[0] as f64 / UNITS_PER_RADIUS - (cos * point_x - sin * point_y),
        y: target[1] as f64 / UNITS_PER_RADIUS - (sin * point_x + cos * point_y),
        theta,
    };
    let pivots = inverse::<f64>(&pose).ok()?.pivots;
    Some(pivots.map(|pivot| [libm::cos(pivot), libm::sin(pivot)]))
}

#[cfg(test)]
mod tests {
    use super::{LEAST_SHARE, beside, directions};
    use crate::commander::coordinates::UNITS_PER_RADIUS;
    use crate::motion::{Constraints, Position};
    use crate::parameters::Parameters;
    use kinematics::{Pose, inverse};

    const WAY: f64 = 3e-4;

    fn constraints() -> Constraints {
        let parameters = Parameters::REFERENCE;
        Constraints::new(parameters.limits, parameters.geometry)
    }

    /// Over the whole disk, its rim and its middle, at all orientations.
    fn targets() -> impl Iterator<Item = Position> {
        (0..40_000_i64).map(|k| {
            let (ring, spoke) = ((k % 40) as f64 / 39.0, (k / 40 % 50) as f64 / 50.0);
            let (sin, cos) = (core::f64::consts::TAU * spoke).sin_cos();
            // Inside by a unit's rounding.
            let r = 0.8 * ring * UNITS_PER_RADIUS - 2.0;
            [
                (r * cos) as i64,
                (r * sin) as i64,
                (k / 2_000) * 214_748_365 - (1 << 31),
            ]
        })
    }

    fn lengths(position: &Position) -> [f64; 3] {
        let pose = Pose {
            x: position[0] as f64 / UNITS_PER_RADIUS,
            y: position[1] as f64 / UNITS_PER_RADIUS,
            theta: position[2] as f64 / UNITS_PER_RADIUS * core::f64::consts::TAU,
        };
        let guides = inverse::<f64>(&pose).expect("inside the track").guides;
        guides.map(|guide| guide.cosine - guide.projection)
    }

    #[test]
    fn every_carriage_moves_by_the_way_at_least() {
        let constraints = constraints();
        let mut longest = 0.0_f64;
        for target in targets() {
            let from = beside(&target, WAY, &constraints).expect("room on the disk");
            let (here, there) = (lengths(&target), lengths(&from));
            for i in 0..3 {
                let moved = (there[i] - here[i]).abs();
                // But for the second order.
                assert!(moved > 0.998 * WAY, "{target:?}, {i}: {moved}");
            }
            let [x, y] = [0, 1].map(|k| (from[k] - target[k]) as f64 / UNITS_PER_RADIUS);
            longest = longest.max(x.hypot(y));
        }
        assert!(longest <= 1.001 * WAY / LEAST_SHARE, "{longest}");
    }

    /// Wherever two of the pivots stand, there are ways to both sides.
    #[test]
    fn there_is_a_way_everywhere() {
        for target in targets() {
            assert!(directions(&target, [0.0; 2]).count() >= 2, "{target:?}");
        }
    }

    /// On most of the disk all targets of an orientation are arrived at with the same signs: how much of it, is pinned.
    #[test]
    fn most_targets_are_arrived_at_alike() {
        let constraints = constraints();
        let mut alike = [0_u32; 8];
        let mut count = 0;
        for target in targets() {
            let from = beside(&target, WAY, &constraints).expect("room on the disk");
            let (here, there) = (lengths(&target), lengths(&from));
            let signs = (0..3).map(|i| usize::from(there[i] > here[i]) << i);
            alike[signs.sum::<usize>()] += 1;
            count += 1;
        }
        let most = alike.into_iter().max().unwrap_or(0);
        // 71 %.
        assert!(most * 100 > count * 64, "{alike:?} of {count}");
    }
}
