//! The machine's temperature, as somebody tells it: the controller has no thermometer.
//!
//! A machine of one material is the same machine at any temperature, with all lengths in one proportion: radii, ring centres, offsets of
//! the guides, run-out and straightness. No angle changes, and no number in track radii. So what changes is the track's radius, by which mm
//! become track radii and back: calibration and tick go on as they are. The radius is the parameter's at the calibration's temperature.
//!
//! Steel grows by 12 ppm per K, aluminium by 23: 1.0 and 1.8 um at 80 mm from the middle.

use super::error::CommandError;
use super::kept_temperature::Temperature;
use super::state::Commander;
use crate::calibration::MachineCalibration;

impl Commander {
    /// The machine is at so many deg C; without a growth (ppm per K) the one before stays. From the next target on, and in every pose that is
    /// told, lengths are those of that temperature. Nothing moves.
    ///
    /// # Errors
    /// [`CommandError::InMotion`], and [`CommandError::RadiusWithToolFrame`] while a point beside the platform's centre is moved.
    pub fn set_temperature(
        &mut self,
        celsius: f64,
        growth_ppm_per_k: Option<f64>,
    ) -> Result<(), CommandError> {
        if self.is_motion_commanded() {
            return Err(CommandError::InMotion);
        }
        let wanted = Temperature {
            celsius: Some(celsius),
            growth_ppm_per_k: growth_ppm_per_k.unwrap_or(self.temperature.growth_ppm_per_k),
        };
        self.check_growth(wanted.growth(self.calibration()))?;
        self.temperature = wanted;
        self.grow_track();
        Ok(())
    }

    /// What was told of the temperature, deg C.
    pub const fn temperature_c(&self) -> Option<f64> {
        self.temperature.celsius
    }

    /// How much longer lengths become, ppm per K.
    pub const fn growth_ppm_per_k(&self) -> f64 {
        self.temperature.growth_ppm_per_k
    }

    /// How much warmer the machine is than when it was calibrated, K; `None` where one of the two is not known, or no calibration counts.
    pub fn over_calibrated_k(&self) -> Option<f64> {
        self.temperature.over(self.calibration())
    }

    /// Lengths now over those of the calibration's temperature.
    pub(crate) fn growth(&self) -> f64 {
        self.temperature.growth(self.calibration())
    }

    /// Another calibration can make the track another size too.
    ///
    /// # Errors
    /// As [`Self::set_temperature`]: the tick knows a point beside the platform's centre in track radii.
    pub(super) fn check_calibrated_growth(
        &self,
        wanted: Option<&MachineCalibration>,
    ) -> Result<(), CommandError> {
        self.check_growth(self.temperature.growth(wanted))
    }

    fn check_growth(&self, growth: f64) -> Result<(), CommandError> {
        let moved = self.active_frames.tool.origin() != [0.0; 2];
        if moved && growth != self.growth() {
            return Err(CommandError::RadiusWithToolFrame);
        }
        Ok(())
    }

    /// The track as it is now; after everything that has a part in it.
    pub(super) fn grow_track(&mut self) {
        self.base_constraints.geometry.radius_mm = self.drawn_radius_mm * self.growth();
    }
}
