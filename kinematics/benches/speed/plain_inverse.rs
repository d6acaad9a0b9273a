//! Inverse kinematics from the textbook: position, the Jacobian times the velocity, acceleration.

use nalgebra::{Matrix3, RealField, Vector3, convert};

/// Pose, velocity and acceleration (x, y, theta) to those of the pivots: angles, rates, accelerations.
pub fn inverse<T: RealField + Copy>(
    pose: &Vector3<T>,
    twist: &Vector3<T>,
    acceleration: &Vector3<T>,
) -> [Vector3<T>; 3] {
    let guides = [-30.0, 90.0, 210.0].map(|degrees: f64| pose.z + convert(degrees.to_radians()));
    let directions = guides.map(T::sin_cos);
    let offsets = directions.map(|(sin, cos)| pose.y * cos - pose.x * sin);
    let cosines = offsets.map(|offset| (T::one() - offset * offset).sqrt());
    let along = directions.map(|(sin, cos)| pose.x * cos + pose.y * sin);
    let jacobian = Matrix3::from_fn(|i, j| {
        let (sin, cos) = directions[i];
        [-sin, cos, cosines[i] - along[i]][j] / cosines[i]
    });
    let rates = jacobian * twist;
    [
        Vector3::from_fn(|i, _| guides[i] + offsets[i].asin()),
        rates,
        Vector3::from_fn(|i, _| {
            let (sin, cos) = directions[i];
            let turning = twist.z;
            let swing = rates[i] - turning;
            let speed_along = twist.x * cos + twist.y * sin;
            let offset_acceleration = acceleration.y * cos
                - acceleration.x * sin
                - acceleration.z * along[i]
                - turning * (speed_along + speed_along + turning * offsets[i]);
            acceleration.z + (offset_acceleration + swing * swing * offsets[i]) / cosines[i]
        }),
    ]
}
