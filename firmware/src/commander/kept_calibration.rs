//! The calibration that the command side keeps, and what of the pivots' limits it leaves to plans.

use crate::calibration::MachineCalibration;

/// The calibration that there is, and what of it the tick has.
#[derive(Default)]
pub(super) struct KeptCalibration {
    pub kept: Option<MachineCalibration>,
    /// It was kept over a restart, and the tick does not have it yet.
    pub is_due: bool,
    /// Share of the pivots' limits that plans may use.
    share: Option<f64>,
}

impl KeptCalibration {
    /// See [`MachineCalibration::pivot_share`]; 1 exactly where nothing is corrected.
    pub fn pivot_share(&self) -> f64 {
        self.share.unwrap_or(1.0)
    }

    /// Another one, or none.
    pub fn keep(&mut self, wanted: Option<MachineCalibration>) {
        self.share = (wanted.as_ref())
            .filter(|wanted| wanted.is_on)
            .map(MachineCalibration::pivot_share);
        self.kept = wanted;
    }
}
