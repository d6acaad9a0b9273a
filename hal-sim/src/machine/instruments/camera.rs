//! A camera at fixed places over a plate of marks on the platform: the stage brings a mark under it, and it tells the little that is
//! left. Its own scale, distortion and turn matter no more, and the plate is known to nobody. Two gauges across each other do the same with balls.

use calibration::{Instrument, Kit, Seen, Visit};
use nalgebra::{Rotation2, Vector2};

use super::interferometer::noisy;
use super::quasi_static::QuasiStatic;
use crate::machine::plant::OffGuide;
use crate::random::Random;

/// The camera's places and the plate as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    instrument: Instrument,
    /// Places of the camera in the base frame, m.
    pub cameras_m: Vec<Vector2<f64>>,
    /// Marks in the platform frame, m.
    pub marks_m: Vec<Vector2<f64>>,
}

/// How well the stage finds a mark before it looks, m.
const FOUND_M: f64 = 1e-6;
/// Half the width of the camera's picture, and of what gauges reach, m; and scale, turn and distortion of either.
const FIELD_M: f64 = 5e-3;
const GAUGES_M: f64 = 2e-3;
const OPTICS_SCALE: f64 = 1.02;
const OPTICS_RAD: f64 = 10e-3;
const OPTICS_DISTORTION: f64 = 0.01;

impl Camera {
    /// Every mark 0.1 mm and every place of the camera 0.5 mm from where the instrument says, one standard deviation; but the marks'
    /// mean distance from the plate's middle is what it should be: that length is known.
    #[must_use]
    pub fn set_up(instrument: &Instrument, track_radius_m: f64, random: &mut Random) -> Self {
        let mut near = |places: &[[f64; 2]], size_m: f64| -> Vec<Vector2<f64>> {
            (places.iter())
                .map(|&place| {
                    let off_m = Vector2::new(random.normal(), random.normal()) * size_m;
                    Vector2::from(place) * track_radius_m + off_m
                })
                .collect()
        };
        let cameras_m = near(&instrument.cameras, 0.5e-3);
        let mut marks_m = near(&instrument.marks, 0.1e-3);
        let drawn = || instrument.marks.iter().map(|&mark| Vector2::from(mark));
        let along: f64 = drawn()
            .zip(&marks_m)
            .map(|(drawn, mark)| drawn.dot(mark))
            .sum();
        let square: f64 = drawn().map(|drawn| drawn.norm_squared()).sum();
        for mark in &mut marks_m {
            *mark *= square * track_radius_m / along;
        }
        Self {
            instrument: instrument.clone(),
            cameras_m,
            marks_m,
        }
    }

    /// Brings a mark under a place of the camera at an orientation, rad, and looks.
    ///
    /// # Errors
    /// [`OffGuide`]: the machine cannot be there.
    pub fn visit(
        &self,
        machine: &QuasiStatic,
        (mark, camera): (usize, usize),
        theta_rad: f64,
        random: &mut Random,
    ) -> Result<Visit, OffGuide> {
        let noise = self.instrument.noise;
        let off_m = Vector2::new(random.normal(), random.normal()) * FOUND_M;
        let turned = Rotation2::new(theta_rad) * self.marks_m[mark];
        let centre_m = self.cameras_m[camera] + off_m - turned;
        let readings_rad = machine.visited_rad([centre_m.x, centre_m.y, theta_rad], random)?;
        let off = off_m / machine.track_radius_m();
        Ok(Visit {
            readings_rad: noisy(readings_rad, &noise, random),
            seen: Seen::Mark {
                mark,
                camera,
                off: [
                    off.x + noise.length * random.normal(),
                    off.y + noise.length * random.normal(),
                ],
            },
        })
    }

    /// Looks at a platform at a pose (m, m, rad), through optics whose scale, turn and distortion nobody has measured. `None`: the mark
    /// is not in the picture, or the ball out of the gauges' reach.
    pub fn look(
        &self,
        (mark, camera): (usize, usize),
        pose: [f64; 3],
        radius_m: f64,
        random: &mut Random,
    ) -> Option<Seen> {
        let place_m =
            Vector2::new(pose[0], pose[1]) + Rotation2::new(pose[2]) * self.marks_m.get(mark)?;
        let off_m = place_m - self.cameras_m.get(camera)?;
        let reach_m = if self.instrument.kit == Kit::Balls {
            GAUGES_M
        } else {
            FIELD_M
        };
        let share = off_m.norm() / reach_m;
        if share > 1.0 {
            return None;
        }
        let imaged =
            Rotation2::new(OPTICS_RAD) * off_m * (OPTICS_SCALE + OPTICS_DISTORTION * share * share);
        let length = self.instrument.noise.length;
        Some(Seen::Mark {
            mark,
            camera,
            off: [
                imaged.x / radius_m + length * random.normal(),
                imaged.y / radius_m + length * random.normal(),
            ],
        })
    }
}
