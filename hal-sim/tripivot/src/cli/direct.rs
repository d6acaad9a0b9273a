//! `tripivot direct`: the pose that three pivots hold, or that the encoders of a built machine mean.

use std::process::ExitCode;

use kinematics::{DirectError, Pose, corrected_direct, direct};

use super::arguments::PivotRows;
use super::calibration_file;
use super::error::CliError;
use super::rows;
use super::units::{pose_to, whole_turns_deg};

/// Of the rows that are written.
const HEADER: &str = "x,y,theta";
/// Three are good to 1e-11; the fourth leaves roundings.
const STEPS: u32 = 4;

pub(super) fn run(arguments: &PivotRows) -> Result<ExitCode, CliError> {
    let PivotRows { numbers, csv, .. } = arguments;
    match &arguments.built.calibration {
        None => rows::convert(numbers, *csv, HEADER, |pivots| pose(pivots, direct::<f64>)),
        Some(file) => {
            let calibration = calibration_file::read(file)?;
            rows::convert(numbers, *csv, HEADER, |encoders| {
                pose(encoders, |encoders| {
                    corrected_direct::<f64, _>(encoders, &calibration, STEPS)
                })
            })
        }
    }
}

fn pose(
    angles_deg: [f64; 3],
    pose: impl Fn(&[f64; 3]) -> Result<Pose<f64>, DirectError>,
) -> Result<[f64; 3], CliError> {
    let turns_deg = whole_turns_deg(angles_deg[0]);
    let angles_rad = angles_deg.map(|angle_deg| (angle_deg - turns_deg).to_radians());
    let pose = pose(&angles_rad).map_err(|error| CliError::Value(error.to_string()))?;
    let [x_mm, y_mm, theta_deg] = pose_to(&pose);
    Ok([x_mm, y_mm, theta_deg + turns_deg])
}
