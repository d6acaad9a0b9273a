//! `tripivot calibrate fit`: a calibration file from what was measured.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use calibration::file::{Calibration, Made};
use calibration::table::Table;
use calibration::{Accuracy, Drift, Fit, FitError, Instrument, fit, left};
use desk::date::today;
use drawing::write_file;
use kinematics::Geometry;
use serde::Serialize;

use super::super::arguments::CalibrateFit;
use super::super::error::CliError;
use super::super::json;
use super::error::CalibrateError;
use super::{URAD_PER_RAD, line, nm, noise, read};

/// What a fit is told as with `--json`.
#[derive(Serialize)]
struct Document {
    kit: &'static str,
    visits: usize,
    /// Lines of the file.
    outliers: Vec<usize>,
    chi2: f64,
    chi2_of_noise: f64,
    scatter_nm: f64,
    chi2_held_out: f64,
    chi2_is_doubtful: bool,
    expected_xy_nm: f64,
    expected_worst_xy_nm: f64,
    expected_theta_urad: f64,
    /// Of the reference pose from first to last, and one standard deviation of that; null where it was not visited often enough.
    drift: Option<Moved>,
    drift_is_significant: bool,
    steps: usize,
    file: String,
}

/// x, y and theta.
#[derive(Serialize)]
struct Moved {
    minutes: f64,
    moved_nm_nm_urad: [f64; 3],
    noise_nm_nm_urad: [f64; 3],
}

pub(super) fn run(arguments: &CalibrateFit) -> Result<ExitCode, CliError> {
    let path = &arguments.file;
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let table = Table::from_text(&read(path)?, radius_mm).map_err(|source| {
        let path = path.clone();
        CalibrateError::Table { path, source }
    })?;
    let instrument = table.instrument(noise(&arguments.noise));
    let (fit, calibration) = calibrated(
        &table,
        &instrument,
        &arguments.serial,
        arguments.temperature,
        path,
    )?;
    let text = calibration.to_text();
    // What would be refused when it is read is not written.
    Calibration::from_text(&text).map_err(CalibrateError::File)?;
    write_file(&arguments.out, text.as_bytes())?;
    let document = document(&fit, &calibration, &table, &arguments.out);
    if arguments.json {
        json::print(&document)?;
    } else {
        (io::stdout().write_all(text_of(&document).as_bytes())).map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The fit, and its calibration.
pub(super) fn calibrated(
    table: &Table,
    instrument: &Instrument,
    serial: &str,
    temperature_c: Option<f64>,
    path: &Path,
) -> Result<(Fit, Calibration), CalibrateError> {
    let fit = fit(instrument, &table.visits).map_err(|error| at_line(path, table, error))?;
    let accuracy = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes())
        .ok_or(CalibrateError::Lost)?;
    let made = made(serial, temperature_c, instrument, table, &fit, &accuracy);
    let calibration = Calibration::new(made, &fit.machine);
    Ok((fit, calibration))
}

/// A fit in words.
pub(super) fn told(fit: &Fit, calibration: &Calibration, table: &Table, out: &Path) -> String {
    text_of(&document(fit, calibration, table, out))
}

fn document(fit: &Fit, calibration: &Calibration, table: &Table, out: &Path) -> Document {
    let made = &calibration.made;
    let noise = made.instrument_noise();
    let left = left(&table.instrument(noise), fit, &table.visits).ok();
    let references = table.references_but(&fit.outliers);
    let drift = left.and_then(|left| Drift::of(&references, &left.visits, &noise));
    Document {
        kit: table.kit.name(),
        visits: made.visits,
        outliers: (fit.outliers.iter())
            .filter_map(|&visit| table.lines.get(visit).copied())
            .collect(),
        chi2: fit.chi2,
        chi2_of_noise: fit.chi2_of_noise,
        scatter_nm: made.scatter_nm,
        chi2_held_out: fit.chi2_held_out,
        chi2_is_doubtful: fit.is_doubtful(),
        expected_xy_nm: made.expected_xy_nm,
        expected_worst_xy_nm: made.expected_worst_xy_nm,
        expected_theta_urad: made.expected_theta_urad,
        drift: drift.map(|drift| {
            let told = |[x, y, theta]: [f64; 3]| [nm(x), nm(y), theta * URAD_PER_RAD];
            Moved {
                minutes: drift.seconds / 60.0,
                moved_nm_nm_urad: told(drift.moved),
                noise_nm_nm_urad: told(drift.noise),
            }
        }),
        drift_is_significant: drift.is_some_and(|drift| drift.is_significant()),
        steps: fit.steps,
        file: out.display().to_string(),
    }
}

/// Says where in the file what a fit refuses stands.
fn at_line(path: &Path, table: &Table, error: FitError) -> CalibrateError {
    let path = path.to_owned();
    match error {
        FitError::Visit { visit, reason } => CalibrateError::Visit {
            path,
            line: table.lines.get(visit).copied().unwrap_or(0),
            reason,
        },
        source => CalibrateError::Fit { path, source },
    }
}

fn made(
    serial: &str,
    temperature_c: Option<f64>,
    instrument: &Instrument,
    table: &Table,
    fit: &Fit,
    accuracy: &Accuracy,
) -> Made {
    Made {
        serial: serial.to_owned(),
        date: today(),
        temperature_c,
        track_radius_mm: Geometry::REFERENCE.radius_mm,
        kit: table.kit,
        noise_nm: nm(instrument.noise.length),
        noise_urad: instrument.noise.angle_rad * URAD_PER_RAD,
        scatter_nm: nm(fit.scatter_rad),
        visits: table.visits.len(),
        outliers: fit.outliers.len(),
        chi2: fit.chi2,
        chi2_held_out: fit.chi2_held_out,
        expected_xy_nm: nm(accuracy.place_rms),
        expected_worst_xy_nm: nm(accuracy.worst_place_rms),
        expected_theta_urad: accuracy.turn_rms_rad * URAD_PER_RAD,
    }
}

/// What the machine does not repeat, in words.
fn scatter(document: &Document) -> String {
    if document.scatter_nm == 0.0 {
        return "none to be seen: the noise explains what is left".to_owned();
    }
    format!(
        "{:.0} nm at each pivot: what is left is {:.1} times the square of the noise, and counts in what is expected",
        document.scatter_nm, document.chi2_of_noise
    )
}

/// What has moved, in words.
fn drift(document: &Document) -> String {
    let Some(Moved {
        minutes,
        moved_nm_nm_urad: [x, y, theta],
        noise_nm_nm_urad: [x_noise, y_noise, theta_noise],
    }) = document.drift
    else {
        return "unknown: the reference pose was not visited often enough".to_owned();
    };
    let verdict = if document.drift_is_significant {
        "more than the noise explains: something was warming up, and `apply` will refuse it"
    } else {
        "no more than the noise explains"
    };
    format!(
        "x {x:.0} nm, y {y:.0} nm, theta {theta:.2} urad in {minutes:.1} min, with {x_noise:.0}, {y_noise:.0} and {theta_noise:.2} by noise: {verdict}"
    )
}

fn text_of(document: &Document) -> String {
    let outliers = match &document.outliers[..] {
        [] => String::new(),
        lines => {
            let lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
            format!(", without those of lines {}", lines.join(", "))
        }
    };
    let doubt = if document.chi2_is_doubtful {
        ": not 1, so the noise is not what was said, or the machine is not of this model, and what is expected does not hold"
    } else {
        ""
    };
    [
        line(
            "measured",
            &format!("{}, {} poses{outliers}", document.kit, document.visits),
        ),
        line(
            "chi^2 a row",
            &format!(
                "{:.2}, {:.2} of poses that were held out{doubt}",
                document.chi2, document.chi2_held_out
            ),
        ),
        line("machine's scatter", &scatter(document)),
        line(
            "expected, x and y",
            &format!(
                "{:.1} nm rms; {:.1} nm rms where it is worst",
                document.expected_xy_nm, document.expected_worst_xy_nm
            ),
        ),
        line(
            "expected, theta",
            &format!("{:.3} urad rms", document.expected_theta_urad),
        ),
        line("drift", &drift(document)),
        line("calibration in", &document.file),
    ]
    .concat()
}
