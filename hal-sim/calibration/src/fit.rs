//! The fit: Gauss-Newton, robust, with some visits held out to see whether it holds where it was not made.
//!
//! First plain steps, since at the start every miss is large and says nothing; then steps in which a visit that misses by much counts
//! less (soft L1), and those beyond four standard deviations are left out, the worst first. What was held out is judged by that fit
//! and joins the last steps. Where the misses are larger than the instrument's noise, the rest is the machine's own scatter, and counts
//! in every uncertainty.

use crate::Machine;
use crate::alignment::aligned;
use crate::descent::State;
use crate::error::FitError;
use crate::kit::{Instrument, Noise};
use crate::least_squares::Factor;
use crate::visit::{Seen, Visit};

/// Share of visits that may be outliers.
const MOST_OUTLIERS: f64 = 0.03;
/// Visits of twenty that are held out: spread, since a plan has the most telling ones first.
const HELD_OUT: [usize; 3] = [6, 13, 19];

/// A fitted machine.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The machine.
    pub machine: Machine,
    /// The instrument's unknowns, in the order of [`Instrument::guess`].
    pub unknowns: Vec<f64>,
    /// The factor of the last step.
    pub factor: Factor,
    /// Square misses over what noise and scatter make of them, a row: 1 where noise and model are right.
    pub chi2: f64,
    /// The same over what the instrument's noise alone, as it was said, would make of them.
    pub chi2_of_noise: f64,
    /// What the machine itself does not repeat, rad at each encoder: 0 where the instrument's noise explains what is left.
    pub scatter_rad: f64,
    /// The same of the visits that were held out.
    pub chi2_held_out: f64,
    /// Visits that were left out, by their places in the list.
    pub outliers: Vec<usize>,
    /// Measured rows less the numbers that they have paid for.
    pub rows_left: f64,
    /// Steps that were made.
    pub steps: usize,
}

impl Fit {
    /// The instrument's noise with the machine's scatter in it.
    #[must_use]
    pub fn noise(&self, said: Noise) -> Noise {
        Noise {
            encoder_rad: said.encoder_rad.hypot(self.scatter_rad),
            ..said
        }
    }

    /// Whether chi^2 is further from 1 than chance brings it: the noise is not what was said, or the machine is not of this model.
    #[must_use]
    pub fn is_doubtful(&self) -> bool {
        // The standard deviation of chi^2 is the root of 2 over its rows.
        let chance = 4.0 * (2.0 / self.rows_left).sqrt();
        (self.chi2 - 1.0).abs() > chance.max(0.2)
    }
}

/// Whether a visit is held out, by its place in the list.
pub(crate) fn is_held_out(visit: usize) -> bool {
    HELD_OUT.contains(&(visit % 20))
}

/// Fits a machine, and what is unknown about the instrument, to visits.
///
/// # Errors
/// [`FitError`].
pub fn fit(instrument: &Instrument, visits: &[Visit]) -> Result<Fit, FitError> {
    check(instrument, visits)?;
    let mut state = State::new(aligned(instrument, visits));
    let mut weights: Vec<f64> = (0..visits.len())
        .map(|visit| f64::from(u8::from(!is_held_out(visit))))
        .collect();
    let mut steps = state.descend(visits, &weights)?;
    let said_rad = instrument.noise.encoder_rad;
    steps += state.cut(visits, &mut weights, said_rad)?;
    let (factor, more) = state.settle_with_scatter(visits, &weights, said_rad)?;
    steps += more;
    // A visit may come back, or go, now that outliers no longer pull.
    let outliers = state.outliers(visits, &weights, &factor)?;
    let held_out: Vec<usize> = (0..visits.len())
        .filter(|visit| is_held_out(*visit) && !outliers.contains(visit))
        .collect();
    let chi2_held_out = state.chi2_of_new(visits, &held_out, &factor)?;
    let weights: Vec<f64> = (0..visits.len())
        .map(|visit| f64::from(u8::from(!outliers.contains(&visit))))
        .collect();
    let (factor, more) = state.settle_with_scatter(visits, &weights, said_rad)?;
    steps += more;
    let found_rad = state.instrument.noise.encoder_rad;
    let (chi2, rows_left) = state.chi2(visits, &weights, &factor)?;
    state.instrument.noise.encoder_rad = said_rad;
    let (chi2_of_noise, _) = state.chi2(visits, &weights, &factor)?;
    few(outliers.len(), visits.len(), chi2)?;
    let (machine, unknowns) = state.values();
    Ok(Fit {
        machine,
        unknowns,
        factor,
        chi2,
        chi2_of_noise,
        scatter_rad: (found_rad.powi(2) - said_rad.powi(2)).max(0.0).sqrt(),
        chi2_held_out,
        outliers,
        rows_left,
        steps,
    })
}

/// Refuses too many outliers.
pub(crate) fn few(outliers: usize, visits: usize, chi2: f64) -> Result<(), FitError> {
    if outliers as f64 > MOST_OUTLIERS * visits as f64 {
        return Err(FitError::TooManyOutliers {
            outliers,
            visits,
            chi2,
        });
    }
    Ok(())
}

/// Every visit is one that the instrument can make.
pub(crate) fn check(instrument: &Instrument, visits: &[Visit]) -> Result<(), FitError> {
    const LEAST: usize = 12;
    if visits.len() < LEAST {
        return Err(FitError::TooFew {
            visits: visits.len(),
            least: LEAST,
        });
    }
    for (visit, Visit { readings_rad, seen }) in visits.iter().enumerate() {
        if !readings_rad
            .iter()
            .chain(seen.values())
            .all(|value| value.is_finite())
        {
            let reason = "a value is not finite";
            return Err(FitError::Visit { visit, reason });
        }
        let reason = match *seen {
            Seen::Mark { mark, .. } if mark >= instrument.marks.len() => {
                Some("the plate has no such mark")
            }
            Seen::Mark { camera, .. } if camera >= instrument.cameras.len() => {
                Some("the camera has no such place")
            }
            Seen::End { end } if end >= instrument.ends.len() => {
                Some("the guides have no such end")
            }
            Seen::Mark { .. } | Seen::End { .. } => None,
            _ if !instrument.cameras.is_empty() => Some("a camera sees marks"),
            _ if !instrument.ends.is_empty() => Some("ends are touched, and nothing is read"),
            _ => None,
        };
        if let Some(reason) = reason {
            return Err(FitError::Visit { visit, reason });
        }
    }
    Ok(())
}
