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
    assert_ended(output, 2, part);
}

/// This exit code, and exactly one line on standard error, with `part` in it.
fn assert_ended(output: &Output, code: i32, part: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{stderr}");
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
        assert!(
            (got - expected).abs() < 4.5e-13,
            "{got}, expected {expected}"
        );
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
        assert!(
            (got - expected).abs() < 2.8e-11,
            "{got}, expected {expected}"
        );
    }
}

#[test]
fn rows_are_converted_and_converted_back() {
    let poses = "x,y,theta\n1,2,3\n\n# a comment\n -70 , 0 , 1e3\n";
    let there = tripivot_fed(&["inverse", "--csv"], poses);
    assert_eq!(there.status.code(), Some(0));
    // A header asks for one.
    assert!(stdout(&there).starts_with("phi1,phi2,phi3\n"));
    let back = tripivot_fed(&["direct", "--csv"], &stdout(&there));
    assert_eq!(back.status.code(), Some(0));
    let back = stdout(&back);
    let results = numbers(back.strip_prefix("x,y,theta\n").expect("a header"));
    assert_eq!(results.len(), 6);
    for (got, expected) in results.into_iter().zip([1.0, 2.0, 3.0, -70.0, 0.0, 1000.0]) {
        assert!(
            (got - expected).abs() < 1.1e-12,
            "{got}, expected {expected}"
        );
    }
}

#[test]
fn a_bad_row_is_named_and_those_before_it_are_written() {
    for (row, code, reason) in [
        ("4,5", 2, "2 values"),
        ("4,five,6", 2, "'five' is not a number"),
        ("x,y,theta", 2, "'x' is not a number"),
        ("400,0,0", 1, "outside the track"),
        ("NaN,0,0", 2, "not finite"),
    ] {
        let output = tripivot_fed(&["inverse", "--csv"], &format!("1,2,3\n\n{row}\n7,8,9\n"));
        assert_ended(&output, code, "row 3: ");
        assert_ended(&output, code, reason);
        assert_eq!(stdout(&output).lines().count(), 1);
    }
}

/// Only three names are a header: data that cannot be read must not be passed over as one.
#[test]
fn a_first_row_is_a_header_or_data() {
    for header in [
        "x,y,theta",
        "\"x\", \"y\", \"theta\"",
        "x1,y1,t1",
        "\u{3be},\u{3b7},\u{3b8} (deg)",
    ] {
        let output = tripivot_fed(
            &["inverse", "--csv"],
            &format!("# made by hand\n\n{header}\n0,0,0\n"),
        );
        assert_eq!(output.status.code(), Some(0), "{header}");
        assert_eq!(stdout(&output).lines().count(), 2, "{header}");
    }
    for (row, reason) in [
        ("1;2;3", "row 1: 1 values where 3 are expected"),
        ("x;y;theta", "row 1: 1 values where 3 are expected"),
        ("1.2.3,4.5.6,7.8.9", "row 1: '1.2.3' is not a number"),
        ("-,-,-", "row 1: '-' is not a number"),
        ("x,y,3", "row 1: 'x' is not a number"),
        ("NaN,NaN,NaN", "row 1: the pose is not finite"),
    ] {
        let output = tripivot_fed(&["inverse", "--csv"], &format!("{row}\n0,0,0\n"));
        assert_refused(&output, reason);
        assert!(output.stdout.is_empty(), "{row}");
    }
}

#[test]
fn impossible_values_are_refused() {
    let outside = tripivot(&["inverse", "0", "-100", "0"]);
    assert_ended(&outside, 1, "outside the track");
    assert_refused(&tripivot(&["check", "inf", "0", "0"]), "not finite");
    assert_refused(&tripivot(&["check", "0", "0", "nan"]), "not finite");
    assert_refused(&tripivot(&["inverse", "0", "inf", "0"]), "not finite");
    assert_refused(
        &tripivot(&["inverse", "0", "0", "1e300"]),
        "not from -1000000000 to 1000000000",
    );
    assert_refused(
        &tripivot(&["check", "0", "0", "-1e300"]),
        "not from -1000000000 to 1000000000",
    );
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
fn what_may_have_been_meant_is_told() {
    for (arguments, tip) in [
        (&["chek", "0", "0", "0"][..], "'check'"),
        (&["--mismach", "3"], "'--mismatch'"),
        (&["run", "tour.gcs", "--evry", "3"], "'--every'"),
        (&["map", "dexterty", "--out", "map.svg"], "'dexterity'"),
    ] {
        let output = tripivot(arguments);
        assert_refused(&output, "a similar ");
        assert_refused(&output, &format!("exists: {tip}"));
    }
}

/// Each of them with text and with a number that is out of its range; a negative number is a number and no option.
#[test]
fn bad_numbers_are_told_in_plain_words() {
    for (arguments, range) in [
        (&["--mismatch"][..], "not from -80 to 80"),
        (&["--payload"], "not from 0 to 5"),
        (&["--seed"], "not from 0 to 18446744073709551615"),
        (&["--every"], "not from 1 to 4294967295"),
        (&["faults", "--runs"], "not from 1 to 10000000"),
        (&["faults", "--seed"], "not from 0 to 18446744073709551615"),
        (&["faults", "--jobs"], "not from 1 to 1024"),
        (&["faults", "--only"], "not from 0 to 18446744073709551615"),
    ] {
        assert_bad_number(arguments, range);
    }
    for arguments in [
        &["inverse", "0", "0"][..],
        &["direct", "0", "0"],
        &["check", "0", "0"],
        &["map", "rate", "--out", "map.svg", "--theta"],
    ] {
        let output = tripivot(&[arguments, &["three"]].concat());
        assert_refused(&output, "'three'");
        assert_refused(&output, ": not a number");
    }
}

#[cfg(unix)]
#[test]
fn bad_numbers_for_a_controller_are_told_in_plain_words() {
    for (arguments, range) in [
        (&["serve", "--speed"][..], "not from 0.001 to 1000"),
        (&["view", "--baud"], "not from 1 to 4294967295"),
        (&["record", "--every"], "not from 1 to 65536"),
        (&["record", "--points"], "not from 1 to 4294967295"),
        (&["record", "--before"], "not from 0 to 4294967295"),
        (&["record", "--patience"], "not from 0 to 86400"),
    ] {
        assert_bad_number(arguments, range);
    }
}

fn assert_bad_number(arguments: &[&str], range: &str) {
    let option = arguments[arguments.len() - 1];
    for (value, reason) in [("three", "not a number"), ("-200", range), ("1e30", range)] {
        let output = tripivot(&[arguments, &[value]].concat());
        assert_refused(&output, &format!("'{value}' for '{option} <"));
        assert_refused(&output, &format!(": {reason} (see --help)"));
    }
}

#[test]
fn version_is_program_version_and_commit() {
    let text = stdout(&tripivot(&["--version"]));
    let words: Vec<&str> = text.split_whitespace().collect();
    let [program, version, commit] = words[..] else {
        panic!("{text}");
    };
    assert_eq!((program, version), ("tripivot", env!("CARGO_PKG_VERSION")));
    let is_hash = commit.len() >= 10 && commit.bytes().all(|byte| byte.is_ascii_hexdigit());
    assert!(is_hash || commit == "unknown", "{commit}");
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
