//! A stage as it was built, and its calibration as lines for the controller.

use firmware::calibration::{CalibrationText, MachineCalibration};
use hal_sim::machine::devices::StageParameters;
use kinematics::PivotCoefficients;
use std::fmt::Write;

/// Numbers in a line.
const LINE_NUMBERS: usize = 8;

/// The reference stage with the errors of a workshop in its rings, guides and encoders.
#[must_use]
pub fn built_stage() -> StageParameters {
    let mut stage = StageParameters::REFERENCE;
    let on = &mut stage.plant.imperfections;
    on.geometry = true;
    on.encoder_eccentricity = true;
    on.encoder_harmonics = true;
    stage
}

/// What is off the drawing of a stage, as its calibration would be if nothing were measured wrong.
#[must_use]
pub fn calibration_of(stage: &StageParameters) -> MachineCalibration {
    let radius_m = stage.plant.track_radius_m;
    let radii = |m: f64| m / radius_m;
    let numbers = [0, 1, 2].map(|i| {
        let (pivot, encoder) = (&stage.plant.pivots[i], &stage.encoders[i]);
        let mut built = PivotCoefficients {
            radius_error: radii(pivot.radius_error_m),
            ring_centre: pivot.ring_centre_m.map(radii),
            guide_error_rad: pivot.guide_error_rad,
            guide_offset: radii(pivot.guide_offset_m),
            runout: pivot.runout_m.map(|pair| pair.map(radii)),
            straightness: pivot.straightness_m.map(radii),
            ..PivotCoefficients::IDEAL
        };
        let (sin, cos) = encoder.eccentricity_phase_rad.sin_cos();
        built.encoder_rad[0] = [-sin, cos].map(|part| encoder.eccentricity_rad * part);
        built.encoder_rad[1..].copy_from_slice(&encoder.harmonics_rad);
        built.to_list().map(|number| number as f32)
    });
    MachineCalibration {
        serial: text("SIM"),
        date: text("2026-11-23"),
        temperature_c: Some(20.5),
        numbers,
        is_on: true,
    }
}

/// The same with every number zero.
#[must_use]
pub fn nothing_off() -> MachineCalibration {
    MachineCalibration {
        numbers: [[0.0; 48]; 3],
        ..calibration_of(&StageParameters::REFERENCE)
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

fn text(text: &str) -> CalibrationText {
    CalibrationText::try_from(text).unwrap_or_default()
}
