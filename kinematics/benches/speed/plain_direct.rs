//! Direct kinematics with complex numbers: the closed form that the library has as well.

use nalgebra::{Complex, RealField, Vector3, convert};

/// Pivots (rad) to pose.
pub fn direct<T: RealField + Copy>(pivots: &Vector3<T>) -> Vector3<T> {
    let on_track = |angle: T| {
        let (sin, cos) = angle.sin_cos();
        Complex::new(cos, sin)
    };
    let [z1, z2, z3] = [pivots.x, pivots.y, pivots.z].map(on_track);
    let w = Complex::<T>::new(convert(-0.5), convert(0.866_025_403_784_438_6));
    let s0 = z1 + z2 + z3;
    let s1: Complex<T> = z1 + w.conj() * z2 + w * z3;
    let s2: Complex<T> = z1 + w * z2 + w.conj() * z3;
    let u = s1 / s1.norm_sqr().sqrt();
    let centre: Complex<T> = (s0 - u * u * s2.conj()) / convert::<f64, T>(3.0);
    let theta = u.im.atan2(u.re) + convert(30_f64.to_radians());
    Vector3::new(centre.re, centre.im, theta)
}
