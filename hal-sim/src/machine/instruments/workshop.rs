//! Machines drawn from a seed, as good as a workshop keeps them: each number is normal with one standard deviation of its size.

use crate::machine::plant::{AXES, PivotGeometry, PlantParameters};
use crate::random::Random;

use super::quasi_static::{EncoderErrors, QuasiStatic};

/// A machine of the reference stage's size: encoder zeros found to 1 mrad, scales 20 um off the middle at a radius of 50 mm, 20 urad
/// twice a turn and 10 urad / k from there on; ring centres 20 um, radii 0.1 mm, guides 2 mrad and 0.2 mm off; run-out
/// 2.5 um (2/k)^1.5 to k = 6, straightness 2.5 um (2/k)^2 to degree 9.
#[must_use]
pub fn machine(seed: u64) -> QuasiStatic {
    let mut random = Random::new(seed);
    let mut plant = PlantParameters::REFERENCE;
    let mut encoders = [EncoderErrors::IDEAL; AXES];
    for (pivot, encoder) in plant.pivots.iter_mut().zip(&mut encoders) {
        *pivot = pivot_of(&mut random);
        *encoder = encoder_of(&mut random);
    }
    QuasiStatic::new(&plant, encoders)
}

pub(in crate::machine) fn pivot_of(random: &mut Random) -> PivotGeometry {
    let mut pivot = PivotGeometry::IDEAL;
    pivot.ring_centre_m = pivot.ring_centre_m.map(|_| 20e-6 * random.normal());
    pivot.radius_error_m = 0.1e-3 * random.normal();
    pivot.guide_error_rad = 2e-3 * random.normal();
    pivot.guide_offset_m = 0.2e-3 * random.normal();
    for (pair, k) in pivot.runout_m.iter_mut().zip([2.0_f64, 3.0, 4.0, 5.0, 6.0]) {
        *pair = pair.map(|_| 2.5e-6 * (2.0 / k).powf(1.5) * random.normal());
    }
    let mut degree = 1.0_f64;
    for size_m in &mut pivot.straightness_m {
        degree += 1.0;
        *size_m = 2.5e-6 * (2.0 / degree).powi(2) * random.normal();
    }
    pivot
}

pub(in crate::machine) fn encoder_of(random: &mut Random) -> EncoderErrors {
    let mut encoder = EncoderErrors::IDEAL;
    encoder.zero_rad = 1e-3 * random.normal();
    let mut times = 0.0;
    for pair in &mut encoder.harmonics_rad {
        times += 1.0;
        let size_rad = match times {
            1.0 => 400e-6,
            2.0 => 20e-6,
            _ => 10e-6 / times,
        };
        *pair = pair.map(|_| size_rad * random.normal());
    }
    encoder
}
