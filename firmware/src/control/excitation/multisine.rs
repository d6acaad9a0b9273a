//! A multisine: sines of equal amplitude whose frequencies are multiples of one over [`PERIOD_TICKS`] ticks.
//!
//! A sine is its own recursion, `y[n + 1] = 2 cos(w) y[n] - y[n - 1]`: one product and no table in a tick. In integers it is the same on
//! chip and host; begun anew in each period, its rounding has no time to grow (7e-6 of the amplitude at the lowest harmonic), and every
//! period is the same to the bit.

use core::f64::consts::TAU;
use heapless::Vec;

/// Ticks of a period: 4.88 Hz apart are the lines at 20 kHz.
pub const PERIOD_TICKS: u32 = 4096;
/// Most sines.
pub const MAX_LINES: usize = 16;
/// Fraction bits of a sine, and of twice a cosine.
const SINE_BITS: u32 = 27;
const COSINE_BITS: u32 = 29;
const HALF: i64 = 1 << (COSINE_BITS - 1);

/// One sine.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    /// 2 cos(w).
    coefficient: i32,
    /// Its first value, and the one before.
    first: [i32; 2],
    /// Its value now, and the one before.
    now: [i32; 2],
}

/// A multisine under way.
#[derive(Clone, Debug, PartialEq)]
pub struct Multisine {
    lines: Vec<Line, MAX_LINES>,
    tick: u32,
    /// Volts of a sum.
    volts_per_unit: f32,
}

/// Harmonics of the period, as many as asked for between two of them, evenly spaced by their logarithms, each once.
pub fn line_harmonics(first: u32, last: u32, lines: usize) -> Vec<u32, MAX_LINES> {
    let mut harmonics = Vec::new();
    let ratio = f64::from(last) / f64::from(first);
    let gaps = (lines.max(2) - 1) as f64;
    for i in 0..lines.min(MAX_LINES) {
        let harmonic = libm::rint(f64::from(first) * libm::pow(ratio, i as f64 / gaps)) as u32;
        if harmonics.last() != Some(&harmonic) {
            // There is room: not more than that.
            let _ = harmonics.push(harmonic);
        }
    }
    harmonics
}

impl Multisine {
    /// Of these harmonics, with a peak of `peak_v`. Every other one starts downwards: for harmonics that are evenly spaced by their
    /// logarithms the peak is then 2.9 times the root mean square (ten sets tried, 3.3 at most). Schroeder's phases (IEEE Trans. Inf.
    /// Theory 16, 1970), which are for harmonics that follow each other, make 3.4 of it, and 4.2.
    pub fn new(harmonics: &[u32], peak_v: f64) -> Self {
        let mut lines = Vec::new();
        for (j, &harmonic) in harmonics.iter().take(MAX_LINES).enumerate() {
            let step = TAU * f64::from(harmonic) / f64::from(PERIOD_TICKS);
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            let before = -sign * libm::sin(step);
            let first = [0, to_fixed(before, SINE_BITS)];
            let _ = lines.push(Line {
                coefficient: to_fixed(2.0 * libm::cos(step), COSINE_BITS),
                first,
                now: first,
            });
        }
        let mut multisine = Self {
            lines,
            tick: 0,
            volts_per_unit: 0.0,
        };
        let peak =
            (0..PERIOD_TICKS).fold(1, |peak, _| multisine.next_sum().unsigned_abs().max(peak));
        multisine.volts_per_unit = (peak_v / f64::from(peak)) as f32;
        multisine
    }

    /// Volts of the next tick.
    #[inline]
    pub fn next_volts(&mut self) -> f32 {
        self.next_sum() as f32 * self.volts_per_unit
    }

    #[inline]
    fn next_sum(&mut self) -> i32 {
        let mut sum = 0_i32;
        for line in &mut self.lines {
            let [now, before] = line.now;
            sum = sum.wrapping_add(now);
            let product = (i64::from(line.coefficient) * i64::from(now) + HALF) >> COSINE_BITS;
            line.now = [(product as i32).wrapping_sub(before), now];
        }
        self.tick += 1;
        if self.tick == PERIOD_TICKS {
            self.tick = 0;
            for line in &mut self.lines {
                line.now = line.first;
            }
        }
        sum
    }
}

/// To the nearest.
fn to_fixed(value: f64, bits: u32) -> i32 {
    libm::rint(value * f64::from(1 << bits)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_are_those_of_their_harmonics_in_every_period() {
        let harmonics = line_harmonics(6, 600, MAX_LINES);
        assert_eq!(harmonics.len(), MAX_LINES);
        assert_eq!((harmonics[0], harmonics[15]), (6, 600));
        let mut multisine = Multisine::new(&harmonics, 1.5);
        let volts: std::vec::Vec<f32> = (0..3 * PERIOD_TICKS)
            .map(|_| multisine.next_volts())
            .collect();
        let (one, others) = volts.split_at(PERIOD_TICKS as usize);
        assert!(others.chunks(PERIOD_TICKS as usize).all(|it| it == one));
        let peak = one.iter().fold(0f32, |peak, v| peak.max(v.abs()));
        assert!((peak - 1.5).abs() < 1e-6, "{peak}");
        let amplitude = |harmonic: u32| {
            let (mut re, mut im) = (0.0, 0.0);
            for (tick, volts) in (0..).zip(one) {
                let angle = TAU * f64::from(harmonic * tick % PERIOD_TICKS) / 4096.0;
                re += f64::from(*volts) * libm::cos(angle);
                im += f64::from(*volts) * libm::sin(angle);
            }
            libm::hypot(re, im) / 2048.0
        };
        let first = amplitude(harmonics[0]);
        for &harmonic in &harmonics {
            let off = amplitude(harmonic) / first - 1.0;
            assert!(off.abs() < 2e-5, "{harmonic}: {off:e}");
            assert!(amplitude(harmonic + 1) < 2e-5 || harmonics.contains(&(harmonic + 1)));
        }
        let crest = f64::from(peak) / (first * libm::sqrt(8.0));
        assert!(crest < 3.4, "{crest}");
    }

    #[test]
    fn harmonics_that_round_to_one_are_one() {
        assert_eq!(line_harmonics(1, 4, 16).as_slice(), [1, 2, 3, 4]);
        assert_eq!(line_harmonics(7, 7, 1).as_slice(), [7]);
    }
}
