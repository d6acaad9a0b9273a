//! `tripivot calibrate plan`: poses to measure at.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::plan::{At, Stop};
use calibration::{Instrument, Kit, Plan, plan};
use drawing::write_file;
use serde::Serialize;

use super::super::arguments::CalibratePlan;
use super::super::error::CliError;
use super::super::json;
use super::super::units::decimals;
use super::error::CalibrateError;
use super::{URAD_PER_RAD, line, nm, noise};
use kinematics::Geometry;

/// What a plan is told as with `--json`.
#[derive(Serialize)]
struct Document {
    kit: &'static str,
    noise_nm: f64,
    noise_urad: f64,
    poses: usize,
    expected_xy_nm: f64,
    expected_worst_xy_nm: f64,
    worst_pose: [f64; 3],
    expected_theta_urad: f64,
    yours_to_choose: Vec<String>,
    not_identifiable: Vec<String>,
    more_not_identifiable: usize,
    held_by_tolerances: usize,
    numbers: usize,
}

pub(super) fn run(arguments: &CalibratePlan) -> Result<ExitCode, CliError> {
    let instrument = Instrument::new(arguments.kit, noise(&arguments.noise));
    let plan = plan(&instrument, arguments.poses).ok_or(CalibrateError::Lost)?;
    let document = document(&instrument, &plan);
    if let Some(path) = &arguments.out {
        write_file(path, table(&instrument, &plan.stops).as_bytes())?;
    }
    if arguments.json {
        json::print(&document)?;
    } else {
        let mut text = text(&document);
        if let Some(path) = &arguments.out {
            text += &line("poses in", &path.display().to_string());
        }
        (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn document(instrument: &Instrument, plan: &Plan) -> Document {
    let named = |is_choice: bool| {
        let freedoms = plan.freedoms.named.iter();
        let wanted = freedoms.filter(|freedom| freedom.is_choice() == is_choice);
        wanted.map(ToString::to_string).collect::<Vec<_>>()
    };
    let accuracy = &plan.accuracy;
    Document {
        kit: instrument.kit.name(),
        noise_nm: nm(instrument.noise.length),
        noise_urad: instrument.noise.angle_rad * URAD_PER_RAD,
        poses: plan.stops.len(),
        expected_xy_nm: nm(accuracy.place_rms),
        expected_worst_xy_nm: nm(accuracy.worst_place_rms),
        worst_pose: in_mm_deg(accuracy.worst_pose),
        expected_theta_urad: accuracy.turn_rms_rad * URAD_PER_RAD,
        yours_to_choose: named(true),
        not_identifiable: named(false),
        more_not_identifiable: plan.freedoms.unnamed(),
        held_by_tolerances: plan.held_by_priors.saturating_sub(plan.freedoms.count),
        numbers: instrument.unknowns(),
    }
}

fn text(document: &Document) -> String {
    let [x, y, theta] = document.worst_pose;
    let mut lost = document.not_identifiable.clone();
    if document.more_not_identifiable > 0 {
        lost.push(format!(
            "{} more directions of the machine's numbers",
            document.more_not_identifiable
        ));
    }
    let listed = |list: &[String]| match list {
        [] => "nothing".to_owned(),
        list => list.join("; "),
    };
    [
        line(
            "instrument",
            &format!(
                "{}, {} poses, {:.4} nm and {:.4} urad",
                document.kit, document.poses, document.noise_nm, document.noise_urad
            ),
        ),
        line(
            "expected, x and y",
            &format!(
                "{:.1} nm rms; {:.1} nm rms where it is worst, at {x:.1} {y:.1} mm {theta:.1} deg",
                document.expected_xy_nm, document.expected_worst_xy_nm
            ),
        ),
        line(
            "expected, theta",
            &format!("{:.3} urad rms", document.expected_theta_urad),
        ),
        line("yours to choose", &listed(&document.yours_to_choose)),
        line("not identifiable", &listed(&lost)),
        line(
            "held by tolerances",
            &match document.held_by_tolerances {
                0 => format!("none of {} numbers", document.numbers),
                held => format!(
                    "{held} of {} numbers: too few poses or too much noise to tell more than a workshop keeps",
                    document.numbers
                ),
            },
        ),
    ]
    .concat()
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
