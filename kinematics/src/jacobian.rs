//! The Jacobian `J = Lambda^-1 Z`, its inverse, and the dexterity made of the two.

use nalgebra::Matrix3;

use crate::guide::Guide;
use crate::scalar::Real;

/// J: pivot rates (rows, rad/s) from the platform's x, y (track radii per second) and theta (rad/s) rates (columns).
pub fn jacobian<T: Real>(guides: &[Guide<T>; 3]) -> Matrix3<T> {
    let [(a1, b1, r1), (a2, b2, r2), (a3, b3, r3)] = guides.map(|guide| {
        let over_cosine = T::ONE / guide.cosine;
        (
            -guide.sin * over_cosine,
            guide.cos * over_cosine,
            guide.rho() * over_cosine,
        )
    });
    Matrix3::new(a1, b1, r1, a2, b2, r2, a3, b3, r3)
}

/// J^-1: platform rates x, y, theta (rows) from pivot rates (columns).
///
/// A closed form with one division, because the three directions add up to nothing and their squares to 3/2: summing
/// `c_i phi_i' = -sin theta_i x' + cos theta_i y' + rho_i theta'` leaves theta' alone, and x' and y' follow. It exists at
/// every pose inside the track: the sum of the rho_i never falls below sqrt(3) there.
pub fn jacobian_inverse<T: Real>(guides: &[Guide<T>; 3]) -> Matrix3<T> {
    let [g1, g2, g3] = guides;
    let over_total = T::ONE / (g1.rho() + g2.rho() + g3.rho());
    let mean_cos = (g1.cos * g1.rho() + g2.cos * g2.rho() + g3.cos * g3.rho()) * over_total;
    let mean_sin = (g1.sin * g1.rho() + g2.sin * g2.rho() + g3.sin * g3.rho()) * over_total;
    let two_thirds = T::THIRD + T::THIRD;
    let [(x1, y1, t1), (x2, y2, t2), (x3, y3, t3)] = guides.map(|guide| {
        let scaled = guide.cosine * two_thirds;
        (
            (mean_sin - guide.sin) * scaled,
            (guide.cos - mean_cos) * scaled,
            guide.cosine * over_total,
        )
    });
    Matrix3::new(x1, x2, x3, y1, y2, y3, t1, t2, t3)
}

/// Dexterity `xi = 1 / (|J| |J^-1|)` with `|J| = sqrt(tr(J J^T) / 3)` and R = 1: 1 would be isotropic, and towards 0 the
/// platform loses a direction.
pub fn dexterity<T: Real>(guides: &[Guide<T>; 3]) -> T {
    let three = T::ONE + T::ONE + T::ONE;
    let squared = |matrix: Matrix3<T>| matrix.iter().fold(T::ZERO, |sum, &m| sum + m * m);
    three / (squared(jacobian(guides)) * squared(jacobian_inverse(guides))).sqrt()
}
