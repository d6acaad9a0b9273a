//! What has moved while was measured: the reference pose, visited again and again, should be seen at the same place for the same readings of
//! the encoders. Only a straight line in time is looked for, since a few visits tell no more.

use crate::kit::Noise;
use crate::left::Miss;

/// So many standard deviations are no chance, also where these are known by few visits.
const SIGNIFICANT: f64 = 5.0;
/// Fewer visits of the reference pose show nothing.
const LEAST: usize = 6;

/// Drift of x, y (track radii) and theta (rad) from the first visit of the reference pose to the last.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Drift {
    /// How long that was, s.
    pub seconds: f64,
    /// How far each has moved, by the best straight line; 0 where it was not seen.
    pub moved: [f64; 3],
    /// One standard deviation of that, by the noise.
    pub noise: [f64; 3],
}

impl Drift {
    /// Of visits of the reference pose: which of these misses they are, and when they were made, s. `None` where they are too few to tell.
    ///
    /// One standard deviation is what they scatter about the line, and no less than the instrument's noise: what a fit holds for the
    /// machine's scatter may be the drift itself.
    #[must_use]
    pub fn of(references: &[(usize, f64)], misses: &[Miss], noise: &Noise) -> Option<Self> {
        let all: Vec<(f64, &Miss)> = (references.iter())
            .filter_map(|&(visit, at_s)| Some((at_s, misses.get(visit)?)))
            .collect();
        let (first, last) = (all.first()?, all.last()?.0);
        let seconds = last - first.0;
        if all.len() < LEAST || seconds <= 0.0 {
            return None;
        }
        let count = all.len() as f64;
        let mean_s = all.iter().map(|(at_s, _)| at_s).sum::<f64>() / count;
        let time = |at_s: f64| (at_s - mean_s) / seconds;
        let square: f64 = all.iter().map(|(at_s, _)| time(*at_s).powi(2)).sum();
        let instrument = [noise.length, noise.length, noise.angle_rad];
        let (mut moved, mut noise) = ([0.0; 3], [0.0; 3]);
        for &axis in first.1.seen {
            let off = || all.iter().map(|(at_s, miss)| (time(*at_s), miss.off[axis]));
            let mean = off().map(|(_, off)| off).sum::<f64>() / count;
            moved[axis] = off().map(|(time, off)| time * off).sum::<f64>() / square;
            let about: f64 = off()
                .map(|(time, off)| (off - mean - time * moved[axis]).powi(2))
                .sum();
            let one = instrument[axis].max((about / (count - 2.0)).sqrt());
            noise[axis] = one / square.sqrt();
        }
        Some(Self {
            seconds,
            moved,
            noise,
        })
    }

    /// Whether anything has moved further than the noise explains.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        let mut axes = self.moved.iter().zip(&self.noise);
        axes.any(|(moved, noise)| moved.abs() > SIGNIFICANT * noise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Noise = Noise {
        length: 1.0,
        angle_rad: 1.0,
        encoder_rad: 0.0,
    };

    fn drift(slope: f64, visits: usize) -> Option<Drift> {
        let misses: Vec<Miss> = (0..visits)
            .map(|at| {
                let chance = [0.3, -1.1, 0.6, -0.2][at % 4];
                Miss {
                    off: [slope * at as f64 + chance, -chance, 0.0],
                    seen: &[0, 1],
                    noise: [1.0; 3],
                }
            })
            .collect();
        let references: Vec<(usize, f64)> = (0..visits).map(|at| (at, 10.0 * at as f64)).collect();
        Drift::of(&references, &misses, &NOISE)
    }

    #[test]
    fn a_line_is_told_from_noise() {
        let moving = drift(0.6, 11).unwrap();
        assert!((moving.moved[0] - 6.0).abs() < 0.6, "{moving:?}");
        // The noise of a slope over 11 places is 1 / root(110) of that of one.
        assert!((moving.noise[0] - 10.0 / 110.0_f64.sqrt()).abs() < 1e-9);
        assert!(moving.is_significant());
        assert!(!drift(0.0, 11).unwrap().is_significant());
        assert_eq!(drift(9.0, 5), None);
    }
}
