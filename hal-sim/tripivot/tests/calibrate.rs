//! Calibration on the command line: a plan, a measurement by a simulated instrument at its poses, the fit, and what is refused.

mod calibrate_command;

use calibrate_command::{RADIUS_MM, calibrate, folder, is_done};
use std::fs;
use std::process::Output;

use calibration::file::Calibration;
use calibration::frames::without_frames;
use calibration::plan::{At, Stop};
use calibration::spread::over_disk;
use calibration::table;
use calibration::{Instrument, Kit, Noise};
use hal_sim::machine::instruments::{commanded, survey, workshop};
use hal_sim::random::Random;
use serde_json::Value;

fn document(output: &Output) -> Value {
    serde_json::from_str(&is_done(output)).unwrap()
}

/// This exit code, and one line on standard error with these words in it.
fn assert_refused(output: &Output, code: i32, words: &str) {
    calibrate_command::assert_refused(output, code, words);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(error.lines().count(), 1, "{error}");
}

/// Rows of numbers under a header.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

fn instrument(kit: Kit) -> Instrument {
    let noise = Noise {
        length: 50e-6 / RADIUS_MM,
        angle_rad: 1e-6,
        encoder_rad: Noise::ENCODER_RAD,
    };
    Instrument::new(kit, noise)
}

/// What an interferometer reads of a machine that nobody has calibrated.
fn measured(stops: &[Stop]) -> String {
    let instrument = instrument(Kit::Xyt);
    let visits = survey(
        &workshop::machine(3),
        &instrument,
        stops,
        &mut Random::new(3),
    );
    table::to_text(&instrument, &visits.unwrap(), RADIUS_MM)
}

fn spread(count: usize) -> Vec<Stop> {
    let stop = |pose| Stop { pose, at: At::Pose };
    over_disk(0.8).take(count).map(stop).collect()
}

#[test]
fn a_machine_is_planned_measured_and_fitted() {
    let folder = folder("whole");
    let plan = ["plan", "--kit", "xyt", "--noise", "50nm", "--poses", "200"];
    let told = document(&calibrate(
        &folder,
        &[&plan[..], &["--out", "plan.csv", "--json"]].concat(),
    ));
    assert_eq!(told["poses"], 200);
    assert_eq!(told["yours_to_choose"].as_array().unwrap().len(), 6);
    assert_eq!(told["not_identifiable"].as_array().unwrap().len(), 0);
    let expected_nm = told["expected_xy_nm"].as_f64().unwrap();
    assert!((30.0..50.0).contains(&expected_nm), "{expected_nm}");
    let text = fs::read_to_string(folder.join("plan.csv")).unwrap();
    assert!(text.starts_with("x_mm,y_mm,theta_deg\n"), "{text}");
    let stops: Vec<Stop> = (rows(&text).into_iter())
        .map(|row| Stop {
            pose: [row[0] / RADIUS_MM, row[1] / RADIUS_MM, row[2].to_radians()],
            at: At::Pose,
        })
        .collect();
    assert_eq!(stops.len(), 200);

    // A comment and an empty line in front; line 12 is the visit that somebody has knocked.
    let mut lines: Vec<String> = measured(&stops).lines().map(str::to_owned).collect();
    lines.splice(0..0, ["# measured by night".to_owned(), String::new()]);
    let mut cells: Vec<String> = lines[11].split(',').map(str::to_owned).collect();
    cells[3] = format!("{:.9}", cells[3].parse::<f64>().unwrap() + 0.004);
    lines[11] = cells.join(",");
    fs::write(folder.join("measured.csv"), lines.join("\n")).unwrap();
    let fit = [
        "fit",
        "measured.csv",
        "--noise",
        "50nm",
        "--noise-theta",
        "1urad",
        "--out",
        "own.toml",
    ];
    let more = ["--serial", "bench 3", "--temperature", "20.4", "--json"];
    let told = document(&calibrate(&folder, &[&fit[..], &more].concat()));
    assert_eq!(told["outliers"], serde_json::json!([12]));
    assert_eq!(told["chi2_is_doubtful"], false, "{told}");
    let text = fs::read_to_string(folder.join("own.toml")).unwrap();
    let calibration = Calibration::from_text(&text).unwrap();
    assert_eq!(calibration.made.serial, "bench 3");
    assert_eq!(calibration.made.kit, Kit::Xyt);
    let poses = over_disk(0.8).skip(5000).take(500);
    let pairs = commanded(
        &workshop::machine(3),
        &calibration.machine(),
        poses,
        &mut Random::new(1),
    )
    .unwrap();
    let left_nm = without_frames(&pairs).size().place_rms * RADIUS_MM * 1e6;
    assert!(left_nm < 50.0, "{left_nm}");
    assert!(
        (0.7..1.4).contains(&(left_nm / expected_nm)),
        "{left_nm} {expected_nm}"
    );
    // In words.
    let text = is_done(&calibrate(&folder, &fit));
    assert!(
        text.contains("xyt, 200 poses, without those of lines 12\n"),
        "{text}"
    );
    // An instrument that is better than said.
    let mut fit = fit;
    (fit[3], fit[5]) = ("100nm", "2urad");
    let said = calibrate(&folder, &fit);
    let text = String::from_utf8_lossy(&said.stdout);
    let doubt = "under 1, so the noise is less than was said";
    assert!(text.contains(doubt), "{text}");
}

#[test]
fn a_plan_says_what_an_instrument_cannot_tell() {
    let folder = folder("freedoms");
    let plan = ["plan", "--noise", "0.5um", "--poses", "40", "--kit"];
    let text = is_done(&calibrate(
        &folder,
        &[&plan[..], &["camera", "--out", "p.csv"]].concat(),
    ));
    assert!(
        text.contains("shear of the plate; aspect ratio of the plate\n"),
        "{text}"
    );
    assert!(text.contains("; scale\n"), "{text}");
    let stops = fs::read_to_string(folder.join("p.csv")).unwrap();
    assert!(stops.starts_with("x_mm,y_mm,theta_deg,mark_x_mm,mark_y_mm,camera_x_mm,camera_y_mm\n"));
    assert_eq!(rows(&stops).len(), 40);
    for row in rows(&stops) {
        // The mark is under the camera there.
        let (sin, cos) = row[2].to_radians().sin_cos();
        assert!(
            (row[0] + cos * row[3] - sin * row[4] - row[5]).abs() < 1e-9,
            "{row:?}"
        );
        assert!(
            (row[1] + sin * row[3] + cos * row[4] - row[6]).abs() < 1e-9,
            "{row:?}"
        );
    }
    let text = is_done(&calibrate(&folder, &[&plan[..], &["theta"]].concat()));
    assert!(
        text.contains("more directions of the machine's numbers"),
        "{text}"
    );
}

#[test]
fn wrong_files_and_options_are_refused() {
    let folder = folder("wrong");
    let good = measured(&spread(60));
    let head = good.lines().next().unwrap();
    let line = |at: usize| good.lines().nth(at).unwrap();
    let fit = |text: &str| {
        fs::write(folder.join("m.csv"), text).unwrap();
        calibrate(
            &folder,
            &["fit", "m.csv", "--noise", "50nm", "--out", "c.toml"],
        )
    };
    for (text, code, words) in [
        ("", 2, "m.csv: no rows: the first names the columns"),
        (
            "x,y\n",
            2,
            "m.csv: line 1: 'x,y' are no instrument's columns",
        ),
        (
            &format!("{head}\n{}\n1,2,3\n", line(1)),
            2,
            "m.csv: line 3: 3 values where 6 are expected",
        ),
        (
            &format!("{head}\n\n1,2,3,4,5,six\n"),
            2,
            "m.csv: line 3: 'six' is not a number",
        ),
        (
            &format!("{head}\n1,2,3,4,5,NaN\n"),
            2,
            "m.csv: line 2: 'NaN' is not a number",
        ),
        (
            &format!("{head}\n{}\n", line(1)),
            1,
            "m.csv: 1 visits: a fit needs 12 or more",
        ),
        (
            &good.replacen(line(20), "10,10,10,0,0,0", 1),
            2,
            "m.csv: line 21: no pose has these encoder angles",
        ),
    ] {
        assert_refused(&fit(text), code, words);
        assert!(!folder.join("c.toml").exists(), "{text}");
    }
    let none = ["fit", "none.csv", "--noise", "50nm", "--out", "c.toml"];
    assert_refused(&calibrate(&folder, &none), 2, "cannot read none.csv: ");
    let plan = |arguments: &[&str]| calibrate(&folder, &[&["plan"][..], arguments].concat());
    let kit = plan(&["--kit", "sextant", "--noise", "1nm", "--poses", "20"]);
    assert_refused(
        &kit,
        2,
        "there are xyt, xy, theta, camera, camera2, balls, ends",
    );
    for noise in ["50", "0nm", "50urad", "nm", "NaNnm", "2mm"] {
        let output = plan(&["--kit", "xyt", "--noise", noise, "--poses", "20"]);
        assert_refused(&output, 2, "not a length from 0.1nm to 1mm, such as 50nm");
    }
    let few = plan(&["--kit", "xyt", "--noise", "1nm", "--poses", "3"]);
    assert_refused(&few, 2, "not from 12 to 3000");
}
