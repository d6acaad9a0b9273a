//! Torque that the platform, its payload and the friction of its guides ask of the pivots.

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
#[inline]
pub fn platform_torques(
    body: &Body,
    guides: &[Guide<f32>; 3],
    twist: &Twist<f32>,
    acceleration: &Acceleration<f32>,
) -> [f32; 3] {
    const NONE: [f32; 3] = [0.0; 3];
    let across = guide_forces(body, guides, twist, acceleration, &NONE);
    pivot_torques(&across, guides, &NONE)
}

/// Pivot torques (N m) for forces across the guides and friction along them, both times the track's radius, N m.
///
/// A pivot feels the force across its guide by the cosine of its angle to the guide, and the friction, which acts back on it along the
/// guide, by the sine, d.
#[inline]
pub fn pivot_torques(across: &[f32; 3], guides: &[Guide<f32>; 3], friction: &[f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| across[i] * guides[i].cosine - friction[i] * guides[i].offset)
}

/// Forces across the guides on the platform, to their left, times the track's radius (N m), for the body's acceleration and against the
/// friction of the carriages. That acts on the platform along each guide, outwards where `friction` is positive, times the track's radius, N m.
///
/// J^T tau = F reads, with f_i = tau_i / c_i the force across guide i and n_i the guides' left normals, `sum f_i n_i =
/// F`, `sum f_i rho_i = M_z`. The n_i stand 120 deg apart, so `f_i = 2/3 n_i F + g` solves the first whatever g is, and
/// the second gives g. Friction makes no moment: guides meet in the centre.
#[inline]
pub fn guide_forces(
    body: &Body,
    guides: &[Guide<f32>; 3],
    twist: &Twist<f32>,
    acceleration: &Acceleration<f32>,
    friction: &[f32; 3],
) -> [f32; 3] {
    let moment = &body.moment;
    let turning = twist.theta * twist.theta;
    let force_x = body.mass * acceleration.x - moment[1] * acceleration.theta - moment[0] * turning;
    let force_y = body.mass * acceleration.y + moment[0] * acceleration.theta - moment[1] * turning;
    // Directions of the guides in the platform's axes: (cos 30 deg, -1/2), (0, 1), (-cos 30 deg, -1/2).
    const HALF_ROOT: f32 = 0.866_025_4;
    let [one, two, three] = *friction;
    let force_x = force_x - HALF_ROOT * (one - three);
    let force_y = force_y + 0.5 * (one + three) - two;
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
    forces.map(|force| force + common)
}
