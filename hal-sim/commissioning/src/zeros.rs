//! Wrong zeros of the encoders, from the torques of the rings over a tour.
//!
//! Three encoders for three freedoms: the pose that is told always fits its angles. What does not fit is what the motors have to do for it: with
//! wrong zeros guides stand otherwise than they are told, and inertia and friction come to the rings in other shares. The zeros are sought that leave least of
//! the torques when all that is carried is fitted beside them ([`platform`](mod@super::platform)).
//!
//! Errors of all three zeros alike turn the whole machine, and do not show. What is found are their differences from their mean.

use super::least_squares::{Minimum, minimise};
use super::platform::{Evaluation, Platform, PlatformError, Tour, fit, of_three, platform};
use nalgebra::{DVector, Matrix2, Vector2};

/// Errors of the zeros, as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroErrors {
    /// What each angle is told too large by, rad; their mean is 0.
    pub too_large_rad: [f64; 3],
    /// Standard deviation of the one that is known worst, as far as what is left over says, rad.
    pub deviation_rad: f64,
    /// What is carried, with the zeros as they were found.
    pub platform: Platform,
}

/// Steps of the search.
const STEPS: usize = 20;
/// Parts of the rows that err each by itself: in commissioning as many as there are moves.
const PARTS: usize = 96;
/// Step of an angle for derivatives, rad.
const STEP_RAD: f64 = 1e-4;

/// Errors of the zeros of which the torques of some tours speak.
///
/// # Errors
/// [`PlatformError`] of the tours as they are told.
pub fn zero_errors(tours: &[Tour], how: &Evaluation) -> Result<ZeroErrors, PlatformError> {
    let told = fit(tours, how)?.left;
    let left = |zeros: &DVector<f64>| {
        let corrected: Vec<_> = tours.iter().map(|tour| corrected(tour, zeros)).collect();
        // A pose that there is none of is a step too far.
        fit(&corrected, how).map_or_else(|_| told.map(|_| f64::INFINITY), |fit| fit.left)
    };
    let found = minimise(&DVector::zeros(2), STEPS, left).ok_or(PlatformError::Condition {
        condition: f64::INFINITY,
    })?;
    let corrected: Vec<_> = tours
        .iter()
        .map(|tour| corrected(tour, &found.at))
        .collect();
    Ok(ZeroErrors {
        too_large_rad: of_three([found.at[0], found.at[1]]),
        deviation_rad: deviation(&found, left),
        platform: platform(&corrected, how)?,
    })
}

/// The larger deviation of the two, from how much each part of the tours pulls at them: what gears, motors and friction leave over is alike for about a move,
/// so that single rows would promise too much (the covariance of clustered errors, as in Cameron and Miller, "A Practitioner's Guide to Cluster-Robust
/// Inference", 2015, section II).
fn deviation(found: &Minimum, left: impl Fn(&DVector<f64>) -> DVector<f64>) -> f64 {
    let slope = |unknown: usize| {
        let moved = |by: f64| {
            let mut moved = found.at.clone();
            moved[unknown] += by;
            left(&moved)
        };
        (moved(STEP_RAD) - moved(-STEP_RAD)) / (2.0 * STEP_RAD)
    };
    let (left, slopes) = (left(&found.at), [slope(0), slope(1)]);
    let part = left.len().div_ceil(PARTS);
    let mut pulls = Matrix2::zeros();
    for first in (0..left.len()).step_by(part) {
        let rows = part.min(left.len() - first);
        let pull = Vector2::from_fn(|unknown, _| {
            (slopes[unknown].rows(first, rows)).dot(&left.rows(first, rows))
        });
        pulls += pull * pull.transpose();
    }
    let covariance = Matrix2::from_fn(|i, k| found.covariance[(i, k)]);
    (covariance * pulls * covariance)
        .symmetric_eigenvalues()
        .max()
        .sqrt()
}

fn corrected(tour: &Tour, zeros: &DVector<f64>) -> Tour {
    let mut corrected = tour.clone();
    for (angles, too_large) in corrected
        .angle_rad
        .iter_mut()
        .zip(of_three([zeros[0], zeros[1]]))
    {
        angles.iter_mut().for_each(|angle| *angle -= too_large);
    }
    corrected
}
