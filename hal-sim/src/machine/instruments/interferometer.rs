//! An instrument that reads x, y and theta of a target on the platform, in axes of its own.

use calibration::{Noise, Seen, Visit};
use nalgebra::{Rotation2, Vector2};

use super::quasi_static::QuasiStatic;
use crate::machine::plant::OffGuide;
use crate::random::Random;

/// Where it stands and where its target is: both as somebody has put them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interferometer {
    /// Its axes in the base frame: x, y (m), angle (rad).
    pub axes: [f64; 3],
    /// Its target in the platform frame: x, y (m), angle (rad).
    pub target: [f64; 3],
    /// Its noise, track radii and rad, and the encoders'.
    pub noise: Noise,
}

impl Interferometer {
    /// Set up by hand: some tenths of a mm, some mrad.
    #[must_use]
    pub fn set_up(noise: Noise, random: &mut Random) -> Self {
        let mut by_hand = || [3e-4, 3e-4, 3e-3].map(|size: f64| size * random.normal());
        Self {
            axes: by_hand(),
            target: by_hand(),
            noise,
        }
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
        Ok(Visit {
            readings_rad: noisy(machine.visited_rad(pose, random)?, &self.noise, random),
            seen: self.read(pose, machine.track_radius_m(), random),
        })
    }

    /// Reads a platform at a pose (m, m, rad).
    pub fn read(&self, pose: [f64; 3], radius_m: f64, random: &mut Random) -> Seen {
        let [target_x, target_y, target_angle] = self.target;
        let [axes_x, axes_y, axes_angle] = self.axes;
        let arm = Rotation2::new(pose[2]) * Vector2::new(target_x, target_y);
        let from_origin = Vector2::new(pose[0] - axes_x, pose[1] - axes_y) + arm;
        let place = Rotation2::new(-axes_angle) * from_origin / radius_m;
        let Noise {
            length, angle_rad, ..
        } = self.noise;
        Seen::Pose([
            place.x + length * random.normal(),
            place.y + length * random.normal(),
            pose[2] + target_angle - axes_angle + angle_rad * random.normal(),
        ])
    }
}

/// Readings with the encoders' noise.
pub(super) fn noisy(readings_rad: [f64; 3], noise: &Noise, random: &mut Random) -> [f64; 3] {
    readings_rad.map(|reading_rad| reading_rad + noise.encoder_rad * random.normal())
}
