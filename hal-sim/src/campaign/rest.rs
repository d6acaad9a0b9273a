//! How a stage comes to rest once a reaction has to begin: way, turn, depth and blows. Measured alike on the stage of a run and on the
//! copy of it with which that is compared.

use super::truth::{Path, fastest_rad_s, overrun_mm, place_mm};
use crate::machine::plant::{CONTACTS, Plant};

/// Ticks between two looks at the path: 0.2 mm at full speed.
pub(super) const LOOK_EVERY: u64 = 20;
/// Slower than this a pivot is at rest, rad/s.
pub(super) const AT_REST_RAD_S: f64 = 0.01;

/// From here to rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToRest {
    /// Way of the platform's centre, mm.
    pub way_mm: f64,
    /// Turn of the platform, deg.
    pub turn_deg: f64,
    /// Deepest that a guide was pressed into its end, mm.
    pub depth_mm: f64,
    /// Largest energy of a blow against a guide's end or a carriage's bumper, J.
    pub blow_j: f64,
    /// Furthest from the path of the setpoint, mm.
    pub deviation_mm: f64,
    /// Whether it has come to rest.
    pub rests: bool,
}

/// Follows a plant to rest.
#[derive(Clone, Debug, Default)]
pub(super) struct Rests {
    path: Path,
    turned_from: Option<f64>,
    touched: [bool; CONTACTS],
    so_far: ToRest,
}

impl Rests {
    /// Looks, in each tick. The deviation is from `asked`.
    pub fn look(&mut self, tick: u64, plant: &Plant, asked: &Path) {
        self.look_for_blows(plant);
        if !tick.is_multiple_of(LOOK_EVERY) {
            return;
        }
        let [x, y, theta] = plant.pose();
        let from = *self.turned_from.get_or_insert(theta);
        self.path.go([x * 1e3, y * 1e3]);
        let far = &mut self.so_far;
        far.turn_deg = far.turn_deg.max((theta - from).abs().to_degrees());
        far.depth_mm = far.depth_mm.max(overrun_mm(plant));
        far.deviation_mm = far.deviation_mm.max(asked.distance(place_mm(plant)));
        far.rests = fastest_rad_s(plant) < AT_REST_RAD_S;
    }

    fn look_for_blows(&mut self, plant: &Plant) {
        for (touched, contact) in self.touched.iter_mut().zip(plant.contacts()) {
            let touches = contact.pressed_m > 0.0;
            if touches && !*touched {
                self.so_far.blow_j = self.so_far.blow_j.max(contact.energy_j);
            }
            *touched = touches;
        }
    }

    /// What it came to.
    pub fn to_rest(&self) -> ToRest {
        ToRest {
            way_mm: self.path.length(),
            ..self.so_far
        }
    }
}
