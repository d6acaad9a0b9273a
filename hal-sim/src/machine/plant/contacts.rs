//! Collisions: which parts that must not touch do, how fast they close, and with what energy.

use nalgebra::Vector3;

use super::Plant;
use super::bumpers::pressed_rad;
use super::pivot_geometry::AXES;

/// Two ends of each guide, and a bumper between each two carriages.
pub const CONTACTS: usize = 3 * AXES;

/// A place where two parts may touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// How far it is pressed in, m; 0 where nothing touches.
    pub pressed_m: f64,
    /// How fast the parts close, m/s; less than 0: they part.
    pub closing_m_s: f64,
    /// Energy of the closing motion, J: of platform, rings and rotors, as much of them as it stops.
    pub energy_j: f64,
}

impl Plant {
    /// All of them: inner and outer ends of the guides, then the carriages.
    #[must_use]
    pub fn contacts(&self) -> [Contact; CONTACTS] {
        let guides = self.guides();
        let jacobian = self.jacobian();
        let motors = self.parameters.motor_inertia_kg_m2 * jacobian.tr_mul(&jacobian);
        let mobility = (self.mass_matrix() + motors).try_inverse();
        let contact = |pressed_m: f64, way_by_pose: Vector3<f64>| {
            let closing_m_s = way_by_pose.dot(&self.state.twist);
            let inverse_kg = mobility.map_or(0.0, |it| way_by_pose.dot(&(it * way_by_pose)));
            let energy_j = if closing_m_s > 0.0 && inverse_kg > 0.0 {
                0.5 * closing_m_s * closing_m_s / inverse_kg
            } else {
                0.0
            };
            Contact {
                pressed_m: pressed_m.max(0.0),
                closing_m_s,
                energy_j,
            }
        };
        let [inner_m, outer_m] = self.parameters.guide_range_m;
        let mut contacts = [Contact::default(); CONTACTS];
        for i in 0..AXES {
            let guide = &guides[i];
            let row = jacobian.row(i).transpose();
            let outwards = guide.rho_by_pose() + guide.rho_by_ring_m() * row;
            contacts[2 * i] = contact(inner_m - guide.rho_m, -outwards);
            contacts[2 * i + 1] = contact(guide.rho_m - outer_m, outwards);
            let radius_m = self.parameters.track_radius_m;
            let closing = (row - jacobian.row((i + 1) % AXES).transpose()) * radius_m;
            let pressed_m = pressed_rad(&self.state.ring_rad, i) * radius_m;
            contacts[2 * AXES + i] = contact(pressed_m, closing);
        }
        contacts
    }
}
