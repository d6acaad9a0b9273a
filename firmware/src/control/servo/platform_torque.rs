//! Torque that the platform and its payload, and the friction of the carriages, ask of the pivots.

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
    let moment = &body.moment;
    let turning = twist.theta * twist.theta;
    let force_x = body.mass * acceleration.x - moment[1] * acceleration.theta - moment[0] * turning;
    let force_y = body.mass * acceleration.y + moment[0] * acceleration.theta - moment[1] * turning;
    let torque =
        body.inertia * acceleration.theta + moment[0] * acceleration.y - moment[1] * acceleration.x;
    let lengths = [guides[0].rho(), guides[1].rho(), guides[2].rho()];
    let across = forces_across([force_x, force_y], torque, &lengths);
    [0, 1, 2].map(|i| across[i] * guides[i].cosine)
}

/// Forces across the guides on the platform, to their left, that make a force and a torque; all forces times the track's radius, N m.
///
/// J^T tau = F reads, with f_i = tau_i / c_i the force across guide i and n_i the guides' left normals, `sum f_i n_i =
/// F`, `sum f_i rho_i = M_z`. The n_i stand 120 deg apart, so `f_i = 2/3 n_i F + g` solves the first whatever g is, and
/// the second gives g.
#[inline]
fn forces_across([force_x, force_y]: [f32; 2], torque: f32, lengths: &[f32; 3]) -> [f32; 3] {
    // n_i in the platform's axes: (1/2, cos 30 deg), (-1, 0), (1/2, -cos 30 deg).
    const THIRD: f32 = 1.0 / 3.0;
    const WIDE: f32 = 0.577_350_26;
    let (along, across) = (THIRD * force_x, WIDE * force_y);
    let forces = [along + across, -2.0 * along, along - across];
    let have = forces[0] * lengths[0] + forces[1] * lengths[1] + forces[2] * lengths[2];
    let common = (torque - have) / (lengths[0] + lengths[1] + lengths[2]);
    forces.map(|force| force + common)
}

/// What the carriages' friction asks for: forces across the guides, and pivot torques, N m. Friction acts on the platform along each guide,
/// outwards where it is positive; forces are times the track's radius, N m.
///
/// It makes no moment, since guides meet in the centre. A pivot feels the force across its guide by the cosine c of its angle to the
/// guide, and the friction, which acts back on it along the guide, by the sine d: `tau_i = N_i c_i - f_i d_i`. The centre's places along the
/// guides, q = c - rho, give that across them: guides stand 120 deg apart, so that `d_1 = (q_2 - q_3) / sqrt 3`.
#[inline]
pub fn friction_torques(
    friction: &[f32; 3],
    lengths: &[f32; 3],
    cosines: &[f32; 3],
) -> [[f32; 3]; 2] {
    // Directions of the guides in the platform's axes: (cos 30 deg, -1/2), (0, 1), (-cos 30 deg, -1/2).
    const HALF_ROOT: f32 = 0.866_025_4;
    const BY_ROOT: f32 = 0.577_350_26;
    let [one, two, three] = *friction;
    let force = [HALF_ROOT * (three - one), 0.5 * (one + three) - two];
    let across = forces_across(force, 0.0, lengths);
    let [a, b, c] = [0, 1, 2].map(|i| cosines[i] - lengths[i]);
    let sines = [b - c, c - a, a - b].map(|difference| BY_ROOT * difference);
    let torques = [0, 1, 2].map(|i| across[i] * cosines[i] - friction[i] * sines[i]);
    [across, torques]
}
