//! The same with libraries as they come: what stands beside the library's own parts in the table.

mod decoding;
mod direct;
mod inverse;
mod ruckig;

use super::states::{Moved, moved};
use crate::bench::{Bench, plain};
use nalgebra::{RealField, Vector3};

/// Counts them.
pub fn run(bench: &mut Bench) {
    inverse_in::<f32>(bench, "beside: inverse kinematics, nalgebra + libm, f32");
    inverse_in::<f64>(bench, "beside: inverse kinematics, nalgebra + libm, f64");
    direct_in::<f32>(bench, "beside: direct kinematics, nalgebra + libm, f32");
    direct_in::<f64>(bench, "beside: direct kinematics, nalgebra + libm, f64");
    decoding::run(bench);
    ruckig::run(bench);
}

fn inverse_in<T: RealField + Copy>(bench: &mut Bench, name: &'static str) {
    bench.part(
        name,
        1,
        |random| arguments::<T>(&moved(random)),
        |[pose, twist, acceleration]| inverse::inverse(pose, twist, acceleration),
        plain,
    );
}

fn direct_in<T: RealField + Copy>(bench: &mut Bench, name: &'static str) {
    bench.part(
        name,
        1,
        |random| {
            let [pose, twist, acceleration] = arguments::<T>(&moved(random));
            let [pivots, ..] = inverse::inverse(&pose, &twist, &acceleration);
            pivots
        },
        direct::direct,
        plain,
    );
}

/// Pose, velocity and acceleration in track radii and rad.
fn arguments<T: RealField>((pose, twist, acceleration): &Moved) -> [Vector3<T>; 3] {
    let vector = |x: f64, y: f64, theta: f64| Vector3::new(x, y, theta).map(nalgebra::convert);
    [
        vector(pose.x.to_f64(), pose.y.to_f64(), pose.theta.radians()),
        vector(twist.x.into(), twist.y.into(), twist.theta.into()),
        vector(
            acceleration.x.into(),
            acceleration.y.into(),
            acceleration.theta.into(),
        ),
    ]
}
