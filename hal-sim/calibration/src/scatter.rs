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
    /// Of squares and their weights: that number, and one standard deviation of it.
    fn of(self, squares: &mut [[f64; 2]]) -> [f64; 2] {
        match self {
            Self::Mean => {
                let sum = |of: fn(&[f64; 2]) -> f64| squares.iter().map(of).sum::<f64>();
                let weight = sum(|[_, weight]| *weight);
                let mean = sum(|[square, weight]| square * weight) / weight;
                [
                    mean,
                    (2.0 * sum(|[_, weight]| weight * weight)).sqrt() / weight,
                ]
            }
            Self::Median => {
                let middle = squares.len() / 2;
                let chance = MEDIAN_SCATTER * (2.0 / squares.len() as f64).sqrt();
                let by_square = |a: &[f64; 2], b: &[f64; 2]| a[0].total_cmp(&b[0]);
                let [median, _] = *squares.select_nth_unstable_by(middle, by_square).1;
                [median / MEDIAN, chance]
            }
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

    /// Makes the noise of the encoders what it has to be for the misses of the visits in the fit, but no less than what was said. Where
    /// the square sum is n of its standard deviations too large, 1 - 1 / n^2 of that is put down to scatter and the rest to chance: else
    /// every second machine without scatter would be told to have some, while one that has much has all of it.
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
        let mut list = vec![[0.0; 2]; squares.len()];
        let mut excess = |encoder_rad: f64| {
            for (place, [miss, noise, by_encoders]) in list.iter_mut().zip(&squares) {
                let size = noise + encoder_rad * encoder_rad * by_encoders;
                // Rows tell of scatter by how much of their noise it would be.
                *place = [miss / size, by_encoders / size];
            }
            let [chi2, chance] = over.of(&mut list);
            let share = rows / rows_left;
            [chi2 * share - 1.0, chance * share.sqrt()]
        };
        let [excess_of_noise, chance] = excess(said_rad);
        if excess_of_noise <= chance {
            self.instrument.noise.encoder_rad = said_rad;
            return Ok(());
        }
        let (mut low, mut high) = (said_rad, MOST_RAD);
        for _ in 0..HALVINGS {
            let middle = low.midpoint(high);
            if excess(middle)[0] > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let of_scatter = 1.0 - (chance / excess_of_noise).powi(2);
        let scatter_rad = (of_scatter * (high * high - said_rad * said_rad)).sqrt();
        self.instrument.noise.encoder_rad = said_rad.hypot(scatter_rad);
        Ok(())
    }
}
