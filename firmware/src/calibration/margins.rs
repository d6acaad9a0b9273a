//! How far the pivots of a built machine stand from where the planners take them to be: these plan for the drawing.
//!
//! To first order, from `f_i = n . (P - C) - d0 - S(rho)`: with s = D the sine and c the cosine of psi - t, u and n along and across the
//! guide, q = u . C, and lengths in track radii,
//!
//! ```text
//! off   = (d0 + S - n . a - s (dR + r) - q e) / c     psi - t is larger by it
//! dm    = z + e + E + off                             the encoder reads more by it
//! drho  = c (dR + r) - s (off + e) + u . a            the pivot is further out on its guide by it
//! ```
//!
//! Each guide is looked at for itself, over its ring's angle and over s, with the worst S and q that there are: what two pivots
//! are off at once is at most that.

use super::Calibration;
use crate::number::Fixed;
use kinematics::{Angle, Curves, Geometry, PivotCoefficients, RingErrors, Scalar, Series};

/// Steps of the ring's angle, of s from the disk's one rim to the other, and of the place on the guide.
const RING_STEPS: u32 = 96;
const SINE_STEPS: u32 = 8;
const GUIDE_STEPS: u32 = 24;
/// What may lie between two of them, and in what is left out, the second order: a share of what is found, and besides it 2e-5 track
/// radii and 5e-5 rad.
const SHARE_BETWEEN: f32 = 0.1;
const GUIDE_BETWEEN: f32 = 2e-5;
const SEPARATION_BETWEEN: f32 = 5e-5;
/// More than 2 mm on a track of 100 mm, and the guides' ends and the carriages may not be where the supervisor takes
/// them to be.
const GUIDE_MOST: f32 = 0.02;
/// The same of the angle between two pivots, rad: 3 mm. On the disk they are 17 deg further apart than has to be.
const SEPARATION_MOST: f32 = 0.03;

/// How far pivots may be from where the drawing has them, over the whole disk at every orientation. The supervisor's
/// own margins are widened by it: where the planners may go, nothing is a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CalibrationMargins {
    /// Place on the guide, track radii.
    pub guide: f32,
    /// Angle between two pivots as the encoders show it, 2^-32 turns.
    pub separation: u32,
}

impl CalibrationMargins {
    /// As drawn.
    pub const NONE: Self = Self {
        guide: 0.0,
        separation: 0,
    };

    /// Those of a calibration of such pivots; `None` if they are further off than can be put right. Most often an encoder's zero is
    /// not the parameter's then.
    pub fn new(
        pivots: &[PivotCoefficients; 3],
        calibration: &Calibration,
        geometry: &Geometry,
    ) -> Option<Self> {
        if calibration.are_zero() {
            return Some(Self::NONE);
        }
        let rim = geometry.usable_radius() as f32;
        let mut off = [PivotErrors::default(); 3];
        for ((off, pivot), series) in off.iter_mut().zip(pivots).zip(&calibration.curves) {
            *off = PivotErrors::over_disk(pivot, series, rim);
        }
        let [first, second, third] = off;
        // Nearer to the next one than drawn.
        let closer = (first.most - second.least)
            .max(second.most - third.least)
            .max(third.most - first.least)
            .max(0.0);
        let guide = first.guide.max(second.guide).max(third.guide);
        let (guide, separation_rad) = (
            guide * (1.0 + SHARE_BETWEEN) + GUIDE_BETWEEN,
            closer * (1.0 + SHARE_BETWEEN) + SEPARATION_BETWEEN,
        );
        // What is no number is none.
        (guide <= GUIDE_MOST && separation_rad <= SEPARATION_MOST).then_some(Self {
            guide,
            separation: (separation_rad * UNITS_PER_RAD) as u32,
        })
    }
}

/// 2^-32 turns.
const UNITS_PER_RAD: f32 = (4_294_967_296.0 / core::f64::consts::TAU) as f32;

/// What one pivot is off the drawing.
#[derive(Clone, Copy, Default)]
struct PivotErrors {
    /// Least and most that its encoder reads more, rad.
    least: f32,
    most: f32,
    /// Most that its place on the guide is off, track radii.
    guide: f32,
}

impl PivotErrors {
    fn over_disk(pivot: &PivotCoefficients, series: &Series<f32>, rim: f32) -> Self {
        let straight = most_straightness(series);
        let mut worst = Self {
            least: f32::INFINITY,
            most: f32::NEG_INFINITY,
            guide: 0.0,
        };
        for step in 0..RING_STEPS {
            let ring = Angle::from_units((1 << 32) / i64::from(RING_STEPS) * i64::from(step));
            let (sin, cos) = Fixed::sin_cos(ring);
            let direction = [cos, sin].map(Fixed::to_f32);
            let errors = Curves::<Fixed>::ring_errors(series, ring);
            for step in 0..=SINE_STEPS {
                let s = rim * (2.0 * step as f32 / SINE_STEPS as f32 - 1.0);
                let projection = libm::sqrtf((rim * rim - s * s).max(0.0));
                let either_way = straight + projection * (pivot.guide_error_rad as f32).abs();
                worst.widen(pivot, either_way, &errors, direction, s);
            }
        }
        worst
    }

    /// By what the pivot is off where the ring's radius points along [cos, sin], for a guide at `s` to it;
    /// `either_way` is what S and q can make at most.
    fn widen(
        &mut self,
        pivot: &PivotCoefficients,
        either_way: f32,
        errors: &RingErrors<f32>,
        [cos, sin]: [f32; 2],
        s: f32,
    ) {
        let c = libm::sqrtf(1.0 - s * s);
        let along = [cos * c + sin * s, sin * c - cos * s];
        let [x, y] = pivot.ring_centre.map(|part| part as f32);
        let (centre_along, centre_across) =
            (along[0] * x + along[1] * y, along[0] * y - along[1] * x);
        let radius = pivot.radius_error as f32 + errors.runout.value;
        let guide_rad = pivot.guide_error_rad as f32;
        let off = (pivot.guide_offset as f32 - centre_across - s * radius) / c;
        let reads = pivot.encoder_zero_rad as f32 + guide_rad + errors.encoder.value + off;
        let place = c * radius - s * (off + guide_rad) + centre_along;
        self.least = self.least.min(reads - either_way / c);
        self.most = self.most.max(reads + either_way / c);
        self.guide = self.guide.max(place.abs() + either_way * (s / c).abs());
    }
}

/// The largest straightness on the guide.
fn most_straightness(series: &Series<f32>) -> f32 {
    let mut most = 0.0_f32;
    for step in 0..=GUIDE_STEPS {
        let rho = 0.2 + 1.6 * step as f32 / GUIDE_STEPS as f32;
        most = most.max(Curves::<Fixed>::straightness(series, rho).value.abs());
    }
    most
}
