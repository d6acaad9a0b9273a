//! `tripivot calibrate plan`: poses to measure at.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::plan::{At, Stop};
use calibration::{Instrument, Kit, plan};
use desk::calibrate::PlanTold;
use drawing::write_file;

use super::super::arguments::CalibratePlan;
use super::super::error::CliError;
use super::super::json;
use super::super::units::decimals;
use super::error::CalibrateError;
use super::{line, lines, noise};
use kinematics::Geometry;

pub(super) fn run(arguments: &CalibratePlan) -> Result<ExitCode, CliError> {
    let instrument = Instrument::new(arguments.kit, noise(&arguments.noise));
    let plan = plan(&instrument, arguments.poses).ok_or(CalibrateError::Lost)?;
    let document = PlanTold::new(&instrument, &plan);
    if let Some(path) = &arguments.out {
        write_file(path, table(&instrument, &plan.stops).as_bytes())?;
    }
    if arguments.json {
        json::print(&document)?;
    } else {
        let mut text = lines(&document.lines());
        if let Some(path) = &arguments.out {
            text += &line("poses in", &path.display().to_string());
        }
        (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The poses, for cameras which mark is to be under which place, and for ends which is to be touched.
fn table(instrument: &Instrument, stops: &[Stop]) -> String {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let more = match stops.first().map(|stop| stop.at) {
        Some(At::Mark { .. }) if instrument.kit == Kit::Balls => {
            ",ball_x_mm,ball_y_mm,gauge_x_mm,gauge_y_mm"
        }
        Some(At::Mark { .. }) => ",mark_x_mm,mark_y_mm,camera_x_mm,camera_y_mm",
        Some(At::End { .. }) => ",guide,end_mm",
        _ => "",
    };
    let mut text = format!("x_mm,y_mm,theta_deg{more}\n");
    for stop in stops {
        let mut row = in_mm_deg(stop.pose).to_vec();
        match stop.at {
            At::Pose => {}
            At::Mark { mark, camera } => {
                let drawn = [instrument.marks.get(mark), instrument.cameras.get(camera)];
                let drawn = drawn.into_iter().flatten().flatten();
                row.extend(drawn.map(|value| value * radius_mm));
            }
            At::End { end } => {
                if let Some(&(guide, place)) = instrument.ends.get(end) {
                    row.extend([1.0 + guide as f64, place * radius_mm]);
                }
            }
        }
        let row: Vec<String> = row.into_iter().map(decimals).collect();
        text += &(row.join(",") + "\n");
    }
    text
}

fn in_mm_deg([x, y, theta_rad]: [f64; 3]) -> [f64; 3] {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    [x * radius_mm, y * radius_mm, theta_rad.to_degrees()]
}
