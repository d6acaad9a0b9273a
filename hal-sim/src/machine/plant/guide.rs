//! What a guide does to platform and ring beside leading them: it gives way across, rubs along, and ends.

use nalgebra::Vector3;

use super::friction::{Friction, FrictionState};
use super::geometry::GuideState;
use super::parameters::PlantParameters;
use super::stops::EndStops;

/// Precomputed constants of the guides.
#[derive(Clone, Copy, Debug)]
pub struct Guides {
    /// Across a guide, N/m and N s/m; none while the guides are rigid.
    across: Option<(f64, f64)>,
    pub friction: Friction,
    pub stops: EndStops,
}

/// Forces of one guide: across it, against the gap, and along it, N.
#[derive(Clone, Copy, Debug)]
pub struct GuideForces {
    /// What pushes the pivot towards the left of the guide.
    across_n: f64,
    /// What pushes the pivot outwards along the guide.
    along_n: f64,
    pub bristle_rate_m_s: f64,
}

impl Guides {
    /// Takes the constants, with the switched-off effects left out.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let flags = parameters.imperfections;
        Self {
            across: (flags.guide_compliance).then_some((
                parameters.guide_stiffness_n_m,
                parameters.guide_damping_n_s_m,
            )),
            friction: Friction::new(
                &parameters.guide_friction,
                flags.guide_friction,
                flags.guide_friction,
            ),
            stops: EndStops::new(parameters),
        }
    }

    /// Whether pivots stay on the guides' lines exactly.
    #[must_use]
    pub const fn are_rigid(&self) -> bool {
        self.across.is_none()
    }

    /// What a guide does at these rates, for an integration step of `step_s`.
    #[must_use]
    pub fn forces(
        &self,
        guide: &GuideState,
        twist: &Vector3<f64>,
        ring_rad_s: f64,
        bristle_m: f64,
        step_s: f64,
    ) -> GuideForces {
        let rho_m_s = guide.rho_by_pose().dot(twist) + guide.rho_by_ring_m() * ring_rad_s;
        let FrictionState {
            force: friction_n,
            bristle_rate: bristle_rate_m_s,
        } = self.friction.evaluate(rho_m_s, bristle_m, step_s);
        let across_n = self.across.map_or(0.0, |(stiffness_n_m, damping_n_s_m)| {
            let gap_m_s = guide.gap_by_pose().dot(twist) + guide.gap_by_ring_m() * ring_rad_s;
            -stiffness_n_m * guide.gap_m - damping_n_s_m * gap_m_s
        });
        GuideForces {
            across_n,
            along_n: self.stops.force_n(guide.rho_m, rho_m_s) - friction_n,
            bristle_rate_m_s,
        }
    }

    /// What holds a carriage that is jammed at a place of its guide, N along the guide: as stiff as the guide's end.
    #[must_use]
    pub fn jam_n(
        &self,
        guide: &GuideState,
        twist: &Vector3<f64>,
        ring_rad_s: f64,
        at_m: f64,
    ) -> f64 {
        let rho_m_s = guide.rho_by_pose().dot(twist) + guide.rho_by_ring_m() * ring_rad_s;
        self.stops.spring_n(at_m - guide.rho_m, rho_m_s)
    }

    /// Energy stored in a guide: across, in its bristles and in its ends, J.
    #[must_use]
    pub fn energy_j(&self, guide: &GuideState, bristle_m: f64) -> f64 {
        let (stiffness_n_m, _) = self.across.unwrap_or((0.0, 0.0));
        0.5 * stiffness_n_m * guide.gap_m * guide.gap_m
            + self.friction.energy_j(bristle_m)
            + self.stops.energy_j(guide.rho_m)
    }
}

impl GuideForces {
    /// Generalised force on (x, y, theta): N, N, N m. By the principle of virtual work.
    #[must_use]
    pub fn on_platform(&self, guide: &GuideState) -> Vector3<f64> {
        self.across_n * guide.gap_by_pose() + self.along_n * guide.rho_by_pose()
    }

    /// Torque on the ring, N m.
    #[must_use]
    pub fn on_ring_n_m(&self, guide: &GuideState) -> f64 {
        self.across_n * guide.gap_by_ring_m() + self.along_n * guide.rho_by_ring_m()
    }
}
