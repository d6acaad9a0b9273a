//! An instrument that reads x and y of one target on the platform, in axes of its own.

use calibration::{Noise, Seen, Visit};

use super::interferometer::Interferometer;
use super::quasi_static::QuasiStatic;
use crate::machine::plant::OffGuide;
use crate::random::Random;

/// Where it stands and where its target is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target(Interferometer);

impl Target {
    /// Set up by hand some tenths of a mm from where it should be: 30 and 20 mm from the platform's centre.
    #[must_use]
    pub fn set_up(noise: Noise, random: &mut Random) -> Self {
        let mut instrument = Interferometer::set_up(noise, random);
        instrument.target[0] += 0.03;
        instrument.target[1] += 0.02;
        Self(instrument)
    }

    /// Reads the machine at a pose (m, m, rad).
    ///
    /// # Errors
    /// [`OffGuide`]: the machine cannot be there.
    pub fn visit(
        &self,
        machine: &QuasiStatic,
        pose: [f64; 3],
        random: &mut Random,
    ) -> Result<Visit, OffGuide> {
        let visit = self.0.visit(machine, pose, random)?;
        let seen = place_of(visit.seen);
        Ok(Visit { seen, ..visit })
    }

    /// Reads a platform at a pose (m, m, rad).
    pub fn read(&self, pose: [f64; 3], radius_m: f64, random: &mut Random) -> Seen {
        place_of(self.0.read(pose, radius_m, random))
    }
}

const fn place_of(seen: Seen) -> Seen {
    match seen {
        Seen::Pose([x, y, _]) => Seen::Place([x, y]),
        other => other,
    }
}
