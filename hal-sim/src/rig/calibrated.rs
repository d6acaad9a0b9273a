//! A stage as it was built, and the calibration that would come of it if nothing were measured wrong.

use super::IDENTITY;
use crate::machine::devices::StageParameters;
use firmware::calibration::{CalibrationText, MachineCalibration};
use kinematics::PivotCoefficients;

/// On which it was measured.
const DATE: &str = "2026-11-23";
const TEMPERATURE_C: f32 = 20.5;

/// A stage with the errors of a workshop in its rings, guides and encoders.
#[must_use]
pub fn built_stage(stage: &StageParameters) -> StageParameters {
    let mut stage = *stage;
    let on = &mut stage.plant.imperfections;
    on.geometry = true;
    on.encoder_eccentricity = true;
    on.encoder_harmonics = true;
    stage
}

/// What is off the drawing of a stage, as far as it is switched on: its true calibration.
#[must_use]
pub fn calibration_told(stage: &StageParameters) -> MachineCalibration {
    let (radius_m, on) = (stage.plant.track_radius_m, &stage.plant.imperfections);
    let radii = |m: f64| m / radius_m;
    let numbers = [0, 1, 2].map(|i| {
        let (pivot, encoder) = (&stage.plant.pivots[i], &stage.encoders[i]);
        let mut built = PivotCoefficients::IDEAL;
        if on.geometry {
            built = PivotCoefficients {
                radius_error: radii(pivot.radius_error_m),
                ring_centre: pivot.ring_centre_m.map(radii),
                guide_error_rad: pivot.guide_error_rad,
                guide_offset: radii(pivot.guide_offset_m),
                runout: pivot.runout_m.map(|pair| pair.map(radii)),
                straightness: pivot.straightness_m.map(radii),
                ..built
            };
        }
        if on.encoder_eccentricity {
            let (sin, cos) = encoder.eccentricity_phase_rad.sin_cos();
            built.encoder_rad[0] = [-sin, cos].map(|part| encoder.eccentricity_rad * part);
        }
        if on.encoder_harmonics {
            built.encoder_rad[1..].copy_from_slice(&encoder.harmonics_rad);
        }
        built.to_list().map(|number| number as f32)
    });
    MachineCalibration {
        serial: text(IDENTITY.serial),
        date: text(DATE),
        temperature_c: Some(TEMPERATURE_C),
        numbers,
        is_on: true,
    }
}

fn text(text: &str) -> CalibrationText {
    CalibrationText::try_from(text).unwrap_or_default()
}
