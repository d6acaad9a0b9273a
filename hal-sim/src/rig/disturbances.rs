//! What a script's disturbances do to a simulated stage from tick to tick.

use script::Disturbance;
use script::disturbance::{Action, Direction};

use crate::machine::plant::{External, Plant};

/// The disturbances that act.
#[derive(Clone, Debug, Default)]
pub struct Disturbances {
    /// Each with the time since it began.
    acting: Vec<(Disturbance, f64)>,
    /// The plant has to be told, once more after the last one.
    acted: bool,
}

impl Disturbances {
    /// From the next tick on, in place of what it replaces.
    pub fn begin(&mut self, disturbance: Disturbance) {
        (self.acting).retain(|(older, _)| !older.is_replaced_by(&disturbance));
        self.acting.push((disturbance, 0.0));
    }

    /// Acts on the plant for a tick. Nothing is touched where there is none.
    pub fn act(&mut self, plant: &mut Plant, period_s: f64) {
        if self.acting.is_empty() && !self.acted {
            return;
        }
        let mut external = External::default();
        self.acting.retain_mut(|(disturbance, time_s)| {
            let Some(value) = disturbance.value_after(*time_s) else {
                return false;
            };
            *time_s += period_s;
            match (disturbance.action, disturbance.direction) {
                (Action::Push(_), Direction::X) => external.force_n[0] = value,
                (Action::Push(_), Direction::Y) => external.force_n[1] = value,
                (Action::Push(_), Direction::W) => external.torque_n_m = value,
                (Action::Shake { .. }, Direction::X) => external.floor_m_s2[0] = value,
                (Action::Shake { .. }, Direction::Y) => external.floor_m_s2[1] = value,
                // The script's check lets none through.
                (Action::Shake { .. }, Direction::W) => {}
            }
            true
        });
        self.acted = !self.acting.is_empty();
        plant.set_external(external);
    }
}
