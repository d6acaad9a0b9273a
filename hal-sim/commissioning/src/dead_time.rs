//! What of a bridge's dead time counts: the sign of the current, at one current and as a signal, which a record gives.
//!
//! A sign is no band-limited signal: of a current that crosses zero every millisecond it has harmonics far beyond what rows at some kilohertz hold.
//! The sign of the rows alone has these folded back on the lines, so that it is not what the bridge took: the dead time then comes out too small
//! and, as both oppose the current, the resistance too large (2 to 4 % with a row each fourth tick). The current itself is band-limited, by
//! the winding. So it is computed between the rows first, and its sign taken there.

use std::f64::consts::PI;

/// Samples to a control period: harmonics up to this half the tick's rate are then where they belong.
const SAMPLES_PER_TICK: usize = 2;
/// Rows on either side of a sample that it is computed from: a sinc in a sinc's window (Lanczos) passes nine tenths of half the rows' rate.
const ROWS: usize = 16;

/// Share of a bridge's dead time that counts at a current, with its sign: less below a knee, where the current changes its sign within a
/// period of the pulses.
#[must_use]
pub fn dead_time_share(current_a: f64, knee_a: f64) -> f64 {
    (current_a / knee_a).clamp(-1.0, 1.0)
}

/// The same at samples between rows.
pub(crate) struct Lost {
    pub shares: Vec<f64>,
    /// Samples a row.
    pub per_row: usize,
}

/// From the current at each row. `knee_a`: current from which the whole dead time counts; below, less in proportion.
pub(crate) fn lost(current_a: &[f64], ticks_per_row: usize, knee_a: f64) -> Lost {
    let per_row = SAMPLES_PER_TICK * ticks_per_row;
    let mut shares = vec![0.0; per_row * current_a.len()];
    for part in 0..per_row {
        let weights = weights(part as f64 / per_row as f64);
        for row in 0..current_a.len() {
            // At the ends the first and the last row stand for those beyond.
            let at = |k: usize| (row + 1 + k).saturating_sub(ROWS).min(current_a.len() - 1);
            let between: f64 = (weights.iter().enumerate())
                .map(|(k, weight)| weight * current_a[at(k)])
                .sum();
            shares[row * per_row + part] = dead_time_share(between, knee_a);
        }
    }
    Lost { shares, per_row }
}

/// Of the rows from `ROWS - 1` before to `ROWS` behind, for a sample so much of a row behind its own.
fn weights(behind: f64) -> Vec<f64> {
    let sinc = |x: f64| {
        if x.abs() < 1e-9 { 1.0 } else { x.sin() / x }
    };
    let weight = |k: usize| {
        let x = PI * (k as f64 + 1.0 - ROWS as f64 - behind);
        sinc(x) * sinc(x / ROWS as f64)
    };
    let all: Vec<f64> = (0..2 * ROWS).map(weight).collect();
    let sum: f64 = all.iter().sum();
    all.into_iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Two sines up to nine tenths of half the rows' rate, with a knee that cuts nothing: they are what they are between the rows too.
    #[test]
    fn between_rows_the_current_is_what_it_was() {
        let current = |row: f64| 0.4 * (TAU * 0.03 * row).sin() + 0.3 * (TAU * 0.44 * row).cos();
        let rows: Vec<f64> = (0..200).map(|row| current(f64::from(row))).collect();
        let Lost { shares, per_row } = lost(&rows, 4, 1.0);
        assert_eq!((shares.len(), per_row), (1600, 8));
        for (sample, share) in shares.iter().enumerate().take(1400).skip(200) {
            let expected = current(sample as f64 / 8.0);
            assert!(
                (share - expected).abs() < 5e-3,
                "{sample}: {share} {expected}"
            );
        }
        let Lost { shares, .. } = lost(&rows, 4, 0.05);
        assert!(shares.iter().all(|share| share.abs() <= 1.0));
        assert_eq!(shares[8 * 100], (current(100.0) / 0.05).clamp(-1.0, 1.0));
    }
}
