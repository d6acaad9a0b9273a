//! The error that an encoder makes within each period of its scale, from its readings while its ring turns at a steady rate.
//!
//! No reference is needed: the error repeats with every period of the scale, and nothing else in a ring's motion does. Readings less a
//! straight line are held against sines of the phase within the period, under a window (Hann's) that keeps out what is slower: ripple,
//! eccentricity, a rate that is not quite steady. A servo that turns the ring follows the error by what its loop has left of a gain at that
//! frequency, some hundredths: what is found is off by as much, and a second look once the error is taken away finds the rest.

use core::f64::consts::TAU;
use firmware::parameters::SUBDIVISION_HARMONICS;
use nalgebra::Complex;

/// One, two and three sines in a period: `sum |c_k| sin(k phase + arg c_k)`, rad.
pub type Harmonics = [Complex<f64>; SUBDIVISION_HARMONICS];

/// Fewest periods of the scale that the readings have to go over: the window takes four of a slower disturbance's own.
const LEAST_PERIODS: f64 = 50.0;

/// The error of readings (rad, in the encoder's own direction, from reading 0, without steps at whole turns) at successive ticks;
/// `None` where they go over too little of the scale, or so fast that the highest sine has less than two readings in a period.
#[must_use]
pub fn subdivision(readings_rad: &[f64], periods_per_turn: u32) -> Option<Harmonics> {
    let (first, last) = (*readings_rad.first()?, *readings_rad.last()?);
    let steps = (readings_rad.len() - 1) as f64;
    let periods = (last - first).abs() * f64::from(periods_per_turn) / TAU;
    if periods < LEAST_PERIODS || 2.0 * SUBDIVISION_HARMONICS as f64 * periods > steps {
        return None;
    }
    let rows = || {
        (readings_rad.iter().enumerate()).map(|(at, reading_rad)| {
            let along = at as f64 / steps;
            let off_rad = reading_rad - first - (last - first) * along;
            (1.0 - (TAU * along).cos(), off_rad, *reading_rad)
        })
    };
    let weights: f64 = rows().map(|(weight, ..)| weight).sum();
    // Phases of readings are not evenly spread where these have the error: what is constant would be seen in them.
    let mean_rad = rows()
        .map(|(weight, off_rad, _)| weight * off_rad)
        .sum::<f64>()
        / weights;
    let mut sums = Harmonics::default();
    for (weight, off_rad, reading_rad) in rows() {
        // Whole turns first: what is left is small enough to be exact.
        let turns = (reading_rad / TAU).rem_euclid(1.0) * f64::from(periods_per_turn);
        let phase = TAU * turns.fract();
        for (k, sum) in (1_i32..).zip(&mut sums) {
            *sum += Complex::from_polar(weight * (off_rad - mean_rad), -f64::from(k) * phase);
        }
    }
    // A sine is `(exp(i phase) - exp(-i phase)) / 2i`.
    Some(sums.map(|sum| sum * Complex::new(0.0, 2.0 / weights)))
}

/// Root of the sum of the squared amplitudes, rad.
#[must_use]
pub fn size_rad(harmonics: &Harmonics) -> f64 {
    let squares: f64 = harmonics.iter().map(Complex::norm_sqr).sum();
    squares.sqrt()
}

/// Both together.
#[must_use]
pub fn sum(one: &Harmonics, other: &Harmonics) -> Harmonics {
    std::array::from_fn(|k| one[k] + other[k])
}
