//! Why a fit fails.

/// Why there is no fit.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum FitError {
    /// There is nothing to fit to.
    #[error("{visits} visits: a fit needs {least} or more")]
    TooFew {
        /// How many there are.
        visits: usize,
        /// How many it takes.
        least: usize,
    },
    /// A visit is no visit of this instrument.
    #[error("visit {}: {reason}", .visit + 1)]
    Visit {
        /// Which, from 0.
        visit: usize,
        /// Why.
        reason: &'static str,
    },
    /// It does not come to rest: the readings belong to another machine, or the instrument is not where it was said to be.
    #[error(
        "no fit after {steps} steps: {chi2:.3e} times the noise's square is left; are axes, signs and places those of this stage?"
    )]
    NoEnd {
        /// Steps that were made.
        steps: usize,
        /// Mean square miss over the noise.
        chi2: f64,
    },
    /// Too many visits miss by much: the noise is larger than was said, or the machine is not of this model.
    #[error(
        "{outliers} of {visits} visits miss by more than 4 standard deviations (chi^2 {chi2:.2}), beyond all that a sound machine does not repeat: is the noise larger than was said, or something loose?"
    )]
    TooManyOutliers {
        /// How many.
        outliers: usize,
        /// Of how many.
        visits: usize,
        /// Mean square miss over the noise.
        chi2: f64,
    },
    /// A number is not finite.
    #[error("a measured value is not finite, or far too large")]
    NotFinite,
}
