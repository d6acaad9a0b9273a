//! `tripivot inverse`: the pivots of a pose.

use std::process::ExitCode;

use super::arguments::PoseRows;
use super::error::CliError;
use super::rows;
use super::units::{pose_from, whole_turns_deg};

pub(super) fn run(arguments: &PoseRows) -> Result<ExitCode, CliError> {
    rows::convert(&arguments.numbers, arguments.csv, pivots_deg)
}

/// Only the track limits it: whether guides and carriages allow the pose is what `tripivot check` tells.
fn pivots_deg([x_mm, y_mm, theta_deg]: [f64; 3]) -> Result<[f64; 3], String> {
    let turns_deg = whole_turns_deg(theta_deg);
    let pose = pose_from([x_mm, y_mm, theta_deg - turns_deg]);
    let solution = kinematics::inverse(&pose).map_err(|error| error.to_string())?;
    Ok(solution.pivots.map(|pivot| pivot.to_degrees() + turns_deg))
}
