//! A calibration of a machine as drawn.

use firmware::calibration::MachineCalibration;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::calibration_told;

/// Every number zero.
#[must_use]
pub fn nothing_off() -> MachineCalibration {
    MachineCalibration {
        numbers: [[0.0; 48]; 3],
        ..calibration_told(&StageParameters::REFERENCE)
    }
}
