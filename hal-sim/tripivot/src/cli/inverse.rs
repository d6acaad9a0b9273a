//! `tripivot inverse`: the pivots of a pose.

use std::process::ExitCode;

use kinematics::InverseError;

use super::arguments::PoseRows;
use super::error::CliError;
use super::rows;
use super::units::{pose_from, whole_turns_deg};

/// Of the rows that are written.
const HEADER: &str = "phi1,phi2,phi3";

pub(super) fn run(arguments: &PoseRows) -> Result<ExitCode, CliError> {
    rows::convert(&arguments.numbers, arguments.csv, HEADER, pivots_deg)
}

/// Only the track limits it: whether guides and carriages allow the pose is what `tripivot check` tells.
fn pivots_deg([x_mm, y_mm, theta_deg]: [f64; 3]) -> Result<[f64; 3], CliError> {
    let turns_deg = whole_turns_deg(theta_deg);
    let pose = pose_from([x_mm, y_mm, theta_deg - turns_deg]);
    let solution = kinematics::inverse(&pose).map_err(|error| match error {
        InverseError::NotFinite => CliError::Value(error.to_string()),
        InverseError::OutsideTrack => CliError::OutOfReach(error.to_string()),
    })?;
    Ok(solution.pivots.map(|pivot| pivot.to_degrees() + turns_deg))
}
