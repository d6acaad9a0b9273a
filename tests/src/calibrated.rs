//! A calibration as lines for the controller.

use firmware::calibration::MachineCalibration;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::calibration_told;
use std::fmt::Write;

/// Numbers in a line.
const LINE_NUMBERS: usize = 8;

/// The same with every number zero.
#[must_use]
pub fn nothing_off() -> MachineCalibration {
    MachineCalibration {
        numbers: [[0.0; 48]; 3],
        ..calibration_told(&StageParameters::REFERENCE)
    }
}

/// The lines that send a calibration, for a connection of command level 1.
#[must_use]
pub fn lines(calibration: &MachineCalibration) -> Vec<String> {
    let mut lines = vec![format!(
        "CAL BEG {} {} 20.5",
        calibration.serial, calibration.date
    )];
    for (i, pivot) in calibration.numbers.iter().enumerate() {
        for (part, numbers) in pivot.chunks(LINE_NUMBERS).enumerate() {
            let mut line = format!("CAL SET {} {}", i + 1, part * LINE_NUMBERS + 1);
            for number in numbers {
                // Writing to a string does not fail.
                let _ = write!(line, " {number:e}");
            }
            lines.push(line);
        }
    }
    lines.push(format!("CAL END {}", calibration.checksum()));
    lines
}
