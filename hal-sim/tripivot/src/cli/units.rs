//! Between the units people type (mm, deg) and those of the kinematics (track radii, rad).

use kinematics::{Geometry, Pose};

/// The pose of x and y in mm and theta in deg.
pub(super) fn pose_from([x_mm, y_mm, theta_deg]: [f64; 3]) -> Pose<f64> {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    Pose {
        x: x_mm / radius_mm,
        y: y_mm / radius_mm,
        theta: theta_deg.to_radians(),
    }
}

/// x and y in mm and theta in deg.
pub(super) fn pose_to(pose: &Pose<f64>) -> [f64; 3] {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    [
        pose.x * radius_mm,
        pose.y * radius_mm,
        pose.theta.to_degrees(),
    ]
}

/// The whole turns in an angle, deg: what is left when they are taken off is within half a turn of zero, and exact. They
/// are put back in deg, so that radians never have to hold them, which would cost digits.
pub(super) fn whole_turns_deg(angle_deg: f64) -> f64 {
    360.0 * (angle_deg / 360.0).round()
}

/// Twelve decimals, without the sign of a zero.
pub(super) fn decimals(value: f64) -> String {
    let text = format!("{value:.12}");
    if text == "-0.000000000000" {
        return "0.000000000000".to_owned();
    }
    text
}
