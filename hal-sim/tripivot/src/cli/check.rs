//! `tripivot check`: whether the reference stage can take a pose, and how far that is from each limit.

use std::io::{self, Write};
use std::process::ExitCode;

use kinematics::{Geometry, Infeasible, Margins, Pose, dexterity, feasibility, inverse, margins};
use serde::Serialize;

use super::FAILED;
use super::arguments::PoseArguments;
use super::error::CliError;
use super::json;
use super::units::pose_from;

/// What there is to say of a pose; with `--json` as it stands here.
#[derive(Serialize)]
struct Verdict {
    x_mm: f64,
    y_mm: f64,
    theta_deg: f64,
    reachable: bool,
    reason: Option<String>,
    /// None outside the track, where there are no pivots.
    margins: Option<Distances>,
    /// The smallest.
    separation_deg: Option<f64>,
    dexterity: Option<f64>,
}

/// Distances to the limits, negative beyond them.
#[derive(Serialize)]
struct Distances {
    disk_mm: f64,
    guide_start_mm: f64,
    guide_end_mm: f64,
    separation_deg: f64,
}

pub(super) fn run(arguments: &PoseArguments) -> Result<ExitCode, CliError> {
    let verdict = verdict([arguments.x, arguments.y, arguments.theta])?;
    if arguments.json {
        json::print(&verdict)?;
    } else {
        (io::stdout().write_all(text(&verdict).as_bytes())).map_err(CliError::output)?;
    }
    Ok(if verdict.reachable {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(FAILED)
    })
}

fn verdict([x_mm, y_mm, theta_deg]: [f64; 3]) -> Result<Verdict, CliError> {
    let geometry = Geometry::REFERENCE;
    let pose = pose_from([x_mm, y_mm, theta_deg]);
    let reason = feasibility(&geometry, &pose).err();
    if let Some(reason @ Infeasible::NotFinite) = reason {
        return Err(CliError::Value(reason.to_string()));
    }
    let distances = margins(&geometry, &pose).ok();
    let separation_rad = distances.map(|margins| margins.separation_rad + geometry.separation_rad);
    Ok(Verdict {
        x_mm,
        y_mm,
        theta_deg,
        reachable: reason.is_none(),
        reason: reason.map(|reason| reason.to_string()),
        margins: distances.map(|margins| to_limits(&geometry, &margins)),
        separation_deg: separation_rad.map(f64::to_degrees),
        dexterity: dexterity_at(&pose),
    })
}

fn to_limits(geometry: &Geometry, margins: &Margins<f64>) -> Distances {
    Distances {
        disk_mm: margins.disk * geometry.radius_mm,
        guide_start_mm: margins.guide_start * geometry.radius_mm,
        guide_end_mm: margins.guide_end * geometry.radius_mm,
        separation_deg: margins.separation_rad.to_degrees(),
    }
}

fn dexterity_at(pose: &Pose<f64>) -> Option<f64> {
    Some(dexterity(&inverse(pose).ok()?.guides))
}

fn text(verdict: &Verdict) -> String {
    let head = match &verdict.reason {
        None => "reachable\n".to_owned(),
        Some(reason) => format!("not reachable: {reason}\n"),
    };
    let margins = verdict.margins.as_ref();
    let lines = [
        (
            "margin to the usable disk",
            margins.map(|margins| margins.disk_mm),
            "mm",
        ),
        (
            "margin to a guide's start",
            margins.map(|margins| margins.guide_start_mm),
            "mm",
        ),
        (
            "margin to a guide's end",
            margins.map(|margins| margins.guide_end_mm),
            "mm",
        ),
        (
            "margin of the pivots' separation",
            margins.map(|margins| margins.separation_deg),
            "deg",
        ),
        ("smallest separation", verdict.separation_deg, "deg"),
        ("dexterity", verdict.dexterity, ""),
    ];
    let line = |(what, value, unit): (&str, Option<f64>, &str)| {
        let line = format!("{what:<34}{:>12.6} {unit}", value?);
        Some(line.trim_end().to_owned() + "\n")
    };
    head + &lines.into_iter().filter_map(line).collect::<String>()
}
