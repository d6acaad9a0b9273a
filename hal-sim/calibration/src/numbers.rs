//! The numbers of a pivot as a list: their order, names, and the sizes that a workshop keeps.

use kinematics::{COEFFICIENTS, PivotCoefficients};

/// Place of e in the list.
pub const GUIDE_ERROR: usize = 4;
/// Place of d0.
pub const GUIDE_OFFSET: usize = 5;
/// First of the encoder's numbers in the list; before it stand z, dR, a, e, d0.
pub const ENCODER: usize = 6;
/// First of the run-out's numbers.
pub const RUNOUT: usize = ENCODER + 24;
/// First of the straightness' numbers.
pub const STRAIGHTNESS: usize = RUNOUT + 10;

/// The numbers of a pivot, in the order of their fields.
#[must_use]
pub fn to_list(pivot: &PivotCoefficients) -> [f64; COEFFICIENTS] {
    pivot.to_list()
}

/// A pivot of these numbers.
#[must_use]
pub fn from_list(list: &[f64; COEFFICIENTS]) -> PivotCoefficients {
    PivotCoefficients::from_list(list)
}

/// Size of a number on machines of a good workshop, one standard deviation, track radii or rad, for a track of 100 mm: zeros found to
/// 1 mrad, radii 0.1 mm, ring centres 20 um, directions 2 mrad, offsets 0.2 mm; encoders 20 um off the middle of a scale of 50 mm,
/// 20 urad twice a turn, 10 urad / k beyond; run-out 2.5 um (2/k)^1.5, straightness 2.5 um (2/k)^2.
#[must_use]
pub fn size(number: usize) -> f64 {
    let harmonic = |first: usize, low: usize| f64::from(low as u32 + ((number - first) / 2) as u32);
    match number {
        0 | 1 => 1e-3,
        2 | 3 => 2e-4,
        4 | 5 => 2e-3,
        ENCODER..RUNOUT => match harmonic(ENCODER, 1) {
            1.0 => 4e-4,
            2.0 => 2e-5,
            k => 1e-5 / k,
        },
        RUNOUT..STRAIGHTNESS => 2.5e-5 * (2.0 / harmonic(RUNOUT, 2)).powf(1.5),
        _ => {
            let degree = f64::from((number - STRAIGHTNESS + 2) as u32);
            2.5e-5 * (2.0 / degree).powi(2)
        }
    }
}

/// What a number is called, with its pivot from 1.
#[must_use]
pub fn name(pivot: usize, number: usize) -> String {
    let what = match number {
        0 => "encoder zero".to_owned(),
        1 => "radius error".to_owned(),
        2 => "ring centre x".to_owned(),
        3 => "ring centre y".to_owned(),
        4 => "guide error".to_owned(),
        5 => "guide offset".to_owned(),
        ENCODER..RUNOUT => wave("encoder", number - ENCODER, 1),
        RUNOUT..STRAIGHTNESS => wave("run-out", number - RUNOUT, 2),
        _ => format!("straightness {}", number - STRAIGHTNESS + 2),
    };
    format!("{what} of pivot {}", pivot + 1)
}

fn wave(what: &str, place: usize, low: usize) -> String {
    let phase = ["cosine", "sine"][place % 2];
    format!("{what} {phase} {}", place / 2 + low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pivot_comes_back_from_its_list() {
        let mut list = [0.0; COEFFICIENTS];
        for (number, place) in list.iter_mut().enumerate() {
            *place = 1.0 + number as f64;
        }
        let pivot = from_list(&list);
        assert_eq!(to_list(&pivot), list);
        assert_eq!(pivot.encoder_rad[1], [9.0, 10.0]);
        assert_eq!(pivot.runout[0], [31.0, 32.0]);
        assert_eq!(pivot.straightness[7], 48.0);
    }

    #[test]
    fn sizes_and_names_are_those_of_their_numbers() {
        for (wanted, expected) in [
            ("guide offset of pivot 2", 2e-3),
            ("encoder sine 1 of pivot 2", 4e-4),
            ("encoder cosine 2 of pivot 2", 2e-5),
            ("encoder sine 10 of pivot 2", 1e-6),
            ("run-out cosine 2 of pivot 2", 2.5e-5),
            ("straightness 4 of pivot 2", 6.25e-6),
        ] {
            let number = (0..COEFFICIENTS).find(|&number| name(1, number) == wanted);
            let size = size(number.expect(wanted));
            assert!((size / expected - 1.0).abs() < 1e-12, "{wanted}: {size}");
        }
    }
}
