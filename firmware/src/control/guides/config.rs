//! What the guides are, as the tick computes with it.

use crate::control::inspection::LOOK_TICKS;
use crate::control::units::UNITS_PER_RAD;
use crate::parameters::Parameters;

/// Constants of the guides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideConfig {
    /// Coulomb friction of a carriage times the track's radius, N m.
    pub(super) coulomb: f32,
    /// Viscous friction, in N m for a way of one track radius between two looks at a guide.
    pub(super) viscous: f32,
    /// Presliding lengths in a track radius.
    pub(super) presliding_lengths: f32,
    /// What a pivot leads for a force across its guide times the track's radius, 2^-32 turns for each N m; 0: guides are rigid.
    pub(super) compliance: f32,
}

impl GuideConfig {
    /// Derives the constants; `None` where there is nothing to be made up for.
    pub fn new(parameters: &Parameters) -> Option<Self> {
        let guides = &parameters.guides;
        let radius_m = parameters.geometry.radius_mm * 1e-3;
        let look_s = f64::from(LOOK_TICKS) / parameters.limits.rate_hz;
        let stiffness_n_m = guides.stiffness_n_um * 1e6;
        guides.are_told().then(|| Self {
            coulomb: (guides.coulomb_n * radius_m) as f32,
            viscous: (guides.viscous_n_s_m * radius_m * radius_m / look_s) as f32,
            presliding_lengths: (radius_m / (guides.presliding_um * 1e-6)) as f32,
            compliance: if stiffness_n_m > 0.0 {
                (UNITS_PER_RAD / (stiffness_n_m * radius_m * radius_m)) as f32
            } else {
                0.0
            },
        })
    }
}
