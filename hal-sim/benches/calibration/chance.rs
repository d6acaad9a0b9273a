//! What chance alone makes of as many machines: fits drawn from the covariances of those that were made.

use calibration::accuracy::{DISK, by_unknowns};
use calibration::spread::over_disk;
use calibration::{Accuracy, Fit, Instrument};
use hal_sim::random::Random;
use nalgebra::DMatrix;

/// Poses over which their errors are looked at.
const POSES: usize = 250;
/// How often each machine's fit is drawn.
const SETS: usize = 200;

/// What a fit leaves that was drawn from a covariance.
#[derive(Clone, Copy)]
pub struct Drawn {
    turn_rms_rad: f64,
    /// Verified over predicted.
    ratio: f64,
}

/// Fits drawn from a covariance: `R^-1 g` of as many normal deviates g.
pub fn drawn(
    fit: &Fit,
    instrument: &Instrument,
    predicted: &Accuracy,
    random: &mut Random,
) -> Vec<Drawn> {
    let poses: Vec<[f64; 3]> = over_disk(DISK).take(POSES).collect();
    let root = &fit.factor.root;
    let by_unknowns = by_unknowns(&fit.machine, root.ncols(), &instrument.sizes(), &poses)
        .expect("inside the disk");
    let deviates = DMatrix::from_fn(root.ncols(), SETS, |_, _| random.normal());
    let drawn = root
        .solve_upper_triangular(&deviates)
        .expect("a factor of full rank");
    let errors = by_unknowns * drawn;
    let rms = |square: f64| (square / POSES as f64).sqrt();
    let of_rows = |errors: &[f64], rows: &[usize]| -> f64 {
        errors
            .chunks(3)
            .flat_map(|pose| rows.iter().map(|&row| pose[row].powi(2)))
            .sum()
    };
    errors
        .column_iter()
        .map(|errors| Drawn {
            turn_rms_rad: rms(of_rows(errors.as_slice(), &[2])),
            ratio: rms(of_rows(errors.as_slice(), &[0, 1])) / predicted.place_rms,
        })
        .collect()
}

/// The worst theta, the least and the most ratio of these machines: the median of all sets, and what 95 % of them stay within.
pub fn of_machines<'a>(machines: impl Iterator<Item = &'a [Drawn]> + Clone) -> String {
    let extremes = |value: fn(&Drawn) -> f64, of: fn(f64, f64) -> f64, share: f64| {
        let of_set = |set: usize| machines.clone().map(|drawn| value(&drawn[set])).reduce(of);
        let mut extremes: Vec<f64> = (0..SETS).filter_map(of_set).collect();
        extremes.sort_by(f64::total_cmp);
        let at = |share: f64| extremes[((SETS - 1) as f64 * share).round() as usize];
        [at(0.5), at(share)]
    };
    let [turn, turn_95] = extremes(|drawn| drawn.turn_rms_rad * 1e6, f64::max, 0.95);
    let [least, least_95] = extremes(|drawn| drawn.ratio, f64::min, 0.05);
    let [most, most_95] = extremes(|drawn| drawn.ratio, f64::max, 0.95);
    format!("{turn:.3} to {turn_95:.3}; {least:.2} to {least_95:.2}; {most:.2} to {most_95:.2}")
}
