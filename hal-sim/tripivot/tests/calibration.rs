//! `tripivot inverse` and `direct` of a built machine: its errors from a file, in either form, and what is said of a
//! file that is wrong.

use std::fmt::Write as _;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use calibration::file::with_checksum;
use serde_json::{Map, Value, json};

const CSV: &str = include_str!("../../../kinematics/tests/data/built-all.csv");
const FLAT: &str = include_str!("../../../kinematics/tests/data/built-all.json");

/// Runs the binary with this calibration and `input` on its standard input.
fn calibrated(command: &str, file: &Path, input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args([command, "--csv", "--calibration"])
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    // It may have ended already, at a bad file.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    child.wait_with_output().expect("the binary ends")
}

fn stdout(output: &Output) -> String {
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

/// A file of this test's own.
fn file(name: &str, text: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("calibration");
    fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    fs::write(&path, text).expect("a file");
    path
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect()
    };
    text.lines().skip(1).map(numbers).collect()
}

/// Poses of the published machine in mm and deg, with a header.
fn poses() -> String {
    let mut text = "x,y,theta\n".to_owned();
    for row in rows(CSV) {
        let (x_mm, y_mm, theta_deg) = (row[0] * 100.0, row[1] * 100.0, row[2].to_degrees());
        let _ = writeln!(text, "{x_mm},{y_mm},{theta_deg}");
    }
    text
}

/// The same machine as a fit writes it.
fn ours() -> Value {
    let flat: Map<String, Value> = serde_json::from_str(FLAT).expect("an object");
    let number = |key: String| flat[&key].as_f64().expect("a number");
    let pivots: Vec<Value> = (0..3)
        .map(|i| {
            let mm = |key: String| 100.0 * number(key);
            let pair =
                |curve: &str, k: usize| [format!("{curve}c{k}_{i}"), format!("{curve}s{k}_{i}")];
            json!({
                "encoder_zero_rad": number(format!("z{i}")),
                "radius_error_mm": mm(format!("dR{i}")),
                "ring_centre_mm": [mm(format!("ax{i}")), mm(format!("ay{i}"))],
                "guide_error_rad": number(format!("e{i}")),
                "guide_offset_mm": mm(format!("d{i}")),
                "encoder_rad": (1..=12).map(|k| pair("E", k).map(number)).collect::<Vec<_>>(),
                "runout_mm": (2..=6).map(|k| pair("r", k).map(mm)).collect::<Vec<_>>(),
                "straightness_mm": (2..=9).map(|k| mm(format!("S{k}_{i}"))).collect::<Vec<_>>(),
            })
        })
        .collect();
    let made = json!({
        "serial": "published", "date": "2026-11-23", "track_radius_mm": 100.0, "kit": "xyt", "noise_nm": 5.0, "noise_urad": 0.1,
        "visits": 200, "outliers": 0, "chi2": 1.0, "chi2_held_out": 1.0, "expected_xy_nm": 5.0, "expected_worst_xy_nm": 9.0,
        "expected_theta_urad": 0.1,
    });
    json!({ "made": made, "pivots": pivots })
}

fn toml_of(document: &Value) -> String {
    with_checksum(&toml::to_string(document).expect("numbers and words"))
}

#[test]
fn encoders_are_those_of_the_published_poses_and_lead_back_to_them() {
    for (name, text) in [
        ("flat.json", FLAT.to_owned()),
        ("ours.toml", toml_of(&ours())),
    ] {
        let file = file(name, &text);
        let encoders = stdout(&calibrated("inverse", &file, &poses()));
        assert!(encoders.starts_with("m1,m2,m3\n"), "{encoders}");
        let got = rows(&encoders);
        assert_eq!(got.len(), 200);
        for (got, want) in got.iter().zip(rows(CSV)) {
            for i in 0..3 {
                let error_rad = got[i].to_radians() - want[6 + i];
                assert!(error_rad.abs() < 1e-11, "{name}: {error_rad}");
            }
        }
        let back = stdout(&calibrated("direct", &file, &encoders));
        assert!(back.starts_with("x,y,theta\n"), "{back}");
        for (got, want) in rows(&back).iter().zip(rows(&poses())) {
            for (got, want) in got.iter().zip(want) {
                assert!((got - want).abs() < 1e-11, "{name}: {got}, expected {want}");
            }
        }
    }
}

/// Digit for digit, many turns away too.
#[test]
fn a_machine_as_drawn_is_as_without_a_file() {
    let zeros: Map<String, Value> = serde_json::from_str::<Map<String, Value>>(FLAT)
        .expect("an object")
        .into_iter()
        .map(|(key, _)| (key, json!(0)))
        .collect();
    let file = file("zeros.json", &Value::from(zeros).to_string());
    let poses = "1,2,3\n-41.25,33.5,-359987.125\n60,-50,170\n";
    let built = stdout(&calibrated("inverse", &file, poses));
    let plain = |command: &str, row: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .arg(command)
            .args(row.split(','))
            .output()
            .expect("the binary runs");
        stdout(&output).replace(' ', ",")
    };
    for (pose, encoders) in poses.lines().zip(built.lines()) {
        assert_eq!(plain("inverse", pose).trim(), encoders);
        let back = stdout(&calibrated("direct", &file, encoders));
        assert_eq!(plain("direct", encoders), back);
    }
}

#[test]
fn a_pose_out_of_reach_is_told_apart_from_a_file_that_is_wrong() {
    let file = file("reach.json", FLAT);
    // Inside the track, but a guide of this machine passes outside of its ring.
    let output = calibrated("inverse", &file, "-99.9,0,0\n");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.contains("row 1: the centre lies on or outside the track"),
        "{stderr}"
    );
}

/// Exit code 2, one line that names the file and what is wrong with it, and no row answered.
#[test]
fn a_wrong_file_is_refused_whole() {
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut document = ours();
        change(&mut document);
        toml_of(&document)
    };
    let flat = |from: &str, to: &str| {
        assert_eq!(FLAT.matches(from).count(), 1, "{from}");
        FLAT.replace(from, to)
    };
    let cases = [
        ("no.toml", "z0: 1".to_owned(), "line 1"),
        ("empty.json", "{}".to_owned(), "'z0' is missing"),
        (
            "unknown.toml",
            changed(&|document| document["pivots"][1]["run_out_mm"] = json!(0)),
            "unknown field `run_out_mm`",
        ),
        (
            "beside.toml",
            changed(&|document| document["date"] = json!("today")),
            "unknown field `date`",
        ),
        (
            "missing.toml",
            changed(&|document| {
                document["pivots"][2]
                    .as_object_mut()
                    .expect("an object")
                    .remove("runout_mm");
            }),
            "missing field `runout_mm`",
        ),
        (
            "two.toml",
            changed(&|document| {
                document["pivots"].as_array_mut().expect("a list").pop();
            }),
            "invalid length 2",
        ),
        (
            "text.toml",
            changed(&|document| document["pivots"][0]["radius_error_mm"] = json!("1")),
            "invalid type: string",
        ),
        (
            "large.toml",
            changed(&|document| document["pivots"][2]["guide_offset_mm"] = json!(2.5)),
            "guide_offset",
        ),
        (
            "flat-unknown.json",
            flat("\"z0\"", "\"z3\": 0, \"z0\""),
            "unknown key 'z3'",
        ),
        (
            "flat-missing.json",
            flat("\"dR1\"", "\"dr1\""),
            "'dR1' is missing",
        ),
        (
            "flat-twice.json",
            flat("\"S9_2\"", "\"S8_2\""),
            "key 'S8_2' is there twice",
        ),
        (
            "flat-text.json",
            flat("\"z0\": ", "\"z0\": \"\", \"\": "),
            "invalid type: string",
        ),
        ("flat-more.json", format!("{FLAT} 1"), "trailing characters"),
        (
            "flat-large.json",
            flat("\"e0\": -0.0", "\"e0\": -0.9"),
            "pivot 1: guide_error_rad is",
        ),
    ];
    for (name, text, reason) in cases {
        let output = calibrated("inverse", &file(name, &text), "1,2,3\n");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        assert!(
            stderr.contains(name) && stderr.contains(reason),
            "{reason}: {stderr}"
        );
        assert!(output.stdout.is_empty(), "{name}");
    }
    let none = Path::new(env!("CARGO_TARGET_TMPDIR")).join("no-such-calibration.json");
    let output = calibrated("direct", &none, "1,2,3\n");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no-such-calibration.json: "));
}
