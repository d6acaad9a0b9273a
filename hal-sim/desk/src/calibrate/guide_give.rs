//! While a calibration is measured or verified, nobody makes up for how guides give way: that is in what the encoders read and in no pose, and a
//! fit would take it for scatter.

use crate::commission::{Bench, GUIDE_STIFFNESS};
use crate::record::RecordError;

/// What the controller was told of the guides' stiffness, N/um; 0 when it makes up for nothing.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub(super) struct GuideGive {
    stiffness_n_um: f64,
}

impl GuideGive {
    /// The controller makes up for nothing from now on.
    ///
    /// # Errors
    /// What it refuses: nothing is changed.
    pub fn set_aside(bench: &mut Bench<'_>) -> Result<Self, RecordError> {
        let mut stiffness_n_um = bench.parameter(GUIDE_STIFFNESS)?;
        if stiffness_n_um == 0.0 {
            // A measurement that was cut off has left none.
            bench.recall(GUIDE_STIFFNESS)?;
            stiffness_n_um = bench.parameter(GUIDE_STIFFNESS)?;
        }
        if stiffness_n_um > 0.0 {
            bench.set(&[(GUIDE_STIFFNESS, 0.0)])?;
        }
        Ok(Self { stiffness_n_um })
    }

    /// As it was.
    ///
    /// # Errors
    /// What the controller refuses: it makes up for nothing then.
    pub fn give_back(self, bench: &mut Bench<'_>) -> Result<(), RecordError> {
        if self.stiffness_n_um > 0.0 {
            bench.set(&[(GUIDE_STIFFNESS, self.stiffness_n_um)])?;
        }
        Ok(())
    }
}
