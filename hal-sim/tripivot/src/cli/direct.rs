//! `tripivot direct`: the pose that three pivots hold.

use std::process::ExitCode;

use super::arguments::PivotRows;
use super::error::CliError;
use super::rows;
use super::units::{pose_to, whole_turns_deg};

/// Of the rows that are written.
const HEADER: &str = "x,y,theta";

pub(super) fn run(arguments: &PivotRows) -> Result<ExitCode, CliError> {
    rows::convert(&arguments.numbers, arguments.csv, HEADER, pose)
}

fn pose(pivots_deg: [f64; 3]) -> Result<[f64; 3], CliError> {
    let turns_deg = whole_turns_deg(pivots_deg[0]);
    let pivots = pivots_deg.map(|pivot_deg| (pivot_deg - turns_deg).to_radians());
    let pose =
        kinematics::direct::<f64>(&pivots).map_err(|error| CliError::Value(error.to_string()))?;
    let [x_mm, y_mm, theta_deg] = pose_to(&pose);
    Ok([x_mm, y_mm, theta_deg + turns_deg])
}
