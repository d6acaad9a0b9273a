//! Torque that the platform and its payload ask of the pivots.

use crate::parameters::Parameters;
use kinematics::{Acceleration, Guide, Twist};

/// The carried body, about the platform centre; lengths in track radii, masses times radius squared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass times track radius squared, kg m^2.
    pub mass: f32,
    /// Moment of inertia about the platform centre, kg m^2.
    pub inertia: f32,
    /// Static moment in the platform's axes: mass times the centre of mass, kg m^2.
    pub moment: [f32; 2],
}

impl Body {
    /// Platform and payload together.
    pub fn new(parameters: &Parameters) -> Self {
        let platform = &parameters.platform;
        let radius_m = parameters.geometry.radius_mm * 1e-3;
        let [x_m, y_m] = platform.payload_centre_mm.map(|mm| mm * 1e-3);
        Self {
            mass: ((platform.mass_kg + platform.payload_kg) * radius_m * radius_m) as f32,
            inertia: (platform.inertia_kg_m2
                + platform.payload_inertia_kg_m2
                + platform.payload_kg * (x_m * x_m + y_m * y_m)) as f32,
            moment: [x_m, y_m].map(|m| (platform.payload_kg * m * radius_m) as f32),
        }
    }
}

/// Pivot torques (N m) for the body's acceleration: `tau = J^-T M x''`, velocity-dependent terms included. Twist and
/// acceleration are those along the platform's axes (`kinematics::in_platform_axes`), in which the body does not
/// change.
///
/// J^T tau = F reads, with f_i = tau_i / c_i the force across guide i and n_i the guides' left normals, `sum f_i n_i =
/// F`, `sum f_i rho_i = M_z`. The n_i stand 120 deg apart, so `f_i = 2/3 n_i F + g` solves the first whatever g is, and
/// the second gives g.
#[inline]
pub fn platform_torques(
    body: &Body,
    guides: &[Guide<f32>; 3],
    twist: &Twist<f32>,
    acceleration: &Acceleration<f32>,
) -> [f32; 3] {
    let moment = &body.moment;
    let turning = twist.theta * twist.theta;
    let force_x = body.mass * acceleration.x - moment[1] * acceleration.theta - moment[0] * turning;
    let force_y = body.mass * acceleration.y + moment[0] * acceleration.theta - moment[1] * turning;
    let torque =
        body.inertia * acceleration.theta + moment[0] * acceleration.y - moment[1] * acceleration.x;
    // n_i in the platform's axes: (1/2, cos 30 deg), (-1, 0), (1/2, -cos 30 deg).
    const THIRD: f32 = 1.0 / 3.0;
    const WIDE: f32 = 0.577_350_26;
    let (along, across) = (THIRD * force_x, WIDE * force_y);
    let forces = [along + across, -2.0 * along, along - across];
    let arms = [guides[0].rho(), guides[1].rho(), guides[2].rho()];
    let have = forces[0] * arms[0] + forces[1] * arms[1] + forces[2] * arms[2];
    let common = (torque - have) / (arms[0] + arms[1] + arms[2]);
    [
        (forces[0] + common) * guides[0].cosine,
        (forces[1] + common) * guides[1].cosine,
        (forces[2] + common) * guides[2].cosine,
    ]
}
