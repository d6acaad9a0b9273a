//! `tripivot check`: whether the reference stage can take a pose, and how far that is from each limit.

use std::io::{self, Write};
use std::process::ExitCode;

use kinematics::{Geometry, Margins, Pose, dexterity, feasibility, inverse, margins};

use super::FAILED;
use super::arguments::PoseArguments;
use super::error::CliError;
use super::units::pose_from;

pub(super) fn run(arguments: &PoseArguments) -> Result<ExitCode, CliError> {
    let geometry = Geometry::REFERENCE;
    let pose = pose_from([arguments.x, arguments.y, arguments.theta]);
    let verdict = feasibility(&geometry, &pose);
    let mut text = match verdict {
        Ok(_) => "reachable\n".to_owned(),
        Err(reason) => format!("not reachable: {reason}\n"),
    };
    // No pivots, no margins: outside the track, or not finite.
    if let (Ok(margins), Ok(dexterity)) = (margins(&geometry, &pose), dexterity_at(&pose)) {
        text += &table(&geometry, &margins, dexterity);
    }
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    Ok(match verdict {
        Ok(_) => ExitCode::SUCCESS,
        Err(_) => ExitCode::from(FAILED),
    })
}

fn dexterity_at(pose: &Pose<f64>) -> Result<f64, kinematics::InverseError> {
    Ok(dexterity(&inverse(pose)?.guides))
}

fn table(geometry: &Geometry, margins: &Margins<f64>, dexterity: f64) -> String {
    let mm = |radii: f64| radii * geometry.radius_mm;
    let separation_rad = margins.separation_rad + geometry.separation_rad;
    let lines = [
        ("margin to the usable disk", mm(margins.disk), "mm"),
        ("margin to a guide's start", mm(margins.guide_start), "mm"),
        ("margin to a guide's end", mm(margins.guide_end), "mm"),
        (
            "margin of the pivots' separation",
            margins.separation_rad.to_degrees(),
            "deg",
        ),
        ("smallest separation", separation_rad.to_degrees(), "deg"),
        ("dexterity", dexterity, ""),
    ];
    (lines.into_iter())
        .map(|(what, value, unit)| {
            format!("{what:<34}{value:>12.6} {unit}")
                .trim_end()
                .to_owned()
                + "\n"
        })
        .collect()
}
