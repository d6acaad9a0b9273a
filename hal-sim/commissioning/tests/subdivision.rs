//! Errors within the periods of a scale: found again from readings made with them, among noise and what is slower.

use commissioning::subdivision::{Harmonics, size_rad, subdivision};
use core::f64::consts::TAU;
use hal_sim::random::Random;

const PERIODS: u32 = 15_708;
const ROWS: usize = 5_400;
const TICK_S: f64 = 50e-6;
/// Amplitude, rad, and phase, rad, of each harmonic.
const TRUTH: [[f64; 2]; 3] = [[0.8e-6, 0.7], [0.2e-6, -2.0], [0.1e-6, 3.0]];

fn error_rad(reading_rad: f64) -> f64 {
    let phase = (reading_rad / TAU).rem_euclid(1.0) * f64::from(PERIODS) * TAU;
    (1_i32..)
        .zip(TRUTH)
        .map(|(k, [amplitude_rad, start])| amplitude_rad * (f64::from(k) * phase + start).sin())
        .sum()
}

/// Readings while the ring turns, with ripple of the rate, eccentricity and noise.
fn readings(rate_rad_s: f64, noise_rad: f64) -> Vec<f64> {
    let mut random = Random::new(1);
    (0..ROWS)
        .map(|row| {
            let even_rad = 5.0 + rate_rad_s * TICK_S * row as f64;
            let ripple_rad = 20e-6 * (1_300.0 * even_rad).sin();
            let angle_rad = even_rad + ripple_rad + 400e-6 * even_rad.cos();
            // The error is one of the reading.
            let read_rad = (0..4).fold(angle_rad, |read_rad, _| angle_rad + error_rad(read_rad));
            read_rad + noise_rad * random.normal()
        })
        .collect()
}

fn off_rad(found: &Harmonics) -> f64 {
    let mut off = *found;
    for (one, [amplitude_rad, start]) in off.iter_mut().zip(TRUTH) {
        *one -= nalgebra::Complex::from_polar(amplitude_rad, start);
    }
    size_rad(&off)
}

#[test]
fn what_was_put_in_is_found() {
    for (rate_rad_s, noise_rad, most_rad) in [
        (0.5, 0.0, 7.6e-9),
        (-0.5, 0.0, 7.6e-9),
        (0.5, 200e-9, 19.1e-9),
    ] {
        let found = subdivision(&readings(rate_rad_s, noise_rad), PERIODS).expect("enough");
        let off_rad = off_rad(&found);
        println!("{rate_rad_s} rad/s, noise {noise_rad:e}: {off_rad:e} rad off");
        assert!(off_rad < most_rad);
    }
}

#[test]
fn another_scale_than_the_one_that_is_told_shows_nothing() {
    let found = subdivision(&readings(0.5, 30e-9), 17_123).expect("enough");
    assert!(size_rad(&found) < 5e-9, "{found:?}");
}

#[test]
fn too_slow_or_too_fast_is_no_error() {
    assert_eq!(subdivision(&readings(0.01, 0.0), PERIODS), None);
    assert_eq!(subdivision(&readings(2.0, 0.0), PERIODS), None);
    assert_eq!(subdivision(&[], PERIODS), None);
}
