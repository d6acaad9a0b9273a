//! Calibration of a simulated machine over its command line: measured, interrupted, fitted, given to its controller, and judged by
//! true poses.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use calibration::file::Calibration;
use calibration::frames::{Pair, without_frames};
use calibration::spread::over_disk;
use calibration::table::Table;
use calibration::{Instrument, Kit, Noise, Seen, plan};
use desk::calibrate::with_references;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::file::from_text;
use hal_sim::machine::instruments::{EncoderErrors, QuasiStatic, commanded};

const RADIUS_MM: f64 = 100.0;
/// A machine with errors of its geometry and its encoders alone.
const BUILT: [&str; 6] = [
    "--set",
    "plant.imperfections.geometry=true",
    "--set",
    "plant.imperfections.encoder_eccentricity=true",
    "--set",
    "plant.imperfections.encoder_harmonics=true",
];

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("calibrate-machine-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn calibrate(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .current_dir(folder)
        .arg("calibrate")
        .args(arguments)
        .output()
        .unwrap()
}

fn on_machine(folder: &Path, arguments: &[&str]) -> Output {
    calibrate(folder, &[arguments, &BUILT].concat())
}

fn is_done(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn assert_refused(output: &Output, code: i32, words: &str) {
    let error = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(code), "{error}");
    assert!(error.contains(words), "'{words}' is not in: {error}");
}

fn truth() -> QuasiStatic {
    let settings: Vec<String> = (BUILT.iter().skip(1).step_by(2))
        .map(|setting| (*setting).to_owned())
        .collect();
    let stage: StageParameters = from_text("", &settings).unwrap();
    QuasiStatic::new(
        &stage.plant,
        stage.encoders.map(|encoder| {
            let mut errors = EncoderErrors::IDEAL;
            let (sin, cos) = encoder.eccentricity_phase_rad.sin_cos();
            errors.harmonics_rad[0] = [-sin, cos].map(|part| encoder.eccentricity_rad * part);
            errors.harmonics_rad[1..].copy_from_slice(&encoder.harmonics_rad);
            errors
        }),
    )
}

/// What true poses are off commanded ones, nm rms, with the numbers of a file.
fn left_nm(folder: &Path, file: &str) -> (f64, f64) {
    let text = fs::read_to_string(folder.join(file)).unwrap();
    let calibration = Calibration::from_text(&text).unwrap();
    let poses = over_disk(0.8).skip(5000).take(500);
    let pairs = commanded(&truth(), &calibration.machine(), poses).unwrap();
    let left = without_frames(&pairs).size().place_rms * RADIUS_MM * 1e6;
    (left, calibration.made.expected_xy_nm)
}

fn visits(folder: &Path, file: &str) -> Table {
    let text = fs::read_to_string(folder.join(file)).unwrap();
    Table::from_text(&text, RADIUS_MM).unwrap()
}

/// True poses in the loop against those that the controller was sent to, nm rms, by an instrument that is next to perfect; at poses of a
/// plan, and frames and scale out.
fn commanded_nm(folder: &Path, out: &str, settings: &str) -> f64 {
    let noise = Noise {
        length: 1e-6 / RADIUS_MM,
        angle_rad: 1e-9 / 0.05,
        encoder_rad: Noise::ENCODER_RAD,
    };
    let stops = with_references(&plan(&Instrument::new(Kit::Xyt, noise), 40).unwrap().stops);
    let arguments = ["measure", "--kit", "xyt", "--noise", "1nm", "--poses", "40"];
    let more = ["--out", out, "--settings", settings];
    is_done(&on_machine(folder, &[&arguments[..], &more].concat()));
    let pairs: Vec<Pair> = (visits(folder, out).visits.iter().zip(&stops))
        .map(|(visit, stop)| match visit.seen {
            Seen::Pose(reached) => Pair {
                asked: stop.pose,
                reached,
            },
            other => panic!("{other:?}"),
        })
        .collect();
    without_frames(&pairs).size().place_rms * RADIUS_MM * 1e6
}

fn fit(folder: &Path, measured: &str, serial: &str, out: &str) {
    is_done(&calibrate(
        folder,
        &[
            "fit",
            measured,
            "--noise",
            "50nm",
            "--noise-theta",
            "1urad",
            "--serial",
            serial,
            "--out",
            out,
        ],
    ));
}

#[test]
fn a_measurement_that_was_interrupted_is_what_it_would_have_been() {
    let folder = folder("resumed");
    let measure = |out: &str, poses: &str| {
        let arguments = [
            "measure",
            "--kit",
            "xyt",
            "--noise",
            "50nm",
            "--noise-theta",
            "1urad",
        ];
        on_machine(
            &folder,
            &[&arguments[..], &["--poses", poses, "--out", out]].concat(),
        )
    };
    is_done(&measure("whole.csv", "60"));
    // Power fails in the middle of a row.
    let text = fs::read_to_string(folder.join("whole.csv")).unwrap();
    fs::write(folder.join("torn.csv"), &text[..text.len() * 2 / 3]).unwrap();
    let told = is_done(&measure("torn.csv", "60"));
    assert!(told.contains("60 poses, 63 visits, 4"), "{told}");
    let (whole, torn) = (visits(&folder, "whole.csv"), visits(&folder, "torn.csv"));
    assert_eq!((whole.visits.len(), torn.visits.len()), (63, 63));
    for (one, other) in whole.visits.iter().zip(&torn.visits) {
        // Both the stage's rest and what the instrument reads of it differ by some counts of the encoders at most.
        for (a, b) in one.readings_rad.iter().zip(&other.readings_rad) {
            assert!((a - b).abs() < 5e-7, "{one:?} {other:?}");
        }
        for (a, b) in one.seen.values().iter().zip(other.seen.values()) {
            assert!((a - b).abs() < 5e-7, "{one:?} {other:?}");
        }
    }
    // Another measurement does not go on in its file.
    assert_refused(&measure("torn.csv", "61"), 2, "this is another measurement");

    fit(&folder, "whole.csv", "SIM", "own.toml");
    let (left, expected) = left_nm(&folder, "own.toml");
    println!("{left:.1} nm, expected {expected:.1}");
    assert!(left < 122.0 && left < 1.3 * expected, "{left} {expected}");

    // To its controller, which keeps it.
    let apply = |file: &str| on_machine(&folder, &["apply", file, "--settings", "kept.flash"]);
    let told = is_done(&apply("own.toml"));
    assert!(told.starts_with("STATE=ON\nSERIAL=SIM\n"), "{told}");
    let after_nm = commanded_nm(&folder, "after.csv", "kept.flash");
    let before_nm = commanded_nm(&folder, "before.csv", "empty.flash");
    println!("true pose against commanded: {before_nm:.0} nm before, {after_nm:.1} nm after");
    assert!(before_nm > 90e3 && after_nm < 77.0, "{after_nm}");
    let text = fs::read_to_string(folder.join("own.toml")).unwrap();
    let other = |name: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        fs::write(folder.join(name), text.replacen(from, to, 1)).unwrap();
        apply(name)
    };
    assert_refused(
        &other("others.toml", "serial = \"SIM\"", "serial = \"SIM2\""),
        1,
        "the calibration is of machine 'SIM2', and this one is 'SIM'",
    );
    assert_refused(
        &other("torn.toml", "[[pivots]]", "[[piv"),
        2,
        "torn.toml: line ",
    );
    let radius = text
        .lines()
        .find(|line| line.starts_with("radius_error_mm"))
        .unwrap();
    assert_refused(
        &other("absurd.toml", radius, "radius_error_mm = 1.99"),
        1,
        "further than a controller corrects",
    );
    // None of them changed what is there.
    let told = is_done(&on_machine(&folder, &["undo", "--settings", "kept.flash"]));
    assert!(told.starts_with("STATE=OFF\nSERIAL=SIM\n"), "{told}");
}

#[test]
fn an_unknown_plate_calibrates_a_machine() {
    let folder = folder("plate");
    let measure = [
        "measure", "--kit", "camera2", "--noise", "50nm", "--poses", "200",
    ];
    is_done(&on_machine(
        &folder,
        &[&measure[..], &["--out", "plate.csv"]].concat(),
    ));
    fit(&folder, "plate.csv", "SIM", "own.toml");
    let (left, expected) = left_nm(&folder, "own.toml");
    println!("{left:.1} nm, expected {expected:.1}");
    assert!(left < 64.0 && left < 1.3 * expected, "{left} {expected}");
}

#[test]
fn a_reader_that_reads_nothing_is_named() {
    let folder = folder("reader");
    let measure = |reader: &str| {
        let arguments = ["measure", "--kit", "xy", "--noise", "50nm", "--poses", "12"];
        on_machine(
            &folder,
            &[&arguments[..], &["--out", "m.csv", "--reader", reader]].concat(),
        )
    };
    assert_refused(&measure("echo 1"), 1, "pose 1: --reader answered '1'");
    assert_refused(&measure("exit 3"), 1, "pose 1: --reader ended with");
    // One that answers where the stage was sent: the drawing's machine.
    is_done(&measure("cut -d' ' -f1,2"));
    assert_eq!(visits(&folder, "m.csv").visits.len(), 13);
    let none = calibrate(
        &folder,
        &[
            "measure", "--kit", "xy", "--noise", "50nm", "--poses", "12", "--out", "n.csv",
        ],
    );
    assert_refused(&none, 2, "--reader: what reads the instrument?");
}
