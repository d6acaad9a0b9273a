//! What the carriages do on their guides besides rolling: friction along a guide, and giving way across it. No encoder sees either,
//! so both are made up for from the setpoint, by what the controller has been told of them.
//!
//! Friction F of a carriage is a force along its guide on the platform, and the same backwards on its pivot. It joins the torques
//! that the platform asks for ([`guide_forces`](super::servo::guide_forces)).
//!
//! A guide that gives way by `N / k` under the force N across it leaves the platform behind: it sags by `m a / 1.5 k` while it is
//! accelerated, and keeps what the friction of the other guides leaves in the springs at rest (lost motion, 1.3 F / k to either side). So the
//! pivot leads by as much: `N / (k R c)`, c the cosine of its angle to the guide. A mass on a spring whose foot moves by
//! `x + m x'' / k` moves by x: it does not ring either.

use super::config::Config;
use super::inspection::INSPECTION_PERIOD_TICKS;
use super::pivot_setpoints::PivotSetpoints;
use super::servo::Presliding;
use super::units::UNITS_PER_RAD;
use crate::number;
use crate::parameters::Parameters;
use kinematics::Angle;

/// Of what pivots lead, from one tick to the next: its rate steps where the jerk does, and the push for that is spread over 0.4 ms. What it lags
/// behind for that is some nanometres.
const SMOOTHING: f32 = 0.25;

/// Constants of the guides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideConfig {
    /// Coulomb friction of a carriage times the track's radius, N m.
    coulomb: f32,
    /// Viscous friction, in N m for a way of one track radius between two looks at a guide.
    viscous: f32,
    /// Presliding lengths in a track radius.
    presliding_lengths: f32,
    /// What a pivot leads for a force across its guide times the track's radius, 2^-32 turns for each N m; 0: guides are rigid.
    compliance: f32,
}

impl GuideConfig {
    /// Derives the constants.
    pub fn new(parameters: &Parameters) -> Self {
        let guides = &parameters.guides;
        let radius_m = parameters.geometry.radius_mm * 1e-3;
        let look_s = f64::from(INSPECTION_PERIOD_TICKS) / parameters.limits.rate_hz;
        let stiffness_n_m = guides.stiffness_n_um * 1e6;
        Self {
            coulomb: (guides.coulomb_n * radius_m) as f32,
            viscous: (guides.viscous_n_s_m * radius_m * radius_m / look_s) as f32,
            presliding_lengths: (radius_m / (guides.presliding_um * 1e-6)) as f32,
            compliance: if stiffness_n_m > 0.0 {
                (UNITS_PER_RAD / (stiffness_n_m * radius_m * radius_m)) as f32
            } else {
                0.0
            },
        }
    }

    /// Whether there is anything to be made up for.
    #[inline]
    fn is_ideal(&self) -> bool {
        self.coulomb == 0.0 && self.viscous == 0.0 && self.compliance == 0.0
    }
}

/// State of the three guides, as the setpoint has left it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Guides {
    contacts: [Presliding; 3],
    /// Where each carriage was when it was looked at, track radii.
    places: [Option<f32>; 3],
    /// Friction, N m.
    friction: [f32; 3],
    /// What a pivot leads for each N m across its guide, 2^-32 turns.
    lead_per_torque: [f32; 3],
    /// What it leads, 2^-32 turns, and how fast that has changed, rad/s.
    lead: [f32; 3],
    lead_rate: [f32; 3],
}

impl Guides {
    /// Friction of the carriages, times the track's radius: N m, positive where a pivot goes outwards.
    #[inline]
    pub fn friction(&self) -> &[f32; 3] {
        &self.friction
    }

    /// The next setpoint: its pivots lead by what their guides give way. Friction is looked at for one guide a tick, that of the pivot that has
    /// its turn: what it is a few ticks later it hardly differs from.
    #[inline]
    pub fn lead(&mut self, config: &Config, wanted: &mut PivotSetpoints, turn: usize) {
        if !config.guides.is_ideal() {
            self.look_at(&config.guides, wanted, turn);
            if config.guides.compliance != 0.0 {
                self.add_lead(config.limits.rate_hz, wanted);
            }
        }
    }

    #[inline(never)]
    fn look_at(&mut self, config: &GuideConfig, wanted: &PivotSetpoints, turn: usize) {
        let (Some(contact), Some(place), Some(friction), Some(lead_per_torque)) = (
            self.contacts.get_mut(turn),
            self.places.get_mut(turn),
            self.friction.get_mut(turn),
            self.lead_per_torque.get_mut(turn),
        ) else {
            return;
        };
        let (Some(&now), Some(&cosine)) = (wanted.lengths.get(turn), wanted.cosines.get(turn))
        else {
            return;
        };
        let way = place.map_or(0.0, |before| now - before);
        *place = Some(now);
        *friction = config.coulomb * contact.advance(way * config.presliding_lengths)
            + config.viscous * way;
        *lead_per_torque = config.compliance / cosine;
    }

    #[inline(never)]
    fn add_lead(&mut self, rate_hz: f32, wanted: &mut PivotSetpoints) {
        const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
        for i in 0..3 {
            let now = self.lead_per_torque[i] * wanted.across[i];
            let step = SMOOTHING * (now - self.lead[i]);
            let lead = self.lead[i] + step;
            let rate = step * (RAD * rate_hz);
            // Where the jerk steps the rate does: the ring has to be pushed.
            wanted.motion.accelerations[i] += (rate - self.lead_rate[i]) * rate_hz;
            wanted.motion.rates[i] += rate;
            self.lead[i] = lead;
            self.lead_rate[i] = rate;
            wanted.angles[i] += Angle::from_units(number::round_ties_even(lead).0.into());
        }
    }
}
