//! What has moved while was measured: the reference pose, visited again and again, should be seen at the same place for the same readings of
//! the encoders. Only a straight line in time is looked for, since a few visits tell no more.

use crate::left::Miss;

/// So many standard deviations are no chance.
const SIGNIFICANT: f64 = 4.0;
/// Fewer visits of the reference pose show nothing.
const LEAST: usize = 4;

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
    /// Of visits of the reference pose: when, s, and what the fit leaves of them. `None` where they are too few to tell.
    #[must_use]
    pub fn new(references: &[(f64, Miss)]) -> Option<Self> {
        let (first, last) = (references.first()?.0, references.last()?.0);
        if references.len() < LEAST || last <= first {
            return None;
        }
        let count = references.len() as f64;
        let mean_s = references.iter().map(|(at_s, _)| at_s).sum::<f64>() / count;
        let square: f64 = (references.iter())
            .map(|(at_s, _)| (at_s - mean_s).powi(2))
            .sum();
        let seconds = last - first;
        let (mut moved, mut noise) = ([0.0; 3], [0.0; 3]);
        for &axis in references[0].1.seen {
            let slope: f64 = (references.iter())
                .map(|(at_s, miss)| (at_s - mean_s) * miss.off[axis] / square)
                .sum();
            moved[axis] = slope * seconds;
            noise[axis] = seconds * references[0].1.noise[axis] / square.sqrt();
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

    #[test]
    fn a_line_is_told_from_noise() {
        let visits = |slope: f64| -> Vec<(f64, Miss)> {
            let visit = |at: i32| {
                let chance = [0.3, -1.1, 0.6, -0.2][(at % 4) as usize];
                let miss = Miss {
                    off: [slope * f64::from(at) + chance, -chance, 0.0],
                    seen: &[0, 1],
                    noise: [1.0; 3],
                };
                (10.0 * f64::from(at), miss)
            };
            (0..11).map(visit).collect()
        };
        let drift = Drift::new(&visits(0.6)).unwrap();
        assert!((drift.moved[0] - 6.0).abs() < 0.6, "{drift:?}");
        // The noise of a slope over 11 places is 1 / root(110) of that of one.
        assert!((drift.noise[0] - 10.0 / 110.0_f64.sqrt()).abs() < 1e-9);
        assert!(drift.is_significant());
        assert!(!Drift::new(&visits(0.0)).unwrap().is_significant());
        assert_eq!(Drift::new(&visits(0.0)[..3]), None);
    }
}
