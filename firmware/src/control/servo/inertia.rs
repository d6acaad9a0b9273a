//! The inertia that a pivot moves, where the platform is: what the gains are scheduled by.

use super::platform_torque::Body;
use crate::number;

const HALF_ROOT: f32 = 0.866_025_4;
/// Of the guides, in the platform's axes, as in `platform_torque`.
static NORMALS: [[f32; 2]; 3] = [[0.5, HALF_ROOT], [-1.0, 0.0], [0.5, -HALF_ROOT]];
/// Places on the edge of the disk that the largest inertia is looked for at: between two it is less than 1 % more.
const PLACES: u16 = 48;
/// Cosine and sine of the angle from one to the next, 7.5 deg.
const STEP: [f32; 2] = [0.991_444_9, 0.130_526_19];

/// The platform's velocity along its own axes (x, y, theta; track radii) where one pivot alone turns at 1 rad/s, with the guides' lengths
/// rho and cosines c: a column of `J^-1`, J the pivots' Jacobian.
///
/// `c phi'_i = n_i v + rho_i w` (DESIGN.md, the guides' velocity equations) gives `w = c_i / sum rho` and `v = 2/3 (c_i n_i - w sum rho_j
/// n_j)`, since the guides' normals n stand 120 deg apart.
#[inline]
pub(super) fn unit_motion(lengths: &[f32; 3], cosines: &[f32; 3], pivot: usize) -> [f32; 3] {
    let [a, b, c] = *lengths;
    let (Some(&[x, y]), Some(&cosine)) = (NORMALS.get(pivot), cosines.get(pivot)) else {
        return [0.0; 3];
    };
    let turn = cosine / (a + b + c);
    let sum = [0.5 * (a + c) - b, HALF_ROOT * (a - c)];
    const TWO_THIRDS: f32 = 2.0 / 3.0;
    [
        TWO_THIRDS * (cosine * x - turn * sum[0]),
        TWO_THIRDS * (cosine * y - turn * sum[1]),
        turn,
    ]
}

/// Moment of inertia of the carried body as a pivot feels it, kg m^2: the diagonal of `J^-T M J^-1`, M the body's mass matrix. Twice the
/// kinetic energy of [`unit_motion`].
#[inline]
pub fn carried_inertia(body: &Body, lengths: &[f32; 3], cosines: &[f32; 3], pivot: usize) -> f32 {
    let [x, y, turn] = unit_motion(lengths, cosines, pivot);
    let moment = &body.moment;
    body.mass * (x * x + y * y)
        + 2.0 * turn * (moment[0] * y - moment[1] * x)
        + body.inertia * turn * turn
}

/// The most that [`carried_inertia`] of a pivot is in a disk of this radius (track radii): the body's energy grows towards the edge, and
/// so that is where it is looked for.
///
/// Whatever is set makes a configuration anew, twice, on what the tick leaves of the core: in double precision, which the core has not,
/// that took longer than the watchdog waits for the command side.
pub(super) fn largest_carried_inertia(body: &Body, radius: f64, pivot: usize) -> f64 {
    let radius = radius as f32;
    let mut largest = carried_inertia(body, &[1.0; 3], &[1.0; 3], pivot);
    let [mut cos, mut sin] = [1.0_f32, 0.0_f32];
    for _ in 0..PLACES {
        let (mut lengths, mut cosines) = ([0.0; 3], [0.0; 3]);
        for ([x, y], (length, cosine)) in NORMALS.iter().zip(lengths.iter_mut().zip(&mut cosines)) {
            // Of the place along the guide and across it: the guide meets the track where both make a radius.
            let (along, across) = (radius * (cos * y - sin * x), radius * (cos * x + sin * y));
            *cosine = number::sqrt_f32(1.0 - across * across);
            *length = *cosine - along;
        }
        largest = largest.max(carried_inertia(body, &lengths, &cosines, pivot));
        [cos, sin] = [cos * STEP[0] - sin * STEP[1], sin * STEP[0] + cos * STEP[1]];
    }
    largest.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    /// A finer look, at all radii: what is found at the edge is the most, for a load off the centre too.
    #[test]
    fn the_largest_inertia_is_at_the_edge() {
        let mut parameters = Parameters::REFERENCE;
        parameters.platform.payload_kg = 5.0;
        parameters.platform.payload_inertia_kg_m2 = 0.02;
        parameters.platform.payload_centre_mm = [30.0, -10.0];
        let body = Body::new(&parameters);
        for pivot in 0..3 {
            let largest = largest_carried_inertia(&body, 0.8, pivot);
            let mut most = 0.0_f64;
            for step in 0..=40 {
                most = most.max(largest_carried_inertia(
                    &body,
                    0.02 * f64::from(step),
                    pivot,
                ));
            }
            assert!(most <= 1.01 * largest, "{pivot}: {most} of {largest}");
            assert!(largest > 1.2 * largest_carried_inertia(&body, 0.0, pivot));
        }
    }
}
