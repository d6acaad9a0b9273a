//! No instrument: the stage drives a pivot against an end of its guide, and its encoders tell where it stopped.

use calibration::{Instrument, Seen, Visit};

use super::interferometer::noisy;
use super::quasi_static::QuasiStatic;
use crate::machine::plant::OffGuide;
use crate::random::Random;

/// The ends as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Ends {
    instrument: Instrument,
    /// Guide and place on it, m.
    places_m: Vec<(usize, f64)>,
}

impl Ends {
    /// Every end 0.3 mm from where it was drawn, one standard deviation.
    #[must_use]
    pub fn set_up(instrument: &Instrument, track_radius_m: f64, random: &mut Random) -> Self {
        let place = |&(guide, drawn): &(usize, f64)| {
            (guide, drawn * track_radius_m + 0.3e-3 * random.normal())
        };
        Self {
            instrument: instrument.clone(),
            places_m: instrument.ends.iter().map(place).collect(),
        }
    }

    /// Drives along the guide from a pose (m, m, rad) near an end until that is touched. Where the pivot stops is repeatable to the
    /// instrument's noise.
    ///
    /// # Errors
    /// [`OffGuide`]: the machine cannot be there.
    pub fn visit(
        &self,
        machine: &QuasiStatic,
        end: usize,
        pose: [f64; 3],
        random: &mut Random,
    ) -> Result<Visit, OffGuide> {
        const STEPS: usize = 8;
        let noise = self.instrument.noise;
        let (guide, place_m) = self.places_m[end];
        let stop_m = place_m + noise.length * machine.track_radius_m() * random.normal();
        let mut pose = pose;
        for _ in 0..STEPS {
            // Along its own guide the platform leaves this ring where it is.
            let (rho_m, [by_x, by_y, _]) = machine.place_on_guide(guide, pose)?;
            pose[0] -= (rho_m - stop_m) * by_x;
            pose[1] -= (rho_m - stop_m) * by_y;
        }
        Ok(Visit {
            readings_rad: noisy(machine.visited_rad(pose, random)?, &noise, random),
            seen: Seen::End { end },
        })
    }
}
