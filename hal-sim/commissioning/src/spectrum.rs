//! Spectra of single periods.

use nalgebra::Complex;
use std::f64::consts::TAU;

/// Spectrum of one period: bins 0 to half its ticks. A straight line through it is taken away (rings turn), and a Hann window keeps
/// what is not periodic (ripple, errors of gears) near where it is. A cosine of amplitude 1 gives 1 where no other sine is in the
/// bins beside it.
#[must_use]
pub fn spectrum(values: &[f64]) -> Vec<Complex<f64>> {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count;
    let slope = (values.iter().enumerate())
        .map(|(tick, value)| (tick as f64 - middle) * (value - mean))
        .sum::<f64>()
        * 12.0
        / (count * (count * count - 1.0));
    let windowed: Vec<_> = (values.iter().enumerate())
        .map(|(tick, value)| {
            let window = 1.0 - (TAU * tick as f64 / count).cos();
            let level = value - mean - slope * (tick as f64 - middle);
            Complex::from(window * level * 2.0 / count)
        })
        .collect();
    let mut bins = transformed(windowed);
    bins.truncate(values.len() / 2);
    bins
}

/// Discrete Fourier transform of a power of two of values, by halves (Cooley and Tukey, 1965).
fn transformed(values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let count = values.len();
    if count <= 1 {
        return values;
    }
    let half = |from: usize| transformed(values.iter().copied().skip(from).step_by(2).collect());
    let (even, odd) = (half(0), half(1));
    let turned: Vec<_> = (odd.iter().enumerate())
        .map(|(k, odd)| odd * Complex::cis(-TAU * k as f64 / count as f64))
        .collect();
    let sum = even.iter().zip(&turned).map(|(a, b)| a + b);
    let difference = even.iter().zip(&turned).map(|(a, b)| a - b);
    sum.chain(difference).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_on_a_ramp_come_out_as_they_went_in() {
        let sine = |tick: f64, bin: f64, phase: f64| (TAU * bin * tick / 256.0 + phase).cos();
        let values: Vec<f64> = (0..256_u32)
            .map(f64::from)
            .map(|t| 3.0 * sine(t, 7.0, 0.3) + 0.5 * sine(t, 9.0, -1.0) + 1e3 + 20.0 * t)
            .collect();
        let bins = spectrum(&values);
        // The line that is fitted to the sines takes a little of them.
        assert!(
            (bins[7] - Complex::from_polar(3.0, 0.3)).norm() < 1e-2,
            "{}",
            bins[7]
        );
        assert!(
            (bins[9] - Complex::from_polar(0.5, -1.0)).norm() < 1e-2,
            "{}",
            bins[9]
        );
        assert!(bins[40].norm() < 1e-4);
    }
}
