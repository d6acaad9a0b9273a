//! The command line as its users meet it: the binary, its output, its exit codes.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// Runs the binary with `input` on its standard input.
fn tripivot_fed(arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    // It may have ended already, at a bad row or argument.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    child.wait_with_output().expect("the binary ends")
}

fn tripivot(arguments: &[&str]) -> Output {
    tripivot_fed(arguments, "")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

/// Exit code 2, and exactly one line on standard error, with `part` in it.
fn assert_refused(output: &Output, part: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(stderr.contains(part), "'{part}' is not in: {stderr}");
}

fn numbers(text: &str) -> Vec<f64> {
    (text.split([' ', ',', '\n']))
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().expect("a number"))
        .collect()
}

/// A fresh folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn inverse_prints_one_line_of_twelve_decimals() {
    let output = tripivot(&["inverse", "0", "0", "0"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        stdout(&output),
        "-30.000000000000 90.000000000000 210.000000000000\n"
    );
}

#[test]
fn inverse_agrees_with_exact_arithmetic() {
    // theta_i + asin(y cos theta_i - x sin theta_i) for (30, -20) mm, 40 deg, from 50-digit arithmetic.
    let output = tripivot(&["inverse", "30", "-20", "40"]);
    let expected = [
        -4.421_658_400_892_597,
        124.188_509_762_039_37,
        270.506_388_287_915_8,
    ];
    for (got, expected) in numbers(&stdout(&output)).into_iter().zip(expected) {
        assert!((got - expected).abs() < 2e-12, "{got}, expected {expected}");
    }
}

#[test]
fn direct_undoes_inverse_many_turns_away() {
    let pose = ["-41.25", "33.5", "-359987.125"];
    let [x, y, theta] = pose;
    let pivots = stdout(&tripivot(&["inverse", x, y, theta]));
    let pivots: Vec<&str> = pivots.split_whitespace().collect();
    let output = tripivot(&["direct", pivots[0], pivots[1], pivots[2]]);
    assert_eq!(output.status.code(), Some(0));
    // A pivot of 360,000 deg cannot be told from one 58e-12 deg away.
    for (got, expected) in numbers(&stdout(&output)).into_iter().zip(pose) {
        let expected: f64 = expected.parse().expect("a number");
        assert!((got - expected).abs() < 3e-10, "{got}, expected {expected}");
    }
}

#[test]
fn rows_are_converted_and_converted_back() {
    let poses = "x,y,theta\n1,2,3\n\n# a comment\n -70 , 0 , 1e3\n";
    let there = tripivot_fed(&["inverse", "--csv"], poses);
    assert_eq!(there.status.code(), Some(0));
    let back = tripivot_fed(&["direct", "--csv"], &stdout(&there));
    assert_eq!(back.status.code(), Some(0));
    let results = numbers(&stdout(&back));
    assert_eq!(results.len(), 6);
    for (got, expected) in results.into_iter().zip([1.0, 2.0, 3.0, -70.0, 0.0, 1000.0]) {
        assert!((got - expected).abs() < 1e-10, "{got}, expected {expected}");
    }
}

#[test]
fn a_bad_row_is_named_and_those_before_it_are_written() {
    for (row, reason) in [
        ("4,5", "2 values"),
        ("4,five,6", "'five'"),
        ("400,0,0", "outside the track"),
        ("NaN,0,0", "not finite"),
    ] {
        let output = tripivot_fed(&["inverse", "--csv"], &format!("1,2,3\n\n{row}\n7,8,9\n"));
        assert_refused(&output, "row 3: ");
        assert_refused(&output, reason);
        assert_eq!(stdout(&output).lines().count(), 1);
    }
}

#[test]
fn impossible_values_are_refused() {
    assert_refused(
        &tripivot(&["inverse", "0", "-100", "0"]),
        "outside the track",
    );
    assert_refused(&tripivot(&["inverse", "0", "inf", "0"]), "not finite");
    assert_refused(&tripivot(&["direct", "0", "0", "0"]), "pivot");
    assert_refused(&tripivot(&["direct", "0", "240", "120"]), "pivot");
    let map = ["map", "rate", "--theta", "NaN", "--out", "x.svg"];
    assert_refused(&tripivot(&map), "NaN");
    assert_refused(&tripivot(&["map", "rate", "--out", "map.bmp"]), "map.bmp");
}

#[test]
fn bad_usage_is_refused_in_one_line() {
    for (arguments, part) in [
        (&["inverse", "1", "2"][..], "3 values"),
        (&["inverse", "1", "2", "3", "--csv"], "--csv"),
        (&["inverse", "1", "2", "three"], "'three'"),
        (&["check"], "<X> <Y> <THETA>"),
        (
            &["map", "colour", "--out", "map.svg"],
            "dexterity, rate, separation",
        ),
        (&["--every", "0"], "--every"),
        (&["--mismatch", "200"], "not from -80 to 80"),
        (&["run"], "<FILE>"),
        (&["nonsense"], "nonsense"),
    ] {
        let output = tripivot(arguments);
        assert_refused(&output, part);
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn help_and_version_are_no_errors() {
    for arguments in [&["--help"][..], &["help", "map"], &["--version"]] {
        let output = tripivot(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(!output.stdout.is_empty() && output.stderr.is_empty());
    }
}

#[test]
fn check_tells_reason_and_margins() {
    let good = tripivot(&["check", "-10", "20", "-1000"]);
    assert_eq!(good.status.code(), Some(0));
    assert!(
        stdout(&good).starts_with("reachable\n"),
        "{}",
        stdout(&good)
    );

    let centre = stdout(&tripivot(&["check", "0", "0", "0"]));
    for line in [
        "margin to the usable disk            80.000000 mm",
        "margin to a guide's start            80.000000 mm",
        "margin to a guide's end              80.000000 mm",
        "margin of the pivots' separation    100.000000 deg",
        "smallest separation                 120.000000 deg",
        "dexterity                             0.948683",
    ] {
        assert!(
            centre.lines().any(|other| other == line),
            "{line}\n{centre}"
        );
    }

    let wide = tripivot(&["check", "81", "0", "0"]);
    assert_eq!(wide.status.code(), Some(1));
    assert!(stdout(&wide).starts_with("not reachable: the centre lies outside the usable disk\n"));
    assert!(stdout(&wide).contains("margin to the usable disk            -1.000000 mm\n"));

    let outside = tripivot(&["check", "0", "-120", "0"]);
    assert_eq!(outside.status.code(), Some(1));
    assert_eq!(
        stdout(&outside),
        "not reachable: the centre lies on or outside the track\n"
    );
}

#[test]
fn maps_are_drawn() {
    let folder = folder("maps");
    for quantity in ["dexterity", "rate", "separation"] {
        for theta in ["0", "-25"] {
            let path = folder.join(format!("{quantity}{theta}.svg"));
            let path_text = path.to_string_lossy();
            let output = tripivot(&["map", quantity, "--theta", theta, "--out", &path_text]);
            assert_eq!(output.status.code(), Some(0));
            let svg = fs::read_to_string(&path).expect("the picture");
            assert!(svg.contains(&format!("{theta}\u{b0}")));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }
    let png = folder.join("dexterity.PNG");
    let output = tripivot(&["map", "dexterity", "--out", &png.to_string_lossy()]);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        fs::read(&png)
            .expect("the picture")
            .starts_with(b"\x89PNG\r\n")
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = folder("blocked");
    let file = folder.join("file");
    fs::write(&file, "not a folder").expect("a file");
    let below = file.join("below");
    let out = below.to_string_lossy();
    assert_refused(&tripivot(&["--quiet", "--out", &out]), &out);
    let map = below.join("map.svg");
    let map = map.to_string_lossy();
    assert_refused(&tripivot(&["map", "rate", "--out", &map]), &map);
}

#[test]
fn a_script_that_cannot_be_read_is_named() {
    let folder = folder("unreadable");
    let script = folder.join("none.gcs");
    let (script, out) = (script.to_string_lossy(), folder.to_string_lossy());
    assert_refused(&tripivot(&["run", &script, "--out", &out]), "none.gcs");
}

#[cfg(unix)]
#[test]
fn a_controller_is_named_in_one_way_for_its_page() {
    // All options go together but the two ways.
    let whole = [
        "view", "--port", "/no/such", "--baud", "9600", "--web", "off",
    ];
    assert_refused(&tripivot(&whole), "/no/such: there is no such device");
    let both = ["view", "--port", "/no/such", "--connect", "localhost:1"];
    assert_refused(&tripivot(&both), "cannot be used with '--");
}
