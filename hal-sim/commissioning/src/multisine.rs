//! Periodic excitation: sines of whole numbers of periods in a period of the excitation.
//!
//! The phases are Schroeder's (IEEE Transactions on Information Theory 16(1), 1970), so that the sines do not add up to peaks.

use std::f64::consts::{PI, TAU};

/// Fewest bins between two sines of a run: so far apart that a Hann window over one period keeps them apart.
pub const LEAST_SPACING: usize = 2;

/// Sines of equal size.
#[derive(Clone, Debug, PartialEq)]
pub struct Multisine {
    /// Ticks of a period, a power of two.
    pub period_ticks: usize,
    /// Periods of each sine in it.
    pub bins: Vec<usize>,
    /// Amplitude of each, V.
    pub amplitude_v: f64,
}

impl Multisine {
    /// Sines of these bins with so many volts rms together.
    #[must_use]
    pub fn new(period_ticks: usize, bins: Vec<usize>, rms_v: f64) -> Self {
        let amplitude_v = rms_v * (2.0 / bins.len().max(1) as f64).sqrt();
        Self {
            period_ticks,
            bins,
            amplitude_v,
        }
    }

    /// One period, V.
    #[must_use]
    pub fn period_v(&self) -> Vec<f64> {
        let count = self.bins.len() as f64;
        (0..self.period_ticks)
            .map(|tick| {
                let sum: f64 = (self.bins.iter().enumerate())
                    .map(|(k, &bin)| {
                        let turns = (bin * tick % self.period_ticks) as f64;
                        let phase = -PI * k as f64 * (k as f64 - 1.0) / count;
                        (TAU * turns / self.period_ticks as f64 + phase).cos()
                    })
                    .sum();
                self.amplitude_v * sum
            })
            .collect()
    }
}

/// At most `count` different bins, as evenly spaced by their logarithm as whole numbers are, from one frequency to another.
#[must_use]
pub fn lines(
    period_ticks: usize,
    tick_s: f64,
    from_hz: f64,
    to_hz: f64,
    count: usize,
) -> Vec<usize> {
    let bin_hz = 1.0 / (period_ticks as f64 * tick_s);
    let [first, last] = [from_hz / bin_hz, to_hz / bin_hz];
    let (mut bins, mut at) = (Vec::new(), first.round().max(1.0));
    for left in (1..count).rev() {
        bins.push(at as usize);
        // What is left is spaced by the logarithm; below, a bin at a time.
        at = (at * (last / at).powf(1.0 / left as f64))
            .max(at + 1.0)
            .round();
    }
    bins.push(at as usize);
    bins.retain(|&bin| bin as f64 <= last + 0.5);
    bins
}

/// Bins dealt out to runs, so that neighbours are in different ones.
#[must_use]
pub fn runs(bins: &[usize], count: usize) -> Vec<Vec<usize>> {
    (0..count)
        .map(|run| bins.iter().copied().skip(run).step_by(count).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fifty_seven_lines_in_four_runs_keep_apart() {
        let bins = lines(4096, 50e-6, 29.0, 3e3, 57);
        assert_eq!((bins.first(), bins.last()), (Some(&6), Some(&614)));
        assert_eq!(bins.len(), 57);
        assert!(bins.windows(2).all(|pair| pair[1] > pair[0]));
        for run in runs(&bins, 4) {
            assert!(run.len() <= 16);
            assert!(
                run.windows(2)
                    .all(|pair| pair[1] >= pair[0] + LEAST_SPACING)
            );
        }
    }

    #[test]
    fn volts_are_as_asked_and_hardly_peak() {
        let sines = Multisine::new(
            4096,
            runs(&lines(4096, 50e-6, 29.0, 3e3, 57), 4)[1].clone(),
            1.5,
        );
        let volts = sines.period_v();
        let square = volts.iter().map(|v| v * v).sum::<f64>() / 4096.0;
        assert!((square.sqrt() - 1.5).abs() < 1e-9);
        // Of so few sines, spread by the logarithm.
        let peak = volts.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(peak < 3.5 * 1.5, "{peak}");
    }
}
