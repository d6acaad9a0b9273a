//! Referencing: turns for theta and the pivots from encoders that know no turns.

use kinematics::{Angle, Scalar};

use crate::number::Fixed;

/// Theta in (-180, 180] deg, and each pivot's angle so that phi_i = theta_i + asin(d_i): the one congruent to what its
/// encoder shows that lies nearest to its guide's direction, since |asin(d_i)| is under 90 deg.
pub fn within_one_turn(theta: Angle, pivots: &[Angle; 3]) -> (Angle, [Angle; 3]) {
    let half_turn = Angle::from_units(1 << 31);
    let mut theta = theta.near(Angle::ZERO);
    if theta == -half_turn {
        theta = half_turn;
    }
    let first = theta - Fixed::ANGLE_30;
    let second = first + Fixed::ANGLE_120;
    let third = second + Fixed::ANGLE_120;
    let [one, two, three] = *pivots;
    (
        theta,
        [one.near(first), two.near(second), three.near(third)],
    )
}
