//! What the carriages do on their guides besides rolling: friction along a guide, and giving way across it. No encoder sees either,
//! so both are made up for from the setpoint, by what the controller has been told of them.
//!
//! Friction F of a carriage is a force along its guide on the platform, and the same backwards on its pivot. It joins the torques
//! that the platform asks for ([`friction_torques`]).
//!
//! A guide that gives way by `N / k` under the force N across it leaves the platform behind: it sags by `m a / 1.5 k` while it is
//! accelerated, and keeps what the friction of the other guides leaves in the springs at rest (lost motion, 1.3 F / k to either side). So the
//! pivot leads by as much: `N / (k R c)`, c the cosine of its angle to the guide. A mass on a spring whose foot moves by
//! `x + m x'' / k` moves by x: it does not ring either.

pub mod config;

use self::config::GuideConfig;
use crate::control::inspection::LOOK_TICKS;
use crate::control::pivot_setpoints::PivotSetpoints;
use crate::control::servo::{Presliding, friction_torques};
use crate::control::units::UNITS_PER_RAD;
use kinematics::Angle;

/// Binary places of what a pivot leads, below 2^-32 turns: 2^15 of those are 48 urad, more than a guide gives way.
const LEAD_PLACES: u32 = 16;

/// State of the three guides, as the setpoint has left it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Guides {
    contacts: [Presliding; 3],
    /// Where each carriage was when it was looked at, track radii.
    places: [Option<f32>; 3],
    /// Friction of the carriages times the track's radius, positive where a pivot goes outwards, and the torques that it asks for, N m.
    friction: [f32; 3],
    torques: [f32; 3],
    leads: [Lead; 3],
}

/// What a pivot leads, which goes evenly from one look to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Lead {
    /// 2^-32 turns, with [`LEAD_PLACES`], and the same a tick.
    now: i32,
    step: i32,
    /// rad/s, and rad/s^2 up to the next look: where the jerk steps the rate does, and the ring has to be pushed.
    rate: f32,
    acceleration: f32,
}

impl Guides {
    /// The next setpoint with friction made up for, and with pivots that lead by what their guides give way. In a tick at most one guide is looked
    /// at, that of `turn`.
    #[inline(never)]
    pub fn make_up(
        &mut self,
        told: &GuideConfig,
        rate_hz: f32,
        wanted: &mut PivotSetpoints,
        turn: usize,
    ) {
        self.look_at(told, rate_hz, wanted, turn);
        for i in 0..3 {
            let lead = &mut self.leads[i];
            lead.now = lead.now.wrapping_add(lead.step);
            wanted.angles[i] += Angle::from_units((lead.now >> LEAD_PLACES).into());
            wanted.motion.rates[i] += lead.rate;
            wanted.motion.accelerations[i] += lead.acceleration;
            wanted.torques[i] += self.torques[i];
        }
    }

    #[inline]
    fn look_at(&mut self, told: &GuideConfig, rate_hz: f32, wanted: &PivotSetpoints, turn: usize) {
        let (Some(contact), Some(place), Some(friction), Some(lead)) = (
            self.contacts.get_mut(turn),
            self.places.get_mut(turn),
            self.friction.get_mut(turn),
            self.leads.get_mut(turn),
        ) else {
            return;
        };
        let (Some(&now), Some(&cosine), Some(&torque)) = (
            wanted.lengths.get(turn),
            wanted.cosines.get(turn),
            wanted.torques.get(turn),
        ) else {
            return;
        };
        let way = place.map_or(0.0, |before| now - before);
        *place = Some(now);
        *friction =
            told.coulomb * contact.advance(way * told.presliding_lengths) + told.viscous * way;
        let [across, torques] = friction_torques(&self.friction, &wanted.lengths, &wanted.cosines);
        self.torques = torques;
        if let Some(across) = across.get(turn) {
            let force = torque / cosine + across;
            lead.aim_at(told.compliance * force / cosine, rate_hz);
        }
    }
}

impl Lead {
    /// So many 2^-32 turns, at the next look.
    #[inline]
    fn aim_at(&mut self, units: f32, rate_hz: f32) {
        const PLACES: f32 = (1_u32 << LEAD_PLACES) as f32;
        const LOOK: f32 = LOOK_TICKS as f32;
        const RAD_A_TICK: f32 = (1.0 / UNITS_PER_RAD) as f32 / PLACES;
        // What is more than that is as much, and what is no number nothing.
        let aim = (units * PLACES) as i32;
        self.step = aim.wrapping_sub(self.now) / LOOK_TICKS as i32;
        let rate = self.step as f32 * (RAD_A_TICK * rate_hz);
        self.acceleration = (rate - self.rate) * (rate_hz / LOOK);
        self.rate = rate;
    }
}
