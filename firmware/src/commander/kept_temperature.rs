//! Kept of the machine's temperature: how much longer lengths are than when it was calibrated.

use crate::calibration::MachineCalibration;

/// What is told of the machine's temperature, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Temperature {
    /// What it is, deg C.
    pub celsius: Option<f64>,
    /// How much longer lengths become, ppm per K.
    pub growth_ppm_per_k: f64,
}

impl Temperature {
    /// How much warmer than when this was calibrated, K.
    pub fn over(&self, calibration: Option<&MachineCalibration>) -> Option<f64> {
        let then = calibration.filter(|calibration| calibration.is_on)?;
        Some(self.celsius? - f64::from(then.temperature_c?))
    }

    /// A length over what it was when this was calibrated; exactly 1 where one of the two temperatures is not known.
    pub fn growth(&self, calibration: Option<&MachineCalibration>) -> f64 {
        (self.over(calibration)).map_or(1.0, |over_k| 1.0 + over_k * self.growth_ppm_per_k * 1e-6)
    }
}
