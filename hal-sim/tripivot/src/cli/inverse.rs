//! `tripivot inverse`: the pivots of a pose, or what the encoders of a built machine read there.

use std::process::ExitCode;

use kinematics::{InverseError, Pose, corrected_inverse};

use super::arguments::PoseRows;
use super::calibration_file;
use super::error::CliError;
use super::rows;
use super::units::{pose_from, whole_turns_deg};

/// Of the rows that are written: pivots, or encoders.
const PIVOTS: &str = "phi1,phi2,phi3";
const ENCODERS: &str = "m1,m2,m3";

pub(super) fn run(arguments: &PoseRows) -> Result<ExitCode, CliError> {
    let PoseRows { numbers, csv, .. } = arguments;
    match &arguments.built.calibration {
        None => rows::convert(numbers, *csv, PIVOTS, |pose| {
            angles_deg(pose, |pose| Ok(kinematics::inverse(pose)?.pivots))
        }),
        Some(file) => {
            let calibration = calibration_file::read(file)?;
            rows::convert(numbers, *csv, ENCODERS, |pose| {
                angles_deg(pose, |pose| {
                    Ok(corrected_inverse(pose, &calibration)?.encoders)
                })
            })
        }
    }
}

/// Only the track limits it: whether guides and carriages allow the pose is what `tripivot check` tells.
fn angles_deg(
    [x_mm, y_mm, theta_deg]: [f64; 3],
    angles_rad: impl Fn(&Pose<f64>) -> Result<[f64; 3], InverseError>,
) -> Result<[f64; 3], CliError> {
    let turns_deg = whole_turns_deg(theta_deg);
    let pose = pose_from([x_mm, y_mm, theta_deg - turns_deg]);
    let angles_rad = angles_rad(&pose).map_err(|error| match error {
        InverseError::NotFinite => CliError::Value(error.to_string()),
        InverseError::OutsideTrack => CliError::OutOfReach(error.to_string()),
    })?;
    Ok(angles_rad.map(|angle_rad| angle_rad.to_degrees() + turns_deg))
}
