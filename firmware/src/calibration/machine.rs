//! A calibrated machine: its numbers, whose they are and how they came about.

use super::{Calibration, CalibrationMargins};
use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::String;
use kinematics::{COEFFICIENTS, Corrections, Geometry, PivotCoefficients, Series};

/// Longest serial number, and longest date.
pub const CALIBRATION_TEXT_BYTES: usize = 32;
/// A rate of a pivot is more than planned by the sum of the errors of angles, over the smallest cosine on the disk.
const OVER_SMALLEST_COSINE: f64 = 1.0 / 0.6;
/// A calibration that would take more of the pivots' limits is none that is taken.
const SMALLEST_SHARE: f64 = 0.5;

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The numbers of the three pivots, in the order of [`PivotCoefficients`]: track radii and rad. Of the largest that is taken a
/// float of 32 bits leaves 1e-9.
pub type CalibrationNumbers = [[f32; COEFFICIENTS]; 3];

/// A machine's serial number, or a date.
pub type CalibrationText = String<CALIBRATION_TEXT_BYTES>;

/// What a machine is off the drawing, exactly: for the command side.
pub type BuiltMachine = Corrections<f64, Series<f64>>;

/// A calibrated machine.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineCalibration {
    /// Serial number of the controller that it is for.
    pub serial: CalibrationText,
    /// Day on which it was measured.
    pub date: CalibrationText,
    /// Temperature at which it was measured, deg C.
    pub temperature_c: Option<f32>,
    /// What is off.
    pub numbers: CalibrationNumbers,
    /// Whether it counts.
    pub is_on: bool,
}

/// The corrected kinematics do not hold for a calibration: a number is beyond its limit or none, or pivots stand too far
/// from where the drawing has them. Most often an encoder's zero is not the parameter's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BeyondLimits;

impl MachineCalibration {
    /// The numbers by their names.
    pub fn pivots(&self) -> [PivotCoefficients; 3] {
        (self.numbers).map(|numbers| PivotCoefficients::from_list(&numbers.map(f64::from)))
    }

    /// CRC-32 of the numbers' bytes, each number's lowest first, then of serial number and date.
    pub fn checksum(&self) -> u32 {
        let mut digest = CRC.digest();
        for number in self.numbers.as_flattened() {
            digest.update(&number.to_le_bytes());
        }
        digest.update(self.serial.as_bytes());
        digest.update(self.date.as_bytes());
        digest.finalize()
    }

    /// For the tick, with its margins.
    ///
    /// # Errors
    /// [`BeyondLimits`].
    pub fn for_tick(
        &self,
        geometry: &Geometry,
    ) -> Result<(Calibration, CalibrationMargins), BeyondLimits> {
        let pivots = self.pivots();
        let calibration: Calibration =
            Corrections::new(&pivots, Series::new).map_err(|_| BeyondLimits)?;
        let margins =
            CalibrationMargins::new(&pivots, &calibration, geometry).ok_or(BeyondLimits)?;
        if self.pivot_share() < SMALLEST_SHARE {
            return Err(BeyondLimits);
        }
        Ok((calibration, margins))
    }

    /// For the command side, if it counts.
    pub fn built(&self) -> Option<BuiltMachine> {
        if !self.is_on {
            return None;
        }
        Corrections::new(&self.pivots(), Series::new).ok()
    }

    /// The share of the pivots' limits that plans for the drawn machine may use, for the built one to keep them.
    pub fn pivot_share(&self) -> f64 {
        let size = |numbers: &[f64]| numbers.iter().map(|number| number.abs()).sum::<f64>();
        let mut worst = 0.0_f64;
        for pivot in self.pivots() {
            let mut off = pivot.guide_error_rad.abs()
                + pivot.guide_offset.abs()
                + pivot.radius_error.abs()
                + size(&pivot.ring_centre);
            let mut order = 0.0;
            for pair in &pivot.encoder_rad {
                order += 1.0;
                off += order * size(pair);
            }
            worst = worst.max(off);
        }
        1.0 - worst * OVER_SMALLEST_COSINE
    }
}
