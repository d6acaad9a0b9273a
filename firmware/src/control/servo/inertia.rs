//! The inertia that a pivot moves, where the platform is: what the gains are scheduled by.

use super::platform_torque::Body;

/// Moment of inertia of the carried body as a pivot feels it, kg m^2: the diagonal of `J^-T M J^-1`, M the body's mass matrix and J
/// the pivots' Jacobian.
///
/// `c phi'_i = n_i v + rho_i w` (DESIGN.md, the guides' velocity equations) for a pivot that alone turns at 1 rad/s gives `w = c_i /
/// sum rho` and `v = 2/3 (c_i n_i - w sum rho_j n_j)`, since the guides' normals n stand 120 deg apart; the inertia is twice the
/// kinetic energy of that motion.
#[inline]
pub fn carried_inertia(body: &Body, lengths: &[f32; 3], cosines: &[f32; 3], pivot: usize) -> f32 {
    const HALF_ROOT: f32 = 0.866_025_4;
    // In the platform's axes, as in `platform_torque`.
    const NORMALS: [[f32; 2]; 3] = [[0.5, HALF_ROOT], [-1.0, 0.0], [0.5, -HALF_ROOT]];
    let [a, b, c] = *lengths;
    let (Some(&[x, y]), Some(&cosine)) = (NORMALS.get(pivot), cosines.get(pivot)) else {
        return 0.0;
    };
    let turn = cosine / (a + b + c);
    let sum = [0.5 * (a + c) - b, HALF_ROOT * (a - c)];
    const TWO_THIRDS: f32 = 2.0 / 3.0;
    let v = [
        TWO_THIRDS * (cosine * x - turn * sum[0]),
        TWO_THIRDS * (cosine * y - turn * sum[1]),
    ];
    let moment = &body.moment;
    body.mass * (v[0] * v[0] + v[1] * v[1])
        + 2.0 * turn * (moment[0] * v[1] - moment[1] * v[0])
        + body.inertia * turn * turn
}
