//! What an instrument measures, how well, and what is unknown about the instrument itself.

use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::MACHINE_NUMBERS;
use crate::numbers;

/// Kinds of instruments.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kit {
    /// x, y and theta of the platform, as an interferometer with three beams or a coordinate measuring machine gives them.
    Xyt,
    /// x and y of one target on the platform.
    Xy,
    /// theta of the platform, as an autocollimator or a rotary encoder gives it.
    Theta,
    /// A camera over a plate of marks on the platform whose places are not known well.
    Camera,
    /// The same camera at two places, one after the other.
    Camera2,
    /// Two gauges across each other against balls on the platform whose places are not known well, at two places, one after the other.
    Balls,
    /// No instrument: pivots driven against the ends of their guides.
    Ends,
}

/// All kits.
pub const KITS: [Kit; 7] = [
    Kit::Xyt,
    Kit::Xy,
    Kit::Theta,
    Kit::Camera,
    Kit::Camera2,
    Kit::Balls,
    Kit::Ends,
];

impl Kit {
    /// Numbers that it reads at a pose, or learns there.
    #[must_use]
    pub const fn rows(self) -> usize {
        match self {
            Self::Xyt => 3,
            Self::Xy | Self::Camera | Self::Camera2 | Self::Balls => 2,
            Self::Theta | Self::Ends => 1,
        }
    }

    /// Its name in files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xyt => "xyt",
            Self::Xy => "xy",
            Self::Theta => "theta",
            Self::Camera => "camera",
            Self::Camera2 => "camera2",
            Self::Balls => "balls",
            Self::Ends => "ends",
        }
    }
}

impl fmt::Display for Kit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no such kit.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("'{0}' is no kit: there are xyt, xy, theta, camera, camera2, balls, ends")]
pub struct UnknownKit(pub String);

impl FromStr for Kit {
    type Err = UnknownKit;

    fn from_str(text: &str) -> Result<Self, UnknownKit> {
        let known = KITS.into_iter().find(|kit| kit.name() == text);
        known.ok_or_else(|| UnknownKit(text.to_owned()))
    }
}

/// Standard deviations of one measurement.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Noise {
    /// Of each of x and y, track radii.
    pub length: f64,
    /// Of theta, rad.
    pub angle_rad: f64,
    /// Of each encoder's reading, rad; with it what the machine itself does not repeat.
    pub encoder_rad: f64,
}

impl Noise {
    /// Encoder readings in the mean of some ticks: a third of an LSB of 26 bits.
    pub const ENCODER_RAD: f64 = 30e-9;
}

/// An instrument in front of a stage: its kind, its noise, and roughly where its parts are.
#[derive(Clone, PartialEq, Debug)]
pub struct Instrument {
    /// What it is.
    pub kit: Kit,
    /// How well it measures.
    pub noise: Noise,
    /// Axes of the instrument in the base frame (x, y, angle), then its target in the platform's (x, y, angle); not of cameras.
    pub alignment: [f64; 6],
    /// Marks in the platform frame, of cameras; balls, of gauges.
    pub marks: Vec<[f64; 2]>,
    /// Places of the camera, or of the gauges, in the base frame.
    pub cameras: Vec<[f64; 2]>,
    /// Ends of guides that pivots can touch: which guide, from 0, and where on it.
    pub ends: Vec<(usize, f64)>,
    /// How well the mean distance of the marks or balls is known, as a share of it: it alone gives cameras and gauges their scale.
    pub scale: f64,
}

/// How well instruments are set up by hand: 5 mm and 50 mrad; a camera to 1 mm.
const ALIGNMENT: f64 = 0.05;
const CAMERA: f64 = 0.01;
/// How well marks are placed, and the plate on the platform: 0.1 mm.
const MARK: f64 = 1e-3;
/// Where guides end by the drawing, the inner end first, track radii; and how well they do: 0.5 mm.
pub const GUIDE_ENDS: [f64; 2] = [0.16, 1.84];
const END: f64 = 5e-3;
/// How well the mean distance of a plate's marks is known; and that of the balls: 1 um.
const SCALE: f64 = 1e-6;
const BALLS_SCALE: f64 = 2e-5;
/// Pitch of the marks and radius of the plate, and places of the camera: both away from the track's centre, 90 mm apart.
const PITCH: f64 = 0.275;
const CAMERAS: [[f64; 2]; 2] = [[0.45, 0.1], [-0.42, -0.15]];
/// The balls: not on one circle, so that they are told apart from each other's orientations.
const BALLS: [[f64; 2]; 3] = [[0.6, 0.0], [-0.35, 0.5], [-0.25, -0.55]];
/// Place of the target whose x and y are measured.
const TARGET: [f64; 2] = [0.3, 0.2];

impl Instrument {
    /// An instrument as it is usually set up.
    #[must_use]
    pub fn new(kit: Kit, noise: Noise) -> Self {
        let (mut alignment, mut marks, mut cameras) = ([0.0; 6], Vec::new(), Vec::new());
        let mut ends = Vec::new();
        match kit {
            Kit::Xyt | Kit::Theta => {}
            Kit::Xy => [alignment[3], alignment[4]] = TARGET,
            Kit::Camera | Kit::Camera2 => {
                marks = grid(PITCH);
                let places = if kit == Kit::Camera { 1 } else { 2 };
                cameras.extend(&CAMERAS[..places]);
            }
            Kit::Balls => {
                marks.extend(&BALLS);
                cameras.extend(&CAMERAS);
            }
            Kit::Ends => {
                let of_guide = |guide: usize| GUIDE_ENDS.map(|place| (guide, place));
                ends.extend((0..3).flat_map(of_guide));
            }
        }
        Self {
            kit,
            noise,
            alignment,
            marks,
            cameras,
            ends,
            scale: if kit == Kit::Balls {
                BALLS_SCALE
            } else {
                SCALE
            },
        }
    }

    /// What is unknown about the instrument as it is guessed: places of cameras and marks, or the alignment.
    #[must_use]
    pub fn guess(&self) -> Vec<f64> {
        if !self.ends.is_empty() {
            return self.ends.iter().map(|&(_, place)| place).collect();
        }
        if self.cameras.is_empty() {
            return self.alignment.to_vec();
        }
        let places = self.cameras.iter().chain(&self.marks);
        places.flatten().copied().collect()
    }

    /// Where the two numbers of a camera stand in that list.
    #[must_use]
    pub const fn camera_at(&self, camera: usize) -> usize {
        2 * camera
    }

    /// Where the two numbers of a mark stand in that list.
    #[must_use]
    pub const fn mark_at(&self, mark: usize) -> usize {
        2 * (self.cameras.len() + mark)
    }

    /// Where the number of an end stands in that list.
    #[must_use]
    pub const fn end_at(&self, end: usize) -> usize {
        end
    }

    /// The guide of an end.
    #[must_use]
    pub fn guide_of(&self, end: usize) -> usize {
        self.ends.get(end).map_or(0, |&(guide, _)| guide)
    }

    /// All unknowns: the machine's and the instrument's.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        MACHINE_NUMBERS + self.guess().len()
    }

    /// What each unknown may be off its guess, one standard deviation.
    #[must_use]
    pub fn sizes(&self) -> Vec<f64> {
        let machine = (0..MACHINE_NUMBERS).map(|n| numbers::size(n % kinematics::COEFFICIENTS));
        let cameras = 2 * self.cameras.len();
        let instrument = (MACHINE_NUMBERS..self.unknowns()).map(|n| match n - MACHINE_NUMBERS {
            _ if !self.ends.is_empty() => END,
            _ if cameras == 0 => ALIGNMENT,
            n if n < cameras => CAMERA,
            _ => MARK,
        });
        machine.chain(instrument).collect()
    }
}

/// Marks in rows and columns on a plate as large as the track.
fn grid(pitch: f64) -> Vec<[f64; 2]> {
    let most = (1.0 / pitch) as i32;
    let places = (-most..=most).flat_map(|row| (-most..=most).map(move |column| (row, column)));
    let marks = places.map(|(row, column)| [f64::from(column) * pitch, f64::from(row) * pitch]);
    marks.filter(|[x, y]| x * x + y * y < 1.0).collect()
}
