//! An instrument beside a machine that moves: it is set up once, and reads the platform's true pose.

use calibration::plan::At;
use calibration::{Instrument, Kit, Seen};

use super::camera::Camera;
use super::interferometer::Interferometer;
use super::target::Target;
use crate::random::Random;

/// Between the seeds of two readings.
const SEED_STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// See the module.
#[derive(Clone, Debug)]
pub struct Beside {
    set_up: SetUp,
    seed: u64,
    radius_m: f64,
}

#[derive(Clone, Debug)]
enum SetUp {
    Beams(Interferometer, Kit),
    Target(Target),
    Camera(Camera),
}

impl Beside {
    /// Set up by hand, the same way for the same seed. `None` for ends of guides, which are no instrument.
    #[must_use]
    pub fn set_up(instrument: &Instrument, radius_m: f64, seed: u64) -> Option<Self> {
        let random = &mut Random::new(seed);
        let noise = instrument.noise;
        let set_up = match instrument.kit {
            Kit::Xyt | Kit::Theta => {
                SetUp::Beams(Interferometer::set_up(noise, random), instrument.kit)
            }
            Kit::Xy => SetUp::Target(Target::set_up(noise, random)),
            Kit::Camera | Kit::Camera2 | Kit::Balls => {
                SetUp::Camera(Camera::set_up(instrument, radius_m, random))
            }
            Kit::Ends => return None,
        };
        Some(Self {
            set_up,
            seed,
            radius_m,
        })
    }

    /// Reads a platform at a pose (m, m, rad) for the visit of this number, whose noise is its own: a measurement that is taken up again
    /// goes on as if it had not been interrupted. `None`: nothing is seen there.
    #[must_use]
    pub fn read(&self, at: At, pose: [f64; 3], visit: usize) -> Option<Seen> {
        let number = 1 + visit as u64;
        let random = &mut Random::new(self.seed.wrapping_add(number.wrapping_mul(SEED_STEP)));
        match (&self.set_up, at) {
            (SetUp::Beams(beams, kit), At::Pose) => {
                Some(match (kit, beams.read(pose, self.radius_m, random)) {
                    (Kit::Theta, Seen::Pose([_, _, theta])) => Seen::Turn(theta),
                    (_, seen) => seen,
                })
            }
            (SetUp::Target(target), At::Pose) => Some(target.read(pose, self.radius_m, random)),
            (SetUp::Camera(plate), At::Mark { mark, camera }) => {
                plate.look((mark, camera), pose, self.radius_m, random)
            }
            _ => None,
        }
    }
}
