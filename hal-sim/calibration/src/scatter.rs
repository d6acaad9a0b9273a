//! What a machine itself does not repeat, beside the instrument's noise: lost motion of its guides, run-out of its balls, errors of its
//! encoders within a period. All of it is counted as noise of the encoders, since it enters guide by guide as they do: without it a fit
//! would promise more than the machine keeps.

use crate::descent::State;
use crate::error::FitError;
use crate::least_squares::Factor;
use crate::visit::{Visit, instrument_noise};

/// More than this is no scatter: the machine is not of this model, or something is loose. Rad at each encoder: 5 um on the track.
const MOST_RAD: f64 = 5e-5;
/// The median of a squared standard deviation that is normal, and by how much such a median scatters more than a mean.
const MEDIAN: f64 = 0.454_94;
const MEDIAN_SCATTER: f64 = 1.65;
/// A square sum this many of its standard deviations too large is more than chance.
const MORE_THAN_CHANCE: f64 = 2.0;
/// Scatter and fit come to rest after finding each from the other so often.
const FINDINGS: usize = 3;
/// Halvings of the range.
const HALVINGS: usize = 50;

/// How square misses are made one number, which is 1 where the noise is right.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Over {
    /// The mean: exact, where there are no outliers.
    Mean,
    /// The median: outliers do not draw it.
    Median,
}

impl Over {
    fn of(self, squares: &mut [f64]) -> f64 {
        match self {
            Self::Mean => squares.iter().sum::<f64>() / squares.len() as f64,
            Self::Median => {
                let middle = squares.len() / 2;
                *squares.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN
            }
        }
    }

    /// One standard deviation of it, over so many rows.
    fn chance(self, rows: f64) -> f64 {
        let mean = (2.0 / rows).sqrt();
        match self {
            Self::Mean => mean,
            Self::Median => MEDIAN_SCATTER * mean,
        }
    }
}

impl State {
    /// Comes to rest, with the scatter that the misses then show.
    pub(crate) fn settle_with_scatter(
        &mut self,
        visits: &[Visit],
        weights: &[f64],
        said_rad: f64,
    ) -> Result<(Factor, usize), FitError> {
        let (mut factor, mut steps) = self.settle(visits, weights)?;
        for _ in 0..FINDINGS {
            self.find_scatter(visits, weights, &factor, said_rad, Over::Mean)?;
            let (with_scatter, more) = self.settle(visits, weights)?;
            factor = with_scatter;
            steps += more;
        }
        Ok((factor, steps))
    }

    /// Makes the noise of the encoders what it has to be for the misses of the visits in the fit, but no less than what was said.
    pub(crate) fn find_scatter(
        &mut self,
        visits: &[Visit],
        weights: &[f64],
        factor: &Factor,
        said_rad: f64,
        over: Over,
    ) -> Result<(), FitError> {
        let (machine, unknowns) = self.values();
        // Of each row the square of its miss, of the instrument's noise, and of what a rad at every encoder makes of it.
        let mut squares = Vec::new();
        for (visit, measured) in visits.iter().enumerate() {
            if weights[visit] > 0.0 {
                let rows = self.rows(&machine, &unknowns, visit, measured)?;
                let noise = instrument_noise(&self.instrument.noise);
                squares.extend(rows.seen.iter().map(|&row| {
                    let miss = rows.misses[row] * rows.noise[row];
                    [miss, noise[row], rows.by_encoders[row]].map(|size| size * size)
                }));
            }
        }
        let rows = squares.len() as f64;
        let rows_left = rows - factor.fitted().ok_or(FitError::NotFinite)?;
        if rows_left < 1.0 {
            return Ok(());
        }
        let mut list = vec![0.0; squares.len()];
        let mut chi2 = |encoder_rad: f64| {
            for (place, [miss, noise, by_encoders]) in list.iter_mut().zip(&squares) {
                *place = miss / (noise + encoder_rad * encoder_rad * by_encoders);
            }
            over.of(&mut list) * rows / rows_left
        };
        let (mut low, mut high) = (said_rad, MOST_RAD);
        if chi2(said_rad) <= 1.0 + MORE_THAN_CHANCE * over.chance(rows_left) {
            high = said_rad;
        }
        for _ in 0..HALVINGS {
            let middle = low.midpoint(high);
            if chi2(middle) > 1.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.instrument.noise.encoder_rad = high;
        Ok(())
    }
}
